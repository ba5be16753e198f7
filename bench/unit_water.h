// The water of all measurements: density times gravity is 1, so that force equals displaced volume.
#pragma once

#include "hydrostatics/water_plane.h"

namespace buoyancy::bench {

inline const Water kUnitWater{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};

}  // namespace buoyancy::bench
