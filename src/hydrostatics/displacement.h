// What a solver hands to the read-out: the displaced volume and its moments in the body frame, about the
// mesh's centre c, before density, gravity and the world frame come in.
#pragma once

#include "base/vec3.h"

namespace buoyancy {

struct Displacement {
  double volume = 0.0;         // m^3
  Vec3 moment = Vec3::Zero();  // m^4, B axes: integral of (x - c) over the displaced volume
  Vec3 force = Vec3::Zero();   // m^3, B axes: F/(rho g), as computed
  Vec3 torque = Vec3::Zero();  // m^4, B axes: torque about c/(rho g), as computed
  double rounding = 0.0;       // m^3: what this pose adds to the mesh's rounding_bound()
  // m^3: what the method did not count, or took from a rough plane, cannot change |volume| or |force| by
  // more, nor |torque| by more than this times the largest distance at which it may act; 0 where all was
  // counted.
  double left_out = 0.0;
  // m: beyond the body, what was left out may act as far from c as this.
  double left_out_reach = 0.0;
};

}  // namespace buoyancy
