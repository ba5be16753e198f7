// A solver's output: the displaced volume and its moments in the body frame, about the mesh's centre c,
// before density, gravity and the world frame are applied.
#pragma once

#include "base/vec3.h"

namespace buoyancy {

struct Displacement {
  double volume = 0.0;         // [m^3]
  Vec3 moment = Vec3::Zero();  // [m^4], B axes: integral of (x - c) over the displaced volume
  Vec3 force = Vec3::Zero();   // [m^3], B axes: F/(rho g), as computed
  Vec3 torque = Vec3::Zero();  // [m^4], B axes: torque about c/(rho g), as computed
  double rounding = 0.0;       // [m^3], what this pose adds to the mesh's rounding_bound()
  // [m^3], bound on the truncation error of |volume| and |force|, which is due to what the method leaves out
  // and to a rough water plane. The error of |torque| is at most this times the largest distance at which it
  // may act. It is 0 where nothing is left out.
  double truncation_bound = 0.0;
  // [m], lever of the truncation error: the distance from c, beyond the body, at which it may act.
  double truncation_lever = 0.0;
};

}  // namespace buoyancy
