#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

BodyCondition condition_of(const Subdivision& subdivision, const BodyCondition* condition) {
  return condition == nullptr ? initial_condition(subdivision) : *condition;
}

}  // namespace

std::vector<PlacedMesh> open_compartments(const Body& body, const BodyCondition* condition) {
  std::vector<PlacedMesh> meshes;
  if (body.subdivision == nullptr) return meshes;
  const BodyCondition given = condition_of(*body.subdivision, condition);
  for (std::size_t i = 0; i < given.flooded.size(); ++i) {
    const BodyCompartment& compartment = body.subdivision->compartments[i];
    const double factor = factor_of(compartment, given.flooded[i]);
    if (factor < 0.0) {
      meshes.push_back({.mesh = &compartment.prepared_mesh->mesh, .signed_permeability = factor});
    }
  }
  return meshes;
}

std::vector<Tank> tanks_of(const Body& body, const BodyCondition* condition) {
  std::vector<Tank> tanks;
  if (body.subdivision == nullptr) return tanks;
  const BodyCondition given = condition_of(*body.subdivision, condition);
  for (std::size_t i = 0; i < given.liquid_volumes.size(); ++i) {
    tanks.push_back(with_liquid(body.subdivision->tanks[i], given.liquid_volumes[i]));
  }
  return tanks;
}

Expected<FloatingBody> floating_body_of(const Body& body, const HydrostaticMesh& mesh,
                                        const RigidBodyMass& mass, const BodyCondition* condition) {
  std::vector<PlacedMesh> meshes = open_compartments(body, condition);
  meshes.insert(meshes.begin(), {.mesh = &mesh});
  return FloatingBody::make(meshes, mass.mass, mass.center_of_mass_B, tanks_of(body, condition));
}

Expected<FloatingBody> floating_hull_of(const Body& body, const HydrostaticMesh& mesh) {
  return floating_body_of(body, mesh, {.mass = 1.0});
}

}  // namespace buoyancy
