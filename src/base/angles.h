// Angles are in radians; people write and read degrees.
#pragma once

#include <numbers>

namespace buoyancy {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace buoyancy
