#include "geometry/mesh_repair.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/duplicate_faces.h"
#include "geometry/edge_insertion.h"
#include "geometry/enclosed_solid.h"
#include "geometry/face_winding.h"
#include "geometry/flat_sheets.h"
#include "geometry/hole_caps.h"
#include "geometry/inner_faces.h"
#include "geometry/welding.h"

namespace buoyancy {
namespace {

// The exact predicates, and squares and cubes of lengths, are far from overflow and underflow between these.
constexpr double kMinDiagonal = 1e-50;  // [m]
constexpr double kMaxDiagonal = 1e50;   // [m]

// A body of which moved vertices might have changed a larger share of the volume stays as it was given.
constexpr double kMaxShareMoved = 1e-2;

constexpr double kMinVolume = 1e-10;  // of a solid, as a share of the cube of its diagonal

constexpr int kMaxPasses = 3;

// Removing a sheet or closing a hole can make it possible to tell inner faces from the surface.
constexpr int kMaxRounds = 3;

// Runs steps one after the other and adds to their reports what the mesh encloses.
class Ladder {
 public:
  explicit Ladder(TriangleMesh& mesh) : mesh_(&mesh), solid_(enclosed_solid(mesh)) {}
  // Continues from the state of another ladder, with a copy of its mesh.
  Ladder(TriangleMesh& mesh, const Ladder& other)
      : mesh_(&mesh), report_(other.report_), solid_(other.solid_) {}

  template <typename Step>
  void run(const Step& step) {
    const std::size_t steps = report_.steps.size();
    step(*mesh_, report_);
    if (report_.steps.size() == steps) return;
    report_.steps[steps].before = solid_;
    solid_ = enclosed_solid(*mesh_);
    report_.steps.back().after = solid_;
  }

  // Takes over the report of a ladder that continued from here, whose mesh the caller has moved here.
  void take(Ladder& other) {
    report_ = std::move(other.report_);
    solid_ = other.solid_;
  }

  RepairReport& report() { return report_; }
  const std::optional<EnclosedSolid>& solid() const { return solid_; }
  bool is_closed() const { return mesh_topology(*mesh_).counts.all_matched(); }

 private:
  TriangleMesh* mesh_;
  RepairReport report_;
  std::optional<EnclosedSolid> solid_;
};

// Removes what does not bound the body and closes negligible holes, until the mesh is closed or nothing
// helps.
void close(Ladder& ladder, double tolerance) {
  for (int round = 0; round < kMaxRounds && !ladder.is_closed(); ++round) {
    const std::size_t steps = ladder.report().steps.size();
    ladder.run([tolerance](TriangleMesh& mesh, RepairReport& report) {
      remove_inner_faces(mesh, tolerance, report);
    });
    ladder.run([tolerance](TriangleMesh& mesh, RepairReport& report) {
      remove_flat_sheets(mesh, tolerance, report);
    });
    ladder.run(cap_negligible_holes);
    if (ladder.report().steps.size() == steps) break;
  }
}

// Returns whether a mesh is not closed only because walls inside it could not be told from the surface. If it
// was given with both sides of these walls, which cancel, it can stay as it was.
bool only_walls_are_in_the_way(const TriangleMesh& mesh, const RepairReport& report) {
  const MeshTopology topology = mesh_topology(mesh);
  return topology.boundary.empty() && !topology.counts.all_matched() &&
         std::all_of(report.skipped.begin(), report.skipped.end(), [](const SkippedRepair& skipped) {
           return skipped.kind == RepairKind::kRemoveInnerFaces &&
                  (skipped.obstacle == RepairObstacle::kSelfIntersection ||
                   skipped.obstacle == RepairObstacle::kTooMany);
         });
}

// Returns whether copies were removed, which counted the volume of a part twice.
bool removed_copies(const RepairReport& report) {
  return std::any_of(report.steps.begin(), report.steps.end(),
                     [](const RepairStep& step) { return step.kind == RepairKind::kRemoveDuplicates; });
}

void remove_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::int32_t> itself(mesh.vertex_count());
  std::iota(itself.begin(), itself.end(), 0);
  mesh = merge_vertices(mesh, itself);
}

RepairReport repair_once(TriangleMesh& mesh, bool may_stay_open) {
  const double diagonal = mesh.triangles.empty() ? 0.0 : bounding_box(mesh).diagonal();
  if (!(diagonal >= kMinDiagonal && diagonal <= kMaxDiagonal)) return {};
  const double tolerance = kRepairTolerance * diagonal;
  Ladder ladder(mesh);
  const bool was_matched = ladder.is_closed();
  const std::optional<EnclosedSolid> given_solid = ladder.solid();
  const TriangleMesh given = mesh;
  ladder.run(
      [tolerance](TriangleMesh& m, RepairReport& report) { weld_within_tolerance(m, tolerance, report); });
  const auto remove_duplicates = [tolerance](TriangleMesh& m, RepairReport& report) {
    remove_duplicate_faces(m, tolerance, report);
  };
  const auto remove_sheets = [tolerance](TriangleMesh& m, RepairReport& report) {
    remove_flat_sheets(m, tolerance, report);
  };
  // Duplicates are removed first, since T-junctions cannot be told from edges of faces that are stored twice.
  // They are removed again afterwards, since inserted vertices can make faces equal.
  ladder.run(remove_duplicates);
  const std::size_t steps = ladder.report().steps.size();
  ladder.run(
      [tolerance](TriangleMesh& m, RepairReport& report) { insert_vertices_on_edges(m, tolerance, report); });
  if (ladder.report().steps.size() > steps) ladder.run(remove_duplicates);
  ladder.run(make_winding_consistent);

  // From here on the volume is known to be that of the given surface only if that is closed in the end.
  std::optional<TriangleMesh> open_mesh;
  std::optional<RepairReport> open_report;
  if (may_stay_open) {
    open_mesh = mesh;
    open_report = ladder.report();
  }
  if (!ladder.is_closed() && !is_soup(mesh, mesh_topology(mesh))) {
    // The outside may reach decks and bulkheads through small holes: these are closed first, on trial.
    TriangleMesh trial_mesh = mesh;
    Ladder trial(trial_mesh, ladder);
    trial.run(remove_sheets);
    trial.run(cap_small_holes);
    close(trial, tolerance);
    if (trial.solid() && trial.report().cap_bulge <= kNegligibleBulge * trial.solid()->volume) {
      mesh = std::move(trial_mesh);
      ladder.take(trial);
    }
  }
  close(ladder, tolerance);
  if (may_stay_open && !ladder.is_closed()) {
    mesh = *std::move(open_mesh);
    ladder.report() = *std::move(open_report);
  }
  if (ladder.is_closed()) {
    ladder.report().skipped.clear();
    if (ladder.solid() && !(ladder.report().volume_bound <= kMaxShareMoved * ladder.solid()->volume)) {
      const auto faces = static_cast<std::int64_t>(given.triangles.size());
      mesh = given;
      ladder.report() = {{}, {{RepairKind::kWeld, RepairObstacle::kTooThin, faces}}, 0.0, 0.0};
    }
  }
  // A closed solid that repair had to move or cap stays as given: its duplicates were no faults.
  const bool moved_or_capped = ladder.report().volume_bound > 0.0 || ladder.report().cap_bulge > 0.0;
  if (given_solid && ladder.solid() && moved_or_capped &&
      given_solid->volume > 0.5 * ladder.solid()->volume) {
    mesh = given;
    return {};
  }
  if (was_matched && only_walls_are_in_the_way(mesh, ladder.report())) {
    mesh = given;
    ladder.report() = {{}, std::move(ladder.report().skipped), 0.0, 0.0};
  }
  // A solid that is open now stays as given: faces of both sides that cancel were taken for its surface.
  if (given_solid && given_solid->volume > kMinVolume * diagonal * diagonal * diagonal &&
      !ladder.is_closed() && !removed_copies(ladder.report())) {
    mesh = given;
    return {};
  }
  if (!ladder.report().steps.empty()) remove_unused_vertices(mesh);
  return std::move(ladder.report());
}

}  // namespace

bool is_soup(const TriangleMesh& mesh, const MeshTopology& topology) {
  return topology.boundary.size() > mesh.triangles.size();
}

bool needs_repair(const MeshTopology& topology) {
  return !topology.counts.all_matched() || topology.counts.balanced > 0 || topology.duplicate_faces > 0;
}

RepairReport repair_mesh(TriangleMesh& mesh, bool may_stay_open) {
  RepairReport report;
  // One pass suffices, except for a few meshes in which a step leaves work for an earlier step.
  for (int pass = 0; pass < kMaxPasses && needs_repair(mesh_topology(mesh)); ++pass) {
    const bool was_matched = mesh_topology(mesh).counts.all_matched();
    const RepairReport more = repair_once(mesh, may_stay_open);
    report.skipped.clear();
    append(more, report);
    const bool opened = was_matched && !mesh_topology(mesh).counts.all_matched();
    if (more.steps.empty() || (opened && !may_stay_open)) break;
  }
  return report;
}

}  // namespace buoyancy
