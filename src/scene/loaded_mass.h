// The mass of a body with the liquids in its tanks, as its motions need it.
//
// The liquids are frozen: they add their masses, and their inertia about their centroids, as they lie at one
// attitude, and turn with the body from there. What they weigh is not: it acts where they are at each
// attitude. An ideal liquid does not turn with its tank altogether, so that the inertia is an upper bound.
#pragma once

#include <span>

#include "base/spatial.h"
#include "hydrostatics/tank.h"
#include "scene/body_motions.h"

namespace buoyancy {

// own: without the liquids. condition: of the tanks; nullptr: that of the scene file. up_B: unit, the
// attitude at which the liquids are frozen. The inertia of a full tank is exact; that of another one is an
// integral over levels, exact where the section of its liquid is a polynomial of degree 3 in the height, and
// mostly within 1e-3 of itself. Complexity: 48 queries of hydrostatics per tank that is neither empty nor
// full.
BodyMass mass_with_liquids(const Body& body, const BodyMass& own, const BodyCondition* condition,
                           const Vec3& up_B);

// What the weights of a body and of the liquids in its tanks add to a hydrostatic stiffness about center_B
// (hydrostatics.h): 0 about the centre of mass of a body without tanks. The free surfaces take from it.
Mat6 stiffness_of_weights(const BodyMass& own, std::span<const Tank> tanks, const Vec3& center_B,
                          const Eigen::Quaterniond& q_WB, const Water& water);

}  // namespace buoyancy
