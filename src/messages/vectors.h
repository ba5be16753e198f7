// Three-vectors as messages have them, for those who compute, and back.
#pragma once

#include <array>

#include "geometry/vec3.h"

namespace buoyancy {

inline Vec3 as_vec3(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

inline std::array<double, 3> as_array(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace buoyancy
