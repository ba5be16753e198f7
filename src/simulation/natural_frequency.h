// The highest natural frequency of a floating body, which the simulator's time step has to resolve.
//
// Small motions about a pose obey M x'' = -K x with M = diag(m, I) about the centre of mass, plus s A at the
// immersion of that pose for a body with added mass, and K the hydrostatic stiffness about the same point
// (hydrostatics/hydrostatics.h), less the part of open compartments. Weight adds nothing to K there, except
// for that of liquids in tanks (stiffness_of_weights()). The frequency of a pose is the square root of the
// largest eigenvalue of the symmetric part of M^-1/2 K M^-1/2, or 0 where no eigenvalue is positive. The
// maximum is taken over the present pose and a sweep of others: 16 levels from the lowest to the highest
// vertex, with up along the body's principal axes, their bisectors and the present up direction, as far as
// the body's mechanical energy allows. A body that is still dry therefore gets the frequency that it will
// have in the water, and a deck that stays dry does not contribute. The sweep is a sample: between its poses
// the frequency may be a little higher. It is exact for a wall-sided body in its upright range.
#pragma once

#include "simulation/rigid_body.h"

namespace buoyancy {

struct HighestNaturalFrequency {
  double frequency = 0.0;  // [rad/s]; 0: no reachable pose has a positive stiffness
  double draft = 0.0;      // [m], depth of the lowest vertex at the pose of that frequency
};

// Upper bound [rad/s] of highest_natural_frequency() from areas and lengths alone, several times too high.
// O(1).
double natural_frequency_bound(const Body& body, const RigidBody& rigid, const Water& water);

// Complexity: O(levels x directions) hydrostatic queries, and a tree's construction for a mesh without one.
HighestNaturalFrequency highest_natural_frequency(const Body& body, const RigidBody& rigid,
                                                  const RigidBodyState& state, const Water& water);

}  // namespace buoyancy
