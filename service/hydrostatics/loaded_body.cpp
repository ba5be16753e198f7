#include "service/hydrostatics/loaded_body.h"

#include <string>
#include <utility>

#include "base/format.h"
#include "scene/floating_bodies.h"

namespace buoyancy::service {
namespace {

Expected<const Body*> body_of(const Scene& scene, std::optional<std::int32_t> id) {
  std::string ids;
  for (const Body& body : scene.bodies()) {
    if (!ids.empty()) ids += ' ';
    ids += std::to_string(body.id);
  }
  if (id) {
    if (const Body* body = scene.find(*id)) return body;
    return make_error(
        {scene.name(), "no body " + std::to_string(*id), "--body with one of its bodies: " + ids, "", ""});
  }
  if (scene.bodies().size() == 1) return &scene.bodies().front();
  return make_error({scene.name(), std::to_string(scene.bodies().size()) + " bodies",
                     "--body with one of them: " + ids, "", ""});
}

std::shared_ptr<const HydrostaticMesh> with_tree(const HydrostaticMesh& prepared) {
  auto mesh = std::make_shared<HydrostaticMesh>(prepared);
  if (!mesh->tree) mesh->tree = build_moment_tree(*mesh);
  return mesh;
}

// whole: the floating body of the scene's body, with its merged mesh.
Expected<std::optional<BodyShares>> shares_of(const Body& body, const FloatingBody& whole,
                                              std::shared_ptr<const HydrostaticMesh> hull) {
  const std::vector<PlacedMesh> compartments = open_compartments(body);
  if (body.parts == nullptr && compartments.empty()) return std::nullopt;
  std::vector<std::shared_ptr<const HydrostaticMesh>> meshes;
  std::vector<std::string> names;
  if (body.parts != nullptr) {
    for (const BodyPart& part : *body.parts) {
      meshes.push_back(with_tree(part.prepared_mesh->mesh));
      names.push_back(part.name);
    }
  } else {
    meshes.push_back(std::move(hull));
    names.emplace_back("hull");
  }
  std::vector<PlacedMesh> placed;
  placed.reserve(meshes.size() + compartments.size());
  for (const auto& mesh : meshes) placed.push_back({.mesh = mesh.get()});
  placed.insert(placed.end(), compartments.begin(), compartments.end());
  if (body.subdivision != nullptr) {
    for (const BodyCompartment& compartment : body.subdivision->compartments) {
      if (factor_of(compartment, compartment.flooded) < 0.0) names.push_back(compartment.name);
    }
  }
  Expected<FloatingBody> floating = FloatingBody::make(placed, whole.mass(), whole.center_of_mass_B());
  if (!floating) return tl::unexpected(floating.error());
  return BodyShares{std::move(meshes), std::move(names), *std::move(floating)};
}

SceneDescription mesh_scene(const HydrostaticsOptions& options, const MeshPlacement& placement) {
  SceneDescription scene =
      single_mesh_scene(options.mesh, Method::kHierarchical, 0.0, options.open, placement);
  scene.water.density = options.density;
  scene.water.gravity = options.gravity;
  return scene;
}

}  // namespace

Expected<LoadedScene> load_scene(const HydrostaticsOptions& options, const HydrostaticsPlan& plan) {
  Expected<Scene> scene =
      options.mesh.empty() ? Scene::load(options.scene) : Scene::prepare(mesh_scene(options, plan.placement));
  if (!scene) return tl::unexpected(scene.error());
  const Expected<const Body*> body = body_of(*scene, options.body);
  if (!body) return tl::unexpected(body.error());
  std::string name = options.mesh.filename().string();
  if (options.mesh.empty()) {
    name = options.scene.filename().string().append(", ").append((*body)->name);
  }
  return LoadedScene{std::move(name), *std::move(scene), *body, options.mesh.empty()};
}

Expected<LoadedBody> load_body(LoadedScene loaded, const HydrostaticsPlan& plan) {
  const Scene& scene = loaded.scene;
  const Body& body = *loaded.body;

  Expected<RigidBodyMass> mass =
      RigidBodyMass{.mass = plan.mass.value_or(0.0), .center_of_mass_B = plan.center_of_mass_B};
  const DynamicsSpec& dynamics = body.dynamics;
  const bool knows_mass = loaded.is_of_scene ? dynamics.mass || dynamics.density : plan.mass.has_value();
  if (loaded.is_of_scene) mass = mass_of_body(body, scene.water());
  if (loaded.is_of_scene && !dynamics.given) {
    mass = make_error({scene.name() + ": body '" + body.name + "'", "no section [body.client]",
                       "a section [body.client] with density, or with mass and center_of_mass",
                       "the service needs no mass, but what floats does",
                       "Add the section to the body in the scene file"});
  }
  if (!mass && needs_mass(plan.command)) return tl::unexpected(mass.error());

  std::shared_ptr<const HydrostaticMesh> mesh = with_tree(body.prepared_mesh->mesh);
  const bool uses_mass = mass && (knows_mass || needs_mass(plan.command));
  Expected<FloatingBody> floating =
      uses_mass ? floating_body_of(body, *mesh, *mass) : floating_hull_of(body, *mesh);
  if (!floating) return tl::unexpected(floating.error());
  Expected<std::optional<BodyShares>> shares = std::nullopt;
  if (plan.command == HydrostaticsCommand::kEquilibrium) shares = shares_of(body, *floating, mesh);
  if (!shares) return tl::unexpected(shares.error());
  std::optional<Warning> assumed;
  if (loaded.is_of_scene && uses_mass && !knows_mass) {
    assumed = {scene.name() + ": body '" + body.name + "'",
               "a mass of " + format_number(mass->mass, 6) + " kg is assumed",
               "mass or density in [body.client]", "without them a body has half the density of the water",
               "Set one of them to what the body weighs"};
  }
  return LoadedBody{std::move(loaded.name), std::move(loaded.scene), loaded.body, std::move(mesh),
                    *std::move(floating),   *std::move(shares),      uses_mass,   std::move(assumed)};
}

}  // namespace buoyancy::service
