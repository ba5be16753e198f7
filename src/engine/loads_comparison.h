// Compares the loads of a body in two replays.
//
// The bounds of a wrench are sums of those of its parts, so that they bound the error of each part too. The
// matrices are proportional to the immersion, whose error follows from the bound on the force where the
// volume scales the coefficients. docs/replay.md lists the tolerances.
#pragma once

#include "engine/field_differences.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "scene/scene.h"

namespace buoyancy {

// The limits that two wrenches of a body set for the differences of its loads.
struct WrenchLimits {
  double force = 0.0;             // [N], the sum of both bounds
  double torque = 0.0;            // [N m]
  double submerged_volume = 0.0;  // [m^3], the larger one
};
WrenchLimits limits_of(const BodyWrench& now, const BodyWrench& baseline);

// Precondition: both statuses are kOk.
void compare_loads(const BodyLoads& now, const BodyLoads& baseline, const WrenchLimits& limits,
                   const Body& body, const Scene& scene, MessageDifferences& differences);

}  // namespace buoyancy
