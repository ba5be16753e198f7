// Converts between the arrays of messages and the vectors of computations, and checks arrays for finiteness.
#pragma once

#include <array>
#include <cstddef>

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

}  // namespace buoyancy
