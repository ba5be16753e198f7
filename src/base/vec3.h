// Three-vectors and matrices of any number type: double where we run, rationals, intervals and dual numbers
// in the tests. The frame a vector is expressed in is part of its variable's name: vertex_B, force_W.
#pragma once

#include <Eigen/Core>

namespace buoyancy {

template <typename T>
using Vec3T = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Mat3T = Eigen::Matrix<T, 3, 3>;

using Vec3 = Vec3T<double>;
using Mat3 = Mat3T<double>;

}  // namespace buoyancy
