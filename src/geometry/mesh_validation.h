// Decides whether a mesh can carry a hydrostatic query, and says why not.
//
// The law: every volume and first-moment integral over the wet part is exact if each directed edge is matched
// by an opposite one. "Closed" (each edge used once each way) and "balanced" (each edge used as often one way
// as the other) meshes satisfy it and are accepted. A mesh, or a component outside all others, of negative
// volume is inside out: it is turned and the report says so. Open meshes are refused, or, with
// OpenPolicy::kDryBoundary, accepted if their only fault is boundary edges; the hydrostatics then hold while
// the whole boundary is dry.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_report.h"

namespace buoyancy {

enum class OpenPolicy { kRefuse, kDryBoundary };

struct ValidationOptions {
  OpenPolicy open = OpenPolicy::kRefuse;
  bool count_intersecting_pairs = false;  // O(n log n), several times the rest of the validation
};

// A mesh that may be asked hydrostatic requests: welded, finite, oriented, closed or balanced except for the
// boundary that OpenPolicy::kDryBoundary accepted.
struct ValidatedMesh {
  TriangleMesh mesh;
  std::vector<std::int32_t> boundary_vertices;  // of an accepted open mesh, else empty; ascending
};

struct MeshValidation {
  MeshReport report;                  // always filled
  std::optional<ValidatedMesh> mesh;  // if accepted
  std::optional<Error> refusal;       // if not
};

// Welds, looks and decides. name: for the report and the refusal.
MeshValidation validate_mesh(const ImportedMesh& imported, const std::string& name,
                             const ValidationOptions& options = {});

}  // namespace buoyancy
