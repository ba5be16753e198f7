#include "geometry/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/format.h"
#include "geometry/sheet_rounding_area.h"

namespace buoyancy {
namespace {

// Significant digits that suffice to find a point in a mesh editor.
constexpr int kDigits = 6;

std::string number(double value) {
  return format_number(value, kDigits);
}

std::string point(const Vec3& point_B) {
  return format_text("({:6})", point_B);
}

std::string edges_of_kind(const TriangleMesh& mesh, const std::vector<Edge>& edges, const std::string& kind) {
  return pluralize(static_cast<std::int64_t>(edges.size()), kind + " edge", kind + " edges") + " (one from " +
         point(mesh.vertex(edges.front()[0])) + " to " + point(mesh.vertex(edges.front()[1])) + ")";
}

std::string between(const BoundingBox& box) {
  return "between " + point(box.min_B) + " and " + point(box.max_B);
}

std::string holes_of(const MeshReport& report) {
  const HoleReport& largest = report.holes.front();
  return pluralize(report.boundary_edges, "boundary edge", "boundary edges") + " in " +
         pluralize(static_cast<std::int64_t>(report.holes.size()), "hole", "holes") + " (" +
         (report.holes.size() == 1 ? "" : "the largest of " + std::to_string(largest.edges) + " edges, ") +
         between(largest.box) + ")";
}

// Returns which options also close the other holes if only some are to be closed, by number or as rims.
std::string left_holes_advice(const MeshReport& report, const ClosingOptions& closing) {
  const auto still_open = [](const SkippedRepair& skipped) {
    return skipped.obstacle == RepairObstacle::kStillOpen;
  };
  if (closing.holes || closing.all_rims || std::ranges::none_of(report.repair.skipped, still_open)) return "";
  if (closing.rims.empty())
    return "Holes that do not face up would be left: add --rims, or close_holes in a scene file";
  constexpr std::size_t kMaxNamed = 8;
  std::string holes;
  std::string options;
  std::size_t left = 0;
  for (std::size_t i = 0; i < report.holes.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    if (std::ranges::count(closing.rims, static_cast<std::int32_t>(i) + 1) > 0 || ++left > kMaxNamed)
      continue;
    const HoleReport& hole = report.holes[i];
    holes += (left == 1 ? "Hole " : ", hole ") + number + " (" + format_number(hole.area, 4) + " m^2, " +
             between(hole.box) + ")";
    options += " --rim " + number;
  }
  if (left == 0) return "";
  if (left > kMaxNamed) return holes + " and others would be left: add --rims";
  return holes + " would be left: add" + options;
}

bool has_only_boundary(const MeshTopology& topology) {
  return topology.non_manifold.empty() && topology.misoriented.empty();
}

}  // namespace

bool edges_are_usable(const MeshTopology& topology, OpenPolicy open) {
  return topology.counts.all_matched() || (has_only_boundary(topology) && open == OpenPolicy::kDryBoundary);
}

std::optional<Error> check_finite(const TriangleMesh& mesh, const std::string& name) {
  for (const Triangle& face : mesh.triangles) {
    for (const std::int32_t v : face) {
      if (mesh.vertex(v).allFinite()) continue;
      return Error{name, "vertex " + std::to_string(v) + " (counted from 0) is " + point(mesh.vertex(v)),
                   "finite coordinates in metres", "the file is damaged, or the program that wrote it failed",
                   "Export the mesh again"};
    }
  }
  return std::nullopt;
}

std::optional<Error> check_size(const MeshReport& report) {
  if (report.triangles == 0) {
    const std::string dropped =
        report.dropped_faces == 0 ? "has no triangles"
                                  : "has no triangles: " + pluralize(report.dropped_faces, "face", "faces") +
                                        " used a vertex twice";
    return Error{report.name, dropped, "at least four triangles that enclose a volume",
                 "the file holds only points, lines or faces without extent", "Export the mesh's surface"};
  }
  if (!std::isfinite(report.diagonal) || !std::isfinite(report.area) || !std::isfinite(report.volume)) {
    return Error{report.name,
                 "reaches from " + point(report.box.min_B) + " to " + point(report.box.max_B) +
                     " m, too large to compute with",
                 "a body whose volume in m^3 is a finite number", "wrong units, or a damaged file",
                 "Scale the mesh to metres"};
  }
  const bool area_vanishes = report.area == 0.0 && report.degenerate_faces < report.triangles;
  if (report.diagonal == 0.0 || area_vanishes) {
    return Error{report.name,
                 "reaches from " + point(report.box.min_B) + " to " + point(report.box.max_B) +
                     (report.diagonal == 0.0 ? " m, which squared is 0" : " m; its area squared is 0"),
                 "a body that has an extent", "a scale of 0, or a size too small to represent",
                 "Scale the mesh to metres"};
  }
  return std::nullopt;
}

std::optional<Error> check_edges(const TriangleMesh& mesh, const MeshTopology& topology,
                                 const MeshReport& report, const ValidationOptions& options) {
  if (edges_are_usable(topology, options.open)) return std::nullopt;
  const bool only_open = has_only_boundary(topology);

  std::string actual = "has ";
  const auto add = [&actual](const std::string& fault) { actual += (actual == "has " ? "" : "; ") + fault; };
  if (!topology.boundary.empty()) add(holes_of(report));
  if (!topology.non_manifold.empty()) {
    add(edges_of_kind(mesh, topology.non_manifold, "non-manifold") + ", shared by three or more faces");
  }
  if (!topology.misoriented.empty()) {
    add(edges_of_kind(mesh, topology.misoriented, "misoriented") + " between faces of opposite winding");
  }
  if (report.duplicate_faces > 0) add(pluralize(report.duplicate_faces, "duplicate face", "duplicate faces"));

  std::string cause;
  std::string hint = left_holes_advice(report, options.closing);
  if (hint.empty()) hint = closing_advice(report);
  if (only_open) {
    cause = "faces are missing, or parts do not meet within 1e-6 of the mesh's size";
    if (hint.empty()) hint = "Close the holes in a mesh editor";
    if (options.may_be_open) {
      hint +=
          "; or, if they stay above the water, set open = \"dry_boundary\", in a scene file for this body "
          "(with buoyancy-replay --mesh: --open dry_boundary), which then needs mass, center_of_mass and "
          "inertia to be simulated";
    }
  } else {
    cause = report.duplicate_faces > 0 ? "faces stored twice, inner walls or faces of the wrong winding"
                                       : "inner walls, or faces of the wrong winding";
    if (!hint.empty()) hint += ". Or: ";
    hint += hint.empty() ? "In a mesh" : "in a mesh";
    hint += " editor remove duplicate and inner faces, make the winding consistent";
    hint += topology.boundary.empty() ? "" : ", and close the holes";
    hint += "; or replace the mesh by a closed hull around it";
    if (options.open == OpenPolicy::kDryBoundary) hint += ". dry_boundary accepts holes only";
  }
  return Error{report.name, actual,
               "a closed surface: each edge used as often in one direction as in the other", cause, hint};
}

Error too_many_overlaps(const MeshReport& report) {
  return {
      report.name,
      "has so many parts inside or across each other that it would take too long to tell which lie inside "
      "which",
      "parts beside each other, or some thousands within each other",
      "copies of a part that were not removed, or a damaged file",
      "Remove the copies, or join overlapping parts into one surface (boolean union)"};
}

std::optional<Error> check_volume(const TriangleMesh& mesh, double volume, const MeshReport& report) {
  const double rounding_error = std::numeric_limits<double>::epsilon() *
                                (64.0 * std::abs(volume) + report.diagonal * sheet_rounding_area(mesh));
  if (volume > rounding_error) return std::nullopt;
  if (volume < -rounding_error) {
    return Error{report.name, "encloses " + number(volume) + " m^3",
                 "cavities that are smaller than the parts around them",
                 "cavities that overlap each other, or parts that overlap themselves",
                 "Join overlapping parts into one surface (boolean union)"};
  }
  return Error{report.name,
               "encloses " + number(volume) + " m^3, which is not above the rounding error of " +
                   number(rounding_error) + " m^3",
               "a body that encloses a volume",
               "a flat sheet, or parts of opposite winding that cancel each other",
               "Give the sheet a thickness, or flip the parts so that all normals point outward"};
}

}  // namespace buoyancy
