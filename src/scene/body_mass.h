// The mass, the centre of mass and the inertia of a body: its own, which [body.client] gives or its mesh, and
// with the liquids in its tanks.
//
// The liquids are frozen: they add their masses, and their inertia about their centroids, as they lie at one
// attitude, and turn with the body from there. What they weigh is not: it acts where they are at each
// attitude. An ideal liquid does not turn with its tank altogether, so that the inertia is an upper bound.
#pragma once

#include <optional>
#include <span>

#include "base/spatial.h"
#include "hydrodynamics/coupled_mass.h"
#include "hydrostatics/tank.h"
#include "scene/scene.h"

namespace buoyancy {

// The body's own, without the liquids: what [body.client] gives, the rest derived from the mesh as it says.
// Errors: an open mesh leaves something unknown; a value is not above 0 or not finite.
Expected<RigidBodyMass> mass_of_body(const Body& body, const Water& water);

// The mass [kg] of mass_of_body(), and that over the volume [kg/m^3], also where the rest is unknown.
// nullopt: unknown, since an open mesh encloses no volume.
std::optional<double> known_mass(const Body& body, const Water& water);
std::optional<double> known_density(const Body& body, const Water& water);

// [m]; nullopt unless [body.client] has center_of_mass, or has mass or density and the mesh is closed: a
// body of a default mass has no centre that its scene means.
std::optional<Vec3> given_center_of_mass(const DynamicsSpec& dynamics, const PreparedMesh& prepared);

// What a body and the liquids in its tanks weigh.
struct Weights {
  double mass = 0.0;           // [kg]
  Vec3 moment = Vec3::Zero();  // [kg m], B axes: the first moment about a point
};

// own: without the liquids. liquids: about the same point.
Weights weights_of(const RigidBodyMass& own, const LiquidSum& liquids, const Vec3& about_B);

// own: without the liquids. condition: of the tanks; nullptr: that of the scene file. up_B: unit, the
// attitude at which the liquids are frozen. The inertia of a full tank is exact; that of another one is an
// integral over levels, exact where the section of its liquid is a polynomial of degree 3 in the height, and
// mostly within 1e-3 of itself. Complexity: 48 queries of hydrostatics per tank that is neither empty nor
// full.
RigidBodyMass mass_with_liquids(const Body& body, const RigidBodyMass& own, const BodyCondition* condition,
                                const Vec3& up_B);

// What the weights of a body and of the liquids in its tanks add to a hydrostatic stiffness about center_B
// (hydrostatics.h): 0 about the centre of mass of a body without tanks. The free surfaces take from it.
Mat6 stiffness_of_weights(const RigidBodyMass& own, std::span<const Tank> tanks, const Vec3& center_B,
                          const Eigen::Quaterniond& q_WB, const Water& water);

}  // namespace buoyancy
