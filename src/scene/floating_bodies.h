// Makes a FloatingBody of a scene's body from its mesh, compartments, tanks and mass.
#pragma once

#include <vector>

#include "flotation/floating_body.h"
#include "scene/body_mass.h"
#include "scene/scene.h"

namespace buoyancy {

// Return the compartments of a body that are open to the sea, and its tanks. condition: of both; nullptr:
// that of the scene file. The scene must outlive the result.
std::vector<PlacedMesh> open_compartments(const Body& body, const BodyCondition* condition = nullptr);
std::vector<Tank> tanks_of(const Body& body, const BodyCondition* condition = nullptr);

// mesh: the body's, with its tree; it and the scene must outlive the result. mass: without the liquids
// in its tanks. condition: of its compartments and tanks; nullptr: that of the scene file. Errors: those of
// FloatingBody::make().
Expected<FloatingBody> floating_body_of(const Body& body, const HydrostaticMesh& mesh,
                                        const RigidBodyMass& mass, const BodyCondition* condition = nullptr);

// The same of a body whose mass does not matter, or varies: it has 1 kg at the origin.
Expected<FloatingBody> floating_hull_of(const Body& body, const HydrostaticMesh& mesh);

}  // namespace buoyancy
