#include "geometry/hole_caps.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "geometry/boundary_loops.h"
#include "geometry/disjoint_sets.h"
#include "geometry/enclosed_solid.h"
#include "geometry/loop_caps.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxForLeastArea = 64;  // edges

}  // namespace

HoleSize measure_hole(const TriangleMesh& mesh, const Hole& hole, std::int64_t& work_left) {
  HoleSize size;
  std::vector<Edge> edges;
  for (const auto& [from, to] : hole.edges) {
    edges.push_back({to, from});
    size.perimeter += (mesh.vertex(to) - mesh.vertex(from)).norm();
  }
  std::sort(edges.begin(), edges.end());
  for (const Loop& loop : find_loops(edges)) {
    const double area = area_of(mesh, cap_loop(mesh, loop, kMaxForLeastArea, work_left));
    size.area += area;
    size.bulge += bulge_of(area);
  }
  return size;
}

bool has_closed_loop(const std::vector<Edge>& edges) {
  std::vector<std::int32_t> vertices;
  for (const Edge& edge : edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  DisjointSets connected(vertices.size());
  for (const Edge& edge : edges) {
    const auto end = [&](std::int32_t v) {
      const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
      return connected.representative(static_cast<std::int32_t>(found - vertices.begin()));
    };
    if (end(edge[0]) == end(edge[1])) return true;
    connected.unite(end(edge[0]), end(edge[1]));
  }
  return false;
}

void cap_small_holes(TriangleMesh& mesh, RepairReport& report) {
  const std::vector<Edge> boundary = mesh_topology(mesh).boundary;
  if (boundary.empty()) return;
  const std::vector<Edge> trails = directed_along_trails(boundary);
  std::vector<Edge> wanted;
  wanted.reserve(boundary.size());
  for (const auto& [from, to] : boundary) wanted.push_back({to, from});
  std::sort(wanted.begin(), wanted.end());
  const BoundingBox box = bounding_box(mesh);
  const double most = kNegligibleBulge * (box.max_B - box.min_B).prod();
  RepairStep step;
  step.kind = RepairKind::kCapHoles;
  std::int64_t work_left = kCapWork;
  for (Loop& loop : find_loops(trails)) {
    if (!std::binary_search(trails.begin(), trails.end(), Edge{loop.back(), loop.front()})) continue;
    std::size_t matching = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Edge edge{loop[i], loop[(i + 1) % loop.size()]};
      if (std::binary_search(wanted.begin(), wanted.end(), edge)) ++matching;
    }
    if (2 * matching < loop.size()) std::reverse(loop.begin(), loop.end());
    const std::vector<Triangle> cap = cap_loop(mesh, loop, kMaxForLeastArea, work_left);
    const double area = area_of(mesh, cap);
    if (!(bulge_of(area) <= most)) continue;
    mesh.triangles.insert(mesh.triangles.end(), cap.begin(), cap.end());
    ++step.count;
    step.area += area;
    report.cap_bulge += bulge_of(area);
  }
  if (step.count > 0) report.steps.push_back(step);
}

void cap_negligible_holes(TriangleMesh& mesh, RepairReport& report) {
  RepairStep step;
  step.kind = RepairKind::kCapHoles;
  std::int64_t work_left = kCapWork;
  double bulge = 0.0;
  TriangleMesh capped = mesh;
  for (const Loop& loop : find_loops(missing_edges(mesh))) {
    const std::vector<Triangle> cap = cap_loop(mesh, loop, kMaxForLeastArea, work_left);
    const double area = area_of(mesh, cap);
    capped.triangles.insert(capped.triangles.end(), cap.begin(), cap.end());
    ++step.count;
    step.area += area;
    bulge += bulge_of(area);
  }
  if (step.count == 0) return;
  const std::optional<EnclosedSolid> solid = enclosed_solid(capped);
  if (!solid || !(bulge <= kNegligibleBulge * solid->volume)) return;
  mesh = std::move(capped);
  report.cap_bulge += bulge;
  report.steps.push_back(step);
}

}  // namespace buoyancy
