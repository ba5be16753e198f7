// Describes gravity and the water at rest that bodies float in.
#pragma once

#include "base/vec3.h"

namespace buoyancy {

inline constexpr double kStandardGravity = 9.80665;  // [m/s^2]
inline constexpr double kSeawaterDensity = 1025.0;   // [kg/m^3]

struct Water {
  Vec3 up_W = Vec3::UnitZ();          // unit
  double level = 0.0;                 // [m], the surface is where up . x_W = level
  double density = kSeawaterDensity;  // [kg/m^3], >= 0
  double gravity = kStandardGravity;  // [m/s^2], >= 0
};

}  // namespace buoyancy
