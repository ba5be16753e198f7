#include "view/common/scene_model.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene_report.h"
#include "view/common/sea_json.h"
#include "view/page/base64.h"
#include "view/page/mesh_drawing.h"
#include "waves/sea.h"

namespace buoyancy::view {
namespace {

using Json = nlohmann::ordered_json;

// The maximum number of triangles per mesh that keeps the total within max_triangles and reduces only meshes
// that exceed an equal share of what the smaller ones leave.
std::size_t max_triangles_per_mesh(const Scene& scene, std::size_t max_triangles) {
  std::vector<std::size_t> sizes;
  for (const auto& prepared : scene.meshes()) sizes.push_back(prepared->mesh.surface.triangles.size());
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

Json json_array(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

// Without such bodies nothing is added, so that the page of a run stays as small as it is.
void add_loads(const Scene& scene, Json& model) {
  if (std::ranges::none_of(scene.bodies(), has_loads)) return;
  const HorizontalAxes axes = horizontal_axes(scene.water().up_W);
  model["loads"] = {{"e1", json_array(axes.e1_W)},
                    {"e2", json_array(axes.e2_W)},
                    {"current", json_array(scene.current_W())},
                    {"waves", scene.sea() != nullptr || scene.receives_sea()}};
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Body& body = scene.bodies()[i];
    if (!has_loads(body)) continue;
    const HydrodynamicCoefficients none;
    const HydrodynamicCoefficients& coefficients =
        body.hydrodynamics != nullptr ? body.hydrodynamics->coefficients() : none;
    model["bodies"][i]["loads"] = {
        {"drag_center", coefficients.drag ? json_array(coefficients.drag->center_B) : Json(nullptr)},
        {"added_mass", coefficients.added_mass.has_value()},
        {"published", body.loads}};
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
    const auto& center = scene.bodies()[i].center_of_mass_B;
    model["bodies"][i]["center_of_mass"] = center ? json_array(*center) : Json(nullptr);
  }
  add_loads(scene, model);
  const std::size_t share = std::max<std::size_t>(4, max_triangles_per_mesh(scene, options.max_triangles));
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    const HydrostaticMesh& mesh = scene.meshes()[i]->mesh;
    MeshDrawing drawing;
    append(drawing, mesh.surface);
    reduce(drawing, share);
    Json& description = model["meshes"][i];
    description["name"] = file_name(description["name"]);
    description["center"] = json_array(mesh.center_B);
    description["shown_triangles"] = drawing.triangle_count();
    description["positions"] = base64_of<float>(drawing.positions);
    description["indices"] = base64_of<std::uint32_t>(drawing.indices);
  }
  return model;
}

}  // namespace buoyancy::view
