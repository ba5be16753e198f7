#include "geometry/flat_sheets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/aabb_tree.h"
#include "geometry/disjoint_sets.h"
#include "geometry/enclosed_solid.h"
#include "geometry/flatness.h"
#include "geometry/hole_caps.h"
#include "geometry/mesh_topology.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

constexpr double kClose = 1e3;      // sheets are close within this many tolerances
constexpr double kParallel = 1e-3;  // [rad]
constexpr double kSphere = 0.0941;  // largest volume that an area of 1 can enclose: 1 / (6 sqrt(pi))

struct Sheet {
  double area = 0.0;
  Vec3 normal = Vec3::Zero();  // of its largest face
  BoundingBox box;
};

Sheet describe(const TriangleMesh& mesh, const FaceList& faces, double margin) {
  Sheet sheet;
  double largest = -1.0;
  for (const std::int32_t f : faces) {
    const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
    const BoundingBox box = box_of_face(mesh, face);
    const Vec3 a = mesh.vertex(face[0]);
    const Vec3 normal = (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a);
    const double area = 0.5 * normal.norm();
    sheet.area += area;
    if (largest < 0.0) sheet.box = box;
    sheet.box = {sheet.box.min_B.cwiseMin(box.min_B), sheet.box.max_B.cwiseMax(box.max_B)};
    if (area > largest) {
      largest = area;
      sheet.normal = normal.normalized();
    }
  }
  sheet.box.min_B.array() -= margin;
  sheet.box.max_B.array() += margin;
  return sheet;
}

}  // namespace

std::vector<bool> sheets_to_leave_out(const TriangleMesh& mesh, const std::vector<FaceList>& sheets,
                                      double tolerance, double volume) {
  std::vector<Sheet> described;
  std::vector<BoundingBox> boxes;
  for (const FaceList& faces : sheets) {
    described.push_back(describe(mesh, faces, 0.5 * kClose * tolerance));
    boxes.push_back(described.back().box);
  }
  DisjointSets close(sheets.size());
  std::int64_t pairs_left = 1'000'000 + 10 * static_cast<std::int64_t>(sheets.size());
  const bool complete =
      AabbTree(std::move(boxes)).for_each_overlapping_pair([&](std::int32_t i, std::int32_t j) {
        close.unite(i, j);
        return --pairs_left > 0;
      });

  struct Cluster {
    std::int64_t sheets = 0;
    double area = 0.0;
    bool parallel = true;
  };
  std::vector<Cluster> clusters(sheets.size());
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const auto first = static_cast<std::size_t>(close.representative(static_cast<std::int32_t>(i)));
    Cluster& cluster = clusters[first];
    ++cluster.sheets;
    cluster.area += described[i].area;
    if (described[first].normal.cross(described[i].normal).norm() > kParallel) cluster.parallel = false;
  }
  std::vector<bool> left_out(sheets.size());
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const Cluster& cluster =
        clusters[static_cast<std::size_t>(close.representative(static_cast<std::int32_t>(i)))];
    const bool negligible = kSphere * cluster.area * std::sqrt(cluster.area) <= kNegligibleBulge * volume;
    left_out[i] = complete && distance_from_plane(mesh, sheets[i]) <= tolerance &&
                  (cluster.sheets < 3 || cluster.parallel || negligible);
  }
  return left_out;
}

void remove_flat_sheets(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  const MeshTopology topology = mesh_topology(mesh);
  if (topology.boundary.empty()) return;
  std::vector<bool> is_open(static_cast<std::size_t>(topology.components), false);
  for (const std::int32_t face : topology.boundary_faces)
    is_open[static_cast<std::size_t>(topology.component_of_face[static_cast<std::size_t>(face)])] = true;
  std::vector<FaceList> faces(is_open.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto component = static_cast<std::size_t>(topology.component_of_face[f]);
    if (is_open[component]) faces[component].push_back(static_cast<std::int32_t>(f));
  }
  std::vector<FaceList> sheets;
  std::vector<bool> in_sheet(mesh.triangles.size(), false);
  for (FaceList& component : faces) {
    if (component.empty() || !(distance_from_plane(mesh, component) <= tolerance)) continue;
    for (const std::int32_t face : component) in_sheet[static_cast<std::size_t>(face)] = true;
    sheets.push_back(std::move(component));
  }
  TriangleMesh rest = mesh;
  rest.triangles.clear();
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!in_sheet[f]) rest.triangles.push_back(mesh.triangles[f]);
  }
  if (sheets.empty() || rest.triangles.empty()) return;

  const std::optional<EnclosedSolid> solid = enclosed_solid(rest);
  const std::vector<bool> left_out =
      sheets_to_leave_out(mesh, sheets, tolerance, solid ? solid->volume : 0.0);
  RepairStep step;
  step.kind = RepairKind::kRemoveSheets;
  SkippedRepair skipped{RepairKind::kRemoveSheets, RepairObstacle::kAmbiguous, 0};
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    for (const std::int32_t f : sheets[i]) {
      const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
      if (left_out[i]) {
        ++step.count;
        step.area += area_of_face(mesh, face);
      } else {
        ++skipped.faces;
        rest.triangles.push_back(face);
      }
    }
  }
  std::erase_if(report.skipped, [](const SkippedRepair& earlier) {
    return earlier.kind == RepairKind::kRemoveSheets;  // of an earlier round
  });
  if (skipped.faces > 0) report.skipped.push_back(skipped);
  if (step.count == 0) return;
  mesh = std::move(rest);
  report.steps.push_back(step);
}

}  // namespace buoyancy
