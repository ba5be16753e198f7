#include "scene/prepared_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "base/format.h"
#include "scene/up_axis.h"

namespace buoyancy {
namespace {

// Appends a prepared mesh's triangles, in B.
void append(const HydrostaticMesh& mesh, TriangleMesh& all) {
  const auto first = static_cast<std::int32_t>(all.x.size());
  for (std::size_t i = 0; i < mesh.surface.x.size(); ++i) {
    all.add_vertex(mesh.center_B + mesh.vertex(static_cast<std::int32_t>(i)));
  }
  for (const Triangle& triangle : mesh.surface.triangles) {
    all.triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
  }
}

void append(const MeshReport& report, MeshReport& all) {
  all.triangles += report.triangles;
  all.vertices_stored += report.vertices_stored;
  all.vertices_welded += report.vertices_welded;
  if (report.weld != WeldKind::kExact) all.weld = report.weld;
  all.weld_largest_move = std::max(all.weld_largest_move, report.weld_largest_move);
  append(report.repair, all.repair);
  all.box = {all.box.min_B.cwiseMin(report.box.min_B), all.box.max_B.cwiseMax(report.box.max_B)};
  all.diagonal = all.box.diagonal();
  all.area += report.area;
  all.volume += report.volume;
  all.volume_by_axis += report.volume_by_axis;
  all.area_vector += report.area_vector;
  all.balanced_edges += report.balanced_edges;
  all.degenerate_faces += report.degenerate_faces;
  all.dropped_faces += report.dropped_faces;
  all.duplicate_faces += report.duplicate_faces;
  // Faces of two parts that intersect are not counted: their common volume is reported instead.
  if (all.intersecting_pairs && report.intersecting_pairs) {
    *all.intersecting_pairs += *report.intersecting_pairs;
    if (all.overlap_volume && report.overlap_volume) *all.overlap_volume += *report.overlap_volume;
    all.intersections_cut_off = all.intersections_cut_off || report.intersections_cut_off;
  }
  all.components.insert(all.components.end(), report.components.begin(), report.components.end());
}

// The other methods sum volumes under a plane water surface.
bool works_in_waves(Method method) {
  return method == Method::kHierarchical || method == Method::kFastSurface || method == Method::kExactSurface;
}

}  // namespace

MeshValidation validate_mesh(ImportedMesh imported, const std::string& name,
                             const MeshPreparation& preparation) {
  std::optional<RepairStep> mirrored;
  const MeshPlacement& placement = preparation.placement;
  if (preparation.mirror) {
    Expected<RepairStep> step = add_mirror_image(imported.mesh, *preparation.mirror, name);
    if (!step) {
      MeshValidation refused;
      refused.report.name = name;
      refused.report.source = imported.source;
      refused.refusal = std::move(step.error());
      return refused;
    }
    step->area *= std::pow(placement.size_factor(), 2.0);
    step->max_move *= placement.scale.cwiseAbs().maxCoeff();
    mirrored = *step;
  }
  place(imported.mesh, placement);
  imported.source.polygons.largest_distance *= placement.scale.cwiseAbs().maxCoeff();
  imported.source.polygons.split_volume *= std::abs(placement.scale.prod());
  MeshValidation validation = validate_mesh(imported, name, preparation.validation);
  MeshReport& report = validation.report;
  if (mirrored) report.repair.steps.insert(report.repair.steps.begin(), *mirrored);
  if (const std::optional<Vec3> up = axis_from_name(report.source.up_axis)) {
    report.up_B = (placement.orientation_B.normalized() * up->cwiseProduct(placement.scale)).normalized();
  }
  return validation;
}

Expected<PreparedMesh> prepare_mesh(ImportedMesh imported, const std::string& name,
                                    const MeshPreparation& preparation, MeshReport* refused) {
  MeshValidation validation = validate_mesh(std::move(imported), name, preparation);
  if (!validation.mesh) {
    assert(validation.refusal);
    if (refused != nullptr) *refused = std::move(validation.report);
    return make_error(*std::move(validation.refusal));
  }
  return PreparedMesh{
      std::move(validation.report),
      make_hydrostatic_mesh(*validation.mesh, WithTree::kNo, preparation.placement.size_factor()),
      mass_properties(validation.mesh->mesh), std::nullopt, preparation.placement.scale};
}

PreparedMesh merge_meshes(std::span<const PreparedMesh* const> meshes) {
  ValidatedMesh all;
  for (const PreparedMesh* mesh : meshes) append(mesh->mesh, all.mesh);
  MeshReport report = meshes.front()->report;
  for (const PreparedMesh* mesh : meshes.subspan(1)) append(mesh->report, report);
  std::stable_sort(report.components.begin(), report.components.end(),
                   [](const ComponentReport& a, const ComponentReport& b) {
                     return std::abs(a.volume) > std::abs(b.volume);
                   });
  report.source = {};
  report.up_B.reset();
  report.source.format = std::to_string(meshes.size()) + " parts";
  std::string name;
  for (const PreparedMesh* mesh : meshes) name += (name.empty() ? "" : " + ") + mesh->report.name;
  report.name = std::move(name);
  return PreparedMesh{std::move(report), make_hydrostatic_mesh(all, WithTree::kNo), mass_properties(all.mesh),
                      std::nullopt, Vec3::Ones()};
}

std::optional<Error> method_error_in_waves(const std::string& subject, Method method, double tolerance) {
  if (!works_in_waves(method)) {
    return Error{
        subject, "method = \"" + std::string(to_string(method)) + "\"",
        "hierarchical, fast_surface or exact_surface in waves",
        "the methods fast, improved and exact sum volumes under a plane water surface, which waves are "
        "not",
        "Use hierarchical; fast_surface and exact_surface are baselines without an error bound"};
  }
  if (method == Method::kHierarchical && tolerance == 0.0) {
    return Error{subject, "tolerance = 0", "a number above 0, at most 1, in waves",
                 "the load of waves has no exact sum, only one within a bound",
                 "Leave the tolerance out: it is then " + format_shortest(kDefaultWaveTolerance)};
  }
  return std::nullopt;
}

std::optional<Error> size_error_in_waves(const std::string& name, const HydrostaticMesh& mesh) {
  constexpr double kSmallest = 1e-5;  // [m]
  constexpr double kLargest = 1e6;    // [m]
  if (mesh.diagonal >= kSmallest && mesh.diagonal <= kLargest) return std::nullopt;
  return Error{name, "a size of " + format_shortest(mesh.diagonal) + " m",
               "1e-5 to 1e6 m in waves (the diagonal of the bounding box)", "the mesh is in another unit",
               "Set scale, for example 0.001 for millimetres"};
}

}  // namespace buoyancy
