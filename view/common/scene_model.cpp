#include "view/common/scene_model.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <meshoptimizer.h>

#include "scene/scene_report.h"
#include "view/common/base64.h"
#include "view/common/sea_json.h"
#include "waves/sea.h"

namespace buoyancy::view {
namespace {

using Json = nlohmann::ordered_json;

struct Drawing {
  std::vector<float> positions;        // three per vertex
  std::vector<std::uint32_t> indices;  // three per triangle
};

Drawing full_drawing(const TriangleMesh& mesh) {
  Drawing drawing;
  drawing.positions.reserve(3 * mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    for (const double coordinate : {mesh.x[i], mesh.y[i], mesh.z[i]}) {
      drawing.positions.push_back(static_cast<float>(coordinate));
    }
  }
  drawing.indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t vertex : triangle) drawing.indices.push_back(static_cast<std::uint32_t>(vertex));
  }
  return drawing;
}

void reduce(Drawing& drawing, std::size_t max_triangles) {
  constexpr float kMaxError = 0.02F;  // relative to the mesh's extent
  constexpr std::size_t kVertexBytes = 3 * sizeof(float);
  const std::size_t vertices = drawing.positions.size() / 3;
  const std::size_t max_indices = 3 * max_triangles;
  std::vector<std::uint32_t> reduced(drawing.indices.size());
  std::size_t count =
      meshopt_simplify(reduced.data(), drawing.indices.data(), drawing.indices.size(),
                       drawing.positions.data(), vertices, kVertexBytes, max_indices, kMaxError);
  if (count > max_indices) {  // it preserves topology, so it cannot reduce many small disconnected parts
    count = meshopt_simplifySloppy(reduced.data(), drawing.indices.data(), drawing.indices.size(),
                                   drawing.positions.data(), vertices, kVertexBytes, max_indices, 1.0F);
  }
  reduced.resize(count);
  drawing.indices = std::move(reduced);
  std::vector<float> used_positions(drawing.positions.size());
  const std::size_t used_vertices =
      meshopt_optimizeVertexFetch(used_positions.data(), drawing.indices.data(), drawing.indices.size(),
                                  drawing.positions.data(), vertices, kVertexBytes);
  used_positions.resize(3 * used_vertices);
  drawing.positions = std::move(used_positions);
}

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
    Drawing drawing = full_drawing(mesh.surface);
    if (mesh.surface.triangles.size() > share) reduce(drawing, share);
    Json& description = model["meshes"][i];
    description["name"] = file_name(description["name"]);
    description["center"] = json_array(mesh.center_B);
    description["shown_triangles"] = drawing.indices.size() / 3;
    description["positions"] = base64_of<float>(drawing.positions);
    description["indices"] = base64_of<std::uint32_t>(drawing.indices);
  }
  return model;
}

}  // namespace buoyancy::view
