#include "scene/floating_bodies.h"

#include <vector>

namespace buoyancy {

Expected<FloatingBody> floating_body_of(const Body& body, const HydrostaticMesh& mesh, const BodyMass& mass,
                                        const BodyCondition* condition) {
  std::vector<PlacedMesh> meshes{{.mesh = &mesh}};
  std::vector<Tank> tanks;
  if (body.subdivision != nullptr) {
    const BodyCondition given = condition == nullptr ? initial_condition(*body.subdivision) : *condition;
    for (std::size_t i = 0; i < given.flooded.size(); ++i) {
      const BodyCompartment& compartment = body.subdivision->compartments[i];
      const double factor = factor_of(compartment, given.flooded[i]);
      if (factor < 0.0) meshes.push_back({.mesh = &compartment.prepared_mesh->mesh, .factor = factor});
    }
    for (std::size_t i = 0; i < given.liquid_volumes.size(); ++i) {
      tanks.push_back(with_liquid(body.subdivision->tanks[i], given.liquid_volumes[i]));
    }
  }
  return FloatingBody::make(meshes, mass.mass, mass.center_of_mass_B, tanks);
}

}  // namespace buoyancy
