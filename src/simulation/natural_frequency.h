// The fastest swing that water can put a floating body into: what the simulator's step has to follow.
//
// Small motions about a pose obey M x'' = -K x with M = diag(m, I) about the centre of mass and K the
// hydrostatic stiffness about it (hydrostatics/hydrostatics.h); weight adds nothing there. The pose's
// frequency is the square root of the largest eigenvalue of the symmetric part of M^-1/2 K M^-1/2, 0 where
// none is positive. It is taken over the present pose and a sweep of others: 16 levels from the lowest to the
// highest vertex, with up along the body's own axes, their bisectors and the present one, as far as the
// body's mechanical energy lets it get there. So a body that is still dry has the frequency of the water that
// it falls into, and a deck that stays dry counts for nothing. A sweep is a sample: between its poses the
// frequency may be a little higher. It is exact for a wall-sided body in its upright range.
#pragma once

#include "simulation/rigid_body.h"

namespace buoyancy {

struct HighestNaturalFrequency {
  double frequency = 0.0;  // rad/s; 0: no pose within reach has a stiffness
  double draft = 0.0;      // m: depth of the lowest vertex at the pose that has it
};

// rad/s, never below highest_natural_frequency's: from areas and lengths alone, several times too high. O(1).
double natural_frequency_bound(const Body& body, const RigidBody& rigid, const Water& water);

// O(levels x directions) hydrostatic queries; a mesh without a tree is copied and gets one first.
HighestNaturalFrequency highest_natural_frequency(const Body& body, const RigidBody& rigid,
                                                  const RigidBodyState& state, const Water& water);

}  // namespace buoyancy
