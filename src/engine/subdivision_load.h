// Adds the loads of compartments and tanks to the load of the water on their body.
#pragma once

#include <optional>

#include "engine/body_evaluation.h"
#include "hydrostatics/hydrostatics.h"

namespace buoyancy {

// Adds the loads of a body's compartments and tanks to that of its hull at the same pose: the buoyancy of
// each compartment times its factor_of(), which is negative, and the weight of the liquids. Bounds add.
// condition: nullptr: that of the scene file. `sum` is unchanged where its status is not kOk, and becomes
// kOutOfRange with zeros where a sum is beyond double's range. Returns the volume that the compartments take
// from the displaced one [m^3]. Preconditions: the body has a subdivision, and the water is known.
// Complexity: a query per compartment, and some seven displaced volumes per tank. Heap: as buoyancy_of().
double add_subdivision_load(const Body& body, const BodyCondition* condition, const WaterState& water,
                            const Pose& pose, WaveBuoyancyResult& sum);

// Returns for the whole body in water at rest what hydrostatics() returns for one without compartments and
// tanks. The stiffness is that of the wrench, with the weight of the liquids; the metacentric heights are
// above the centre of mass of body and liquids, reduced by the free surfaces. No heap allocation.
std::optional<Hydrostatics> subdivided_hydrostatics(const Body& body, const BodyCondition* condition,
                                                    const Water& water, const Pose& pose);

}  // namespace buoyancy
