#include "scene/body_key.h"

#include <cmath>

namespace buoyancy {

void append_direction(const Vec3& direction, BodyKey& key) {
  constexpr double kPerUnit = 1e12;
  for (const double component : direction) key.push_back(std::round(kPerUnit * component) + 0.0);  // no -0
}

BodyKeys::BodyKeys(const Scene& scene) {
  for (const auto& mesh : scene.meshes()) {
    mesh_index_.emplace(mesh.get(), static_cast<double>(mesh_index_.size()));
  }
}

double BodyKeys::index_of(const PreparedMesh& mesh) const {
  return mesh_index_.at(&mesh);
}

BodyKey BodyKeys::floating(const Body& body, const RigidBodyMass& own) const {
  BodyKey key{index_of(*body.prepared_mesh), own.mass};
  append(own.center_of_mass_B, key);
  if (body.subdivision == nullptr) return key;
  for (const BodyCompartment& compartment : body.subdivision->compartments) {
    key.push_back(index_of(*compartment.prepared_mesh));
    key.push_back(factor_of(compartment, compartment.flooded));
  }
  key.push_back(-1.0);  // no index: tanks follow
  for (const BodyTank& tank : body.subdivision->tanks) {
    key.insert(key.end(), {index_of(*tank.prepared_mesh), tank.density, tank.liquid_volume});
    append(tank.piston_axis_B.value_or(Vec3::Zero()), key);
  }
  return key;
}

const HydrostaticMesh& MeshesWithTrees::of(const PreparedMesh& prepared) {
  if (prepared.mesh.tree) return prepared.mesh;
  const auto [copy, is_new] = copies_.try_emplace(&prepared);
  if (is_new) {
    copy->second = prepared.mesh;
    copy->second.tree = build_moment_tree(copy->second);
  }
  return copy->second;
}

}  // namespace buoyancy
