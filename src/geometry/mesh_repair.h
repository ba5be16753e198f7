// Repairs the faults of a mesh that leave its surface where it is, to 1e-6 L (L: bounding-box diagonal).
//
// The steps, in this order, each in a file of its own:
//   welding.h            merges vertices of unmatched edges within 1e-6 L of each other
//   duplicate_faces.h    removes faces that are stored twice, or for both sides
//   edge_insertion.h     inserts vertices into edges on which they lie (T-junctions)
//   face_winding.h       gives neighbouring faces a consistent winding
//   inner_faces.h        removes decks and bulkheads inside the surface, and fins of zero thickness
//   flat_sheets.h        removes plates of zero thickness
//   hole_caps.h          closes holes whose size is negligible
// A mesh in which each edge has one face on either side is left as it is. A step whose result is not
// certain is left out, which the report says. A repaired mesh that is not closed or balanced is refused by
// validation like any other: no step makes a mesh acceptable by relaxing a check. If moved vertices might
// have changed the volume by more than 1 %, the mesh stays as it was given.
//
// Every step is deterministic. Complexity: O(n log n) for n faces; steps that would take longer are cut off.
#pragma once

#include <cstdint>

#include "geometry/mesh_topology.h"
#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr double kRepairTolerance = 1e-6;  // relative to the bounding-box diagonal

// Whether the automatic repair may improve a mesh with this topology.
bool needs_repair(const MeshTopology& topology);

// Whether faces have more than one open edge on average, so that holes are no faults of a surface.
bool is_soup(const TriangleMesh& mesh, const MeshTopology& topology);

// Repairs the mesh. may_stay_open: if the mesh is not closed or balanced in the end, its inner faces, sheets
// and holes stay. Requires an exactly welded, finite mesh.
RepairReport repair_mesh(TriangleMesh& mesh, bool may_stay_open);

}  // namespace buoyancy
