// 3-vectors and 3 x 3 matrices of any number type: double in the libraries; rationals, intervals and dual
// numbers in the tests. A variable's name ends in the frame that it is expressed in: vertex_B, force_W.
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
