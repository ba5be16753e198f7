#include "geometry/mesh_validation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/common_volume.h"
#include "geometry/exact_predicates.h"
#include "geometry/hole_caps.h"
#include "geometry/hole_closing.h"
#include "geometry/mesh_checks.h"
#include "geometry/mesh_orientation.h"
#include "geometry/mesh_repair.h"
#include "geometry/mesh_topology.h"
#include "geometry/pairwise_total.h"
#include "geometry/self_intersection.h"
#include "geometry/surface_moments.h"

namespace buoyancy {
namespace {

struct SurfaceTotals {
  SurfaceMoments<double> moments;  // about the centre of the bounding box
  double area = 0.0;
  std::int64_t degenerate_faces = 0;

  SurfaceTotals& operator+=(const SurfaceTotals& other) {
    moments += other.moments;
    area += other.area;
    degenerate_faces += other.degenerate_faces;
    return *this;
  }
};

void report_repair(RepairReport repair, MeshReport& report) {
  for (const RepairStep& step : repair.steps) {
    if (step.kind != RepairKind::kWeld) continue;
    report.weld = WeldKind::kTolerance;
    report.weld_largest_move = std::max(report.weld_largest_move, step.max_move);
  }
  report.repair = std::move(repair);
}

void report_weld(const WeldedMesh& welded, MeshReport& report) {
  report.triangles = static_cast<std::int64_t>(welded.mesh.triangles.size());
  report.vertices_welded = static_cast<std::int64_t>(welded.mesh.vertex_count());
  report.dropped_faces = welded.faces_dropped;
}

void report_surface(const TriangleMesh& mesh, MeshReport& report) {
  if (mesh.triangles.empty()) return;
  report.box = bounding_box(mesh);
  report.diagonal = report.box.diagonal();
  const Vec3 center_B = report.box.center();
  const auto total = pairwise_total<SurfaceTotals>(mesh.triangles.size(), [&](std::size_t i) {
    const Triangle& face = mesh.triangles[i];
    SurfaceTotals totals;
    totals.moments = moments_of_triangle<double>(
        mesh.vertex(face[0]) - center_B, mesh.vertex(face[1]) - center_B, mesh.vertex(face[2]) - center_B);
    totals.area = totals.moments.S.norm();
    totals.degenerate_faces =
        collinear(mesh.vertex(face[0]), mesh.vertex(face[1]), mesh.vertex(face[2])) ? 1 : 0;
    return totals;
  });
  report.area = total.area;
  report.area_vector = total.moments.S;
  report.volume_by_axis = total.moments.N.diagonal();
  report.volume = report.volume_by_axis.sum() / 3.0;
  report.degenerate_faces = total.degenerate_faces;
}

// Returns the length of a hole's edges in the planes x = 0, y = 0 and z = 0 [m].
Vec3 length_in_planes(const TriangleMesh& mesh, const Hole& hole, double tolerance) {
  Vec3 lengths = Vec3::Zero();
  for (const auto& [from, to] : hole.edges) {
    const Vec3 a = mesh.vertex(from);
    const Vec3 b = mesh.vertex(to);
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (std::abs(a[i]) <= tolerance && std::abs(b[i]) <= tolerance) lengths[i] += (b - a).norm();
    }
  }
  return lengths;
}

// Requires report.diagonal to be set.
void report_topology(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<Hole>& holes,
                     MeshReport& report) {
  report.boundary_edges = topology.counts.boundary;
  report.non_manifold_edges = topology.counts.non_manifold;
  report.balanced_edges = topology.counts.balanced;
  report.misoriented_edges = topology.counts.misoriented;
  report.duplicate_faces = topology.duplicate_faces;
  std::int64_t work_left = kCapWork;
  for (const Hole& hole : holes) {
    const HoleSize size = measure_hole(mesh, hole, work_left);
    const bool slit = 2.0 * size.area <= kRepairTolerance * report.diagonal * size.perimeter;
    report.holes.push_back({static_cast<std::int64_t>(hole.edges.size()), hole.box, size.perimeter, size.area,
                            size.bulge, length_in_planes(mesh, hole, kRepairTolerance * report.diagonal),
                            slit});
  }
}

void report_components(std::vector<ComponentReport> components, MeshReport& report) {
  std::stable_sort(components.begin(), components.end(),
                   [](const ComponentReport& a, const ComponentReport& b) {
                     return std::abs(a.volume) > std::abs(b.volume);
                   });
  report.flipped =
      !components.empty() && std::all_of(components.begin(), components.end(),
                                         [](const ComponentReport& component) { return component.flipped; });
  report.components = std::move(components);
}

std::vector<std::int32_t> boundary_vertices(const MeshTopology& topology) {
  std::vector<std::int32_t> vertices;
  for (const Edge& edge : topology.boundary) vertices.push_back(edge[0]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

MeshValidation validate_mesh(const ImportedMesh& imported, const std::string& name,
                             const ValidationOptions& options) {
  MeshValidation validation;
  MeshReport& report = validation.report;
  report.name = name;
  report.source = imported.source;
  report.vertices_stored =
      static_cast<std::int64_t>(imported.mesh.vertex_count()) - imported.source.polygons.centers;
  validation.refusal = check_finite(imported.mesh, name);
  if (validation.refusal) return validation;

  WeldedMesh welded = weld(imported.mesh);
  TriangleMesh& mesh = welded.mesh;
  MeshTopology topology = mesh_topology(mesh);
  const bool automatic = options.repair == RepairPolicy::kAutomatic;
  if ((automatic && needs_repair(topology)) || !options.closing.empty()) {
    RepairReport repair;
    const bool may_stay_open = options.open == OpenPolicy::kDryBoundary && options.closing.empty();
    if (automatic) repair = repair_mesh(mesh, may_stay_open);
    close_holes(mesh, options.closing, automatic, repair);
    report_repair(std::move(repair), report);
    topology = mesh_topology(mesh);
  }
  report_weld(welded, report);
  report_surface(mesh, report);
  const std::vector<Hole> holes = find_holes(mesh, topology.boundary);
  report_topology(mesh, topology, holes, report);
  std::vector<ComponentReport> components = describe_components(mesh, topology);

  validation.refusal = check_size(report);
  if (!validation.refusal && !edges_are_usable(topology, options.open) && !is_soup(mesh, topology))
    report.closing = estimate_closing(mesh);
  if (!validation.refusal) validation.refusal = check_edges(mesh, topology, report, options);
  if (!validation.refusal) {
    double volume = 0.0;
    if (holes.empty()) {
      if (!orient_closed(mesh, topology, components)) validation.refusal = too_many_overlaps(report);
      if (std::ranges::any_of(components, &ComponentReport::flipped)) report_surface(mesh, report);
      volume = report.volume;
    } else {
      volume = orient_open(mesh, holes, components);
      report_surface(mesh, report);
    }
    if (!validation.refusal) validation.refusal = check_volume(mesh, volume, report);
  }
  report_components(std::move(components), report);
  if (options.count_intersecting_pairs) {
    report.intersecting_pairs = count_intersecting_pairs(mesh, &report.intersections_cut_off);
    if (report.closed() && !validation.refusal && !report.intersections_cut_off) {
      // Surfaces that neither cross nor contain each other enclose nothing twice.
      const bool may_overlap =
          report.intersecting_pairs > 0 || std::ranges::any_of(report.components, &ComponentReport::nested);
      report.overlap_volume = may_overlap ? overlap_volume(mesh) : 0.0;
    }
  }
  if (!validation.refusal) validation.mesh = ValidatedMesh{std::move(mesh), boundary_vertices(topology)};
  return validation;
}

}  // namespace buoyancy
