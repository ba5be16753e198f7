// Decides whether a mesh is usable for hydrostatic queries; if not, reports why.
//
// Faults that can be repaired without moving the surface are repaired first (mesh_repair.h), unless the
// caller switches that off; holes are closed if the caller asks for it (hole_closing.h). A mesh without
// faults keeps its triangles, in their order.
//
// Rule: every volume and first-moment integral over the wetted part is exact if each directed edge is matched
// by an opposite one. "Closed" meshes (each edge used once in each direction) and "balanced" meshes (each
// edge used equally often in both directions) satisfy it and are accepted. A mesh, or a component outside all
// others, of negative volume is inside out: it is flipped, which the report states. Open meshes are rejected
// or, with OpenPolicy::kDryBoundary, accepted if boundary edges are their only fault; the hydrostatics are
// then valid while the whole boundary is dry.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_report.h"

namespace buoyancy {

enum class OpenPolicy { kRefuse, kDryBoundary };
enum class RepairPolicy { kAutomatic, kNone };

struct ValidationOptions {
  OpenPolicy open = OpenPolicy::kRefuse;
  bool count_intersecting_pairs = false;  // O(n log n), several times the rest of the validation
  RepairPolicy repair = RepairPolicy::kAutomatic;
  ClosingOptions closing{};  // after the automatic repair
  bool may_be_open = true;   // for advice: the user may choose OpenPolicy::kDryBoundary
};

// A mesh that is usable for hydrostatic queries: welded, finite, oriented, and closed or balanced except for
// a boundary that OpenPolicy::kDryBoundary accepts.
struct ValidatedMesh {
  TriangleMesh mesh;
  std::vector<std::int32_t> boundary_vertices;  // ascending; empty unless the mesh is open
};

struct MeshValidation {
  MeshReport report;                  // always set
  std::optional<ValidatedMesh> mesh;  // set if accepted
  std::optional<Error> refusal;       // set if rejected
};

// Welds, repairs, checks and orients the mesh. name: identifies it in the report and the error.
MeshValidation validate_mesh(const ImportedMesh& imported, const std::string& name,
                             const ValidationOptions& options = {});

}  // namespace buoyancy
