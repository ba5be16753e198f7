// The bodies of a scene as what floats: their meshes and compartments, tanks and masses.
#pragma once

#include <vector>

#include "flotation/floating_body.h"
#include "scene/body_mass.h"
#include "scene/scene.h"

namespace buoyancy {

// The compartments that are open to the sea, and the tanks, of a body. condition: of them; nullptr: that of
// the scene file. The scene outlives the result.
std::vector<PlacedMesh> open_compartments(const Body& body, const BodyCondition* condition = nullptr);
std::vector<Tank> tanks_of(const Body& body, const BodyCondition* condition = nullptr);

// mesh: the body's, with its tree; it outlives the result, and so does the scene. mass: without the liquids
// in its tanks. condition: of its compartments and tanks; nullptr: that of the scene file. Errors: those of
// FloatingBody::make().
Expected<FloatingBody> floating_body_of(const Body& body, const HydrostaticMesh& mesh,
                                        const RigidBodyMass& mass, const BodyCondition* condition = nullptr);

}  // namespace buoyancy
