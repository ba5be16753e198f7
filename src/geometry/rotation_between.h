// The smallest rotation that takes one direction to another.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace buoyancy {

// Wraps Eigen::Quaterniond::FromTwoVectors(from, to) so that it is compiled once: for opposite directions it
// decomposes a matrix, which takes seconds to compile. Both vectors must be non-zero.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to);

}  // namespace buoyancy
