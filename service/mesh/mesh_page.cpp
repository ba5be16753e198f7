#include "service/mesh/mesh_page.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "base/json.h"
#include "geometry/mesh_import.h"
#include "geometry/mesh_topology.h"
#include "geometry/welding.h"
#include "view/page/base64.h"
#include "view/page/mesh_drawing.h"
#include "view/page/page_assets.h"

namespace buoyancy::service {
namespace {

// The sorted positions of a face's corners, which identify the face whatever its winding.
using Place = std::array<double, 3>;
using FacePlaces = std::array<Place, 3>;

FacePlaces places_of(const TriangleMesh& mesh, const Triangle& face) {
  FacePlaces places;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 vertex = mesh.vertex(face[i]);
    places[i] = {vertex.x(), vertex.y(), vertex.z()};
  }
  std::sort(places.begin(), places.end());
  return places;
}

std::set<FacePlaces> places_of(const TriangleMesh& mesh) {
  std::set<FacePlaces> faces;
  for (const Triangle& face : mesh.triangles) faces.insert(places_of(mesh, face));
  return faces;
}

Json part_json(const TriangleMesh& mesh, const char* colour) {
  view::MeshDrawing drawing;
  view::append(drawing, mesh);
  view::reduce(drawing, view::kMaxDrawnTriangles);
  return {{"positions", view::base64_of<float>(drawing.positions)},
          {"indices", view::base64_of<std::uint32_t>(drawing.indices)},
          {"colour", colour}};
}

// Returns the faces that `others` has and those that it lacks as two parts, and the mesh's open edges.
Json mesh_json(const TriangleMesh& mesh, const std::set<FacePlaces>* others) {
  TriangleMesh kept = mesh;
  TriangleMesh changed = mesh;
  if (others == nullptr) {
    changed.triangles.clear();
  } else {
    std::erase_if(kept.triangles,
                  [&](const Triangle& face) { return !others->contains(places_of(mesh, face)); });
    std::erase_if(changed.triangles,
                  [&](const Triangle& face) { return others->contains(places_of(mesh, face)); });
  }
  std::vector<float> edges;
  for (const Edge& edge : mesh_topology(mesh).boundary) {
    for (const std::int32_t v : edge) {
      const Vec3 vertex = mesh.vertex(v);
      for (const double coordinate : vertex) edges.push_back(static_cast<float>(coordinate));
    }
  }
  return {{"parts", Json::array({part_json(kept, "kept"), part_json(changed, "changed")})},
          {"edges", view::base64_of<float>(edges)}};
}

}  // namespace

Expected<std::string> mesh_page(const MeshPlan& plan, const CheckedMesh& repaired) {
  Expected<ImportedMesh> imported = import_mesh(plan.inputs.front());
  if (!imported) return make_error(std::move(imported.error()));
  place(imported->mesh, plan.preparation.placement);
  const TriangleMesh before = weld(imported->mesh).mesh;
  BoundingBox box = bounding_box(before);
  Json data{{"version", BUOYANCY_VERSION},
            {"name", plan.inputs.front().filename().string()},
            {"summary", repaired.mesh ? "can be used after the repair" : "cannot be used"},
            {"report", to_text(*repaired.report)}};
  if (repaired.mesh) {
    const BoundingBox after = bounding_box(*repaired.mesh);
    box = {box.min_B.cwiseMin(after.min_B), box.max_B.cwiseMax(after.max_B)};
    const std::set<FacePlaces> given = places_of(before);
    const std::set<FacePlaces> left = places_of(*repaired.mesh);
    data["before"] = mesh_json(before, &left);
    data["after"] = mesh_json(*repaired.mesh, &given);
  } else {
    data["before"] = mesh_json(before, nullptr);
    data["after"] = nullptr;
  }
  data["centre"] = Vec3(box.center());
  data["size"] = box.diagonal();
  std::string page = view::self_contained_page("mesh.html", "");
  view::insert_data(page, json_line(data));
  return page;
}

}  // namespace buoyancy::service
