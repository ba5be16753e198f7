// The smallest rotation that takes one direction to another.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace buoyancy {

// Returns the unit quaternion of the smallest rotation that takes the direction of `from` to that of `to`;
// both must be non-zero. Between opposite directions it is half a turn about one of the perpendicular axes.
// The quaternion's length is accurate to 1e-9, and the direction of `from` is taken to that of `to` within
// 1e-9 rad. Replaces Eigen::Quaterniond::FromTwoVectors, whose matrix decomposition takes seconds to compile.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to);

}  // namespace buoyancy
