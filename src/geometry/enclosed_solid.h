// Finds the solid that a closed mesh encloses.
#pragma once

#include <optional>

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns what the mesh encloses once it is oriented as validation does (mesh_orientation.h); nullopt if an
// edge is not matched, or if too many components overlap. mesh: welded. Complexity: O(n log n).
std::optional<EnclosedSolid> enclosed_solid(TriangleMesh mesh);

}  // namespace buoyancy
