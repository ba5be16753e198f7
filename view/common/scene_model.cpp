#include "view/common/scene_model.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "scene/scene_report.h"
#include "view/common/sea_json.h"
#include "view/page/base64.h"
#include "view/page/mesh_drawing.h"
#include "waves/sea.h"

namespace buoyancy::view {
namespace {

// The meshes that are drawn, by their index in the scene: all but those of parts alone.
std::vector<std::size_t> drawn_meshes(const Scene& scene) {
  std::unordered_set<const PreparedMesh*> drawn;
  for (const Body& body : scene.bodies()) {
    drawn.insert(body.prepared_mesh);
    if (body.subdivision == nullptr) continue;
    for (const BodyCompartment& compartment : body.subdivision->compartments) {
      drawn.insert(compartment.prepared_mesh);
    }
    for (const BodyTank& tank : body.subdivision->tanks) drawn.insert(tank.prepared_mesh);
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    if (drawn.contains(scene.meshes()[i].get())) indices.push_back(i);
  }
  return indices;
}

// The maximum number of triangles per mesh that keeps the total within max_triangles and reduces only meshes
// that exceed an equal share of what the smaller ones leave.
std::size_t max_triangles_per_mesh(const Scene& scene, const std::vector<std::size_t>& drawn,
                                   std::size_t max_triangles) {
  std::vector<std::size_t> sizes;
  sizes.reserve(drawn.size());
  for (const std::size_t i : drawn) sizes.push_back(scene.meshes()[i]->mesh.surface.triangles.size());
  std::ranges::sort(sizes);
  std::size_t remaining = max_triangles;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t share = remaining / (sizes.size() - i);
    if (sizes[i] > share) return share;
    remaining -= sizes[i];
  }
  return max_triangles;
}

std::string file_name(const Json& path) {
  return std::filesystem::path(path.get<std::string>()).filename().string();
}

// Adds the data of loads. Nothing is added if no body has loads, which keeps the page of such a run small.
void add_loads(const Scene& scene, Json& model) {
  if (std::ranges::none_of(scene.bodies(), has_loads)) return;
  const HorizontalAxes axes = horizontal_axes(scene.water().up_W);
  model["loads"] = {{"e1", axes.e1_W},
                    {"e2", axes.e2_W},
                    {"current", scene.current_W()},
                    {"waves", scene.sea() != nullptr || scene.receives_sea()}};
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    if (!has_loads(body)) continue;
    const HydrodynamicCoefficients none;
    const HydrodynamicCoefficients& coefficients =
        body.hydrodynamics != nullptr ? body.hydrodynamics->coefficients() : none;
    model["bodies"][i]["loads"] = {
        {"drag_center", coefficients.drag ? std::optional(coefficients.drag->center_B) : std::nullopt},
        {"added_mass", coefficients.added_mass.has_value()},
        {"published", body.loads}};
  }
}

// Makes all "mesh" of bodies, compartments and tanks indices into the meshes that are drawn.
void number_meshes(const Scene& scene, const std::vector<std::size_t>& drawn, Json& bodies) {
  std::unordered_map<const PreparedMesh*, std::size_t> places;
  for (const std::size_t i : drawn) places.emplace(scene.meshes()[i].get(), places.size());
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    Json& described = bodies[i];
    described["mesh"] = places.at(body.prepared_mesh);
    described.erase("parts");
    if (body.subdivision == nullptr) continue;
    const auto number = [&places](const auto& sections, Json& list) {
      for (std::size_t k = 0; k < sections.size(); ++k) {
        list[k]["mesh"] = places.at(sections[k].prepared_mesh);
      }
    };
    number(body.subdivision->compartments, described["compartments"]);
    number(body.subdivision->tanks, described["tanks"]);
  }
}

}  // namespace

bool has_loads(const Body& body) {
  return body.loads || body.hydrodynamics != nullptr;
}

Json scene_model(const Scene& scene, const SceneModelOptions& options) {
  Json model = Json::parse(scene_report_json(scene));
  model["scene"] = file_name(model["scene"]);
  if (scene.sea() != nullptr) {
    model["sea"] = sea_json(*scene.sea());
  } else {
    model.erase("sea");
  }
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    model["bodies"][i]["center_of_mass"] = scene.bodies()[i].center_of_mass_B;
  }
  add_loads(scene, model);
  const std::vector<std::size_t> drawn = drawn_meshes(scene);
  const std::size_t share =
      std::max<std::size_t>(4, max_triangles_per_mesh(scene, drawn, options.max_triangles));
  Json meshes = Json::array();
  for (const std::size_t i : drawn) {
    const HydrostaticMesh& mesh = scene.meshes()[i]->mesh;
    MeshDrawing drawing;
    append(drawing, mesh.surface);
    reduce(drawing, share);
    Json& description = meshes.emplace_back(std::move(model["meshes"][i]));
    description["name"] = file_name(description["name"]);
    description.erase("sections");
    description["center"] = mesh.center_B;
    description["shown_triangles"] = drawing.triangle_count();
    description["positions"] = base64_of<float>(drawing.positions);
    description["indices"] = base64_of<std::uint32_t>(drawing.indices);
  }
  model["meshes"] = std::move(meshes);
  number_meshes(scene, drawn, model["bodies"]);
  return model;
}

}  // namespace buoyancy::view
