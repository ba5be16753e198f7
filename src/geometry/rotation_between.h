// The smallest rotation that takes one direction to another.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace buoyancy {

// Eigen::Quaterniond::FromTwoVectors(from, to), compiled once: for opposite directions it decomposes a
// matrix, which takes seconds to compile wherever it is used. Both of any length but 0.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to);

}  // namespace buoyancy
