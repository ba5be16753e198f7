// Computes the mass, the centre of mass and the inertia of a body, with and without the liquids in its tanks.
// [body.client] gives those of the body itself, or they follow from its mesh.
//
// The liquids count as frozen at one attitude: they add their masses and their inertia about their centroids,
// and turn with the body from there. Their weight is not frozen: it acts where they are at each attitude. An
// ideal liquid does not turn completely with its tank, so that the inertia is an upper bound.
#pragma once

#include <optional>
#include <span>

#include "base/spatial.h"
#include "hydrodynamics/coupled_mass.h"
#include "hydrostatics/tank.h"
#include "scene/scene.h"

namespace buoyancy {

// Returns what [body.client] gives, and derives the rest from the mesh. The liquids are not included.
// Errors: an open mesh leaves something unknown; a value is not above 0 or not finite.
Expected<RigidBodyMass> mass_of_body(const Body& body, const Water& water);

// Return the mass [kg] of mass_of_body() and the mean density [kg/m^3], also where the rest is unknown, or
// nullopt where an open mesh, which encloses no volume, leaves them unknown.
std::optional<double> known_mass(const Body& body, const Water& water);
std::optional<double> known_density(const Body& body, const Water& water);

// Returns the centre of mass [m], B; nullopt unless [body.client] has center_of_mass, or has mass or density
// and the mesh is closed. A scene that leaves the mass to its default states no centre of mass either.
std::optional<Vec3> given_center_of_mass(const DynamicsSpec& dynamics, const PreparedMesh& prepared);

// The mass and its first moment of a body and of the liquids in its tanks.
struct Weights {
  double mass = 0.0;           // [kg]
  Vec3 moment = Vec3::Zero();  // [kg m], B axes: the first moment about a point
};

// Adds up the weights of the body itself and of its liquids, whose moment is about the same point.
Weights weights_of(const RigidBodyMass& own, const LiquidSum& liquids, const Vec3& about_B);

// own: without the liquids. condition: of the tanks; nullptr: that of the scene file. up_B: unit, the
// attitude at which the liquids are frozen. The inertia of a full tank is exact; that of another one is an
// integral over levels, exact where the section of its liquid is a polynomial of degree 3 in the height, and
// mostly within 1e-3 (relative) else. Complexity: 48 queries of hydrostatics per tank that is neither empty
// nor full.
RigidBodyMass mass_with_liquids(const Body& body, const RigidBodyMass& own, const BodyCondition* condition,
                                const Vec3& up_B);

// Returns what the weights of a body and of the liquids in its tanks add to a hydrostatic stiffness about
// center_B (hydrostatics.h). It is 0 about the centre of mass without tanks; free surfaces reduce it.
Mat6 stiffness_of_weights(const RigidBodyMass& own, std::span<const Tank> tanks, const Vec3& center_B,
                          const Eigen::Quaterniond& q_WB, const Water& water);

}  // namespace buoyancy
