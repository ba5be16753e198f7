// Converts between the arrays of messages and the vectors of computations, rotates them, and checks them for
// finiteness.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Geometry>

#include "base/vec3.h"

namespace buoyancy {

// Tests branch-free: x - x is NaN for infinities and NaN, and 0 for every finite x.
template <std::size_t kSize>
bool all_finite(const std::array<double, kSize>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value - value;
  return sum == 0.0;
}

inline Vec3 to_vec3(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

inline std::array<double, 3> to_array(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// Rotates a vector from B to W by the quaternion's direction; its norm does not matter.
inline std::array<double, 3> to_world(const std::array<double, 4>& q_WB, const std::array<double, 3>& v_B) {
  const auto& [w, x, y, z] = q_WB;
  return to_array(Eigen::Quaterniond(w, x, y, z).normalized() * to_vec3(v_B));
}

}  // namespace buoyancy
