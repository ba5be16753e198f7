// Welds a mesh: merges vertices at the same position, so that neighbouring triangles share their edges.
//
// The exact weld merges vertices of equal coordinates (-0 equals 0). If it leaves unmatched edges, repair
// (mesh_repair.h) also merges those edges' vertices that lie within 1e-6 L of each other (L: bounding-box
// diagonal), whether or not that closes the mesh. Vertices that are not on an unmatched edge never move.
// Vertices keep the order of their first occurrence. Triangles that use a vertex twice enclose nothing; they
// are dropped and counted. Complexity: O(n log n) for n vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

enum class WeldKind { kExact, kTolerance };

struct WeldedMesh {
  TriangleMesh mesh;  // without unused vertices and triangles with two equal indices
  std::int64_t vertices_stored = 0;
  std::int64_t faces_dropped = 0;  // used a vertex twice, before or after welding
};

// Welds exactly. Requires finite coordinates and valid indices.
WeldedMesh weld(const TriangleMesh& mesh);

// Merges vertices of unmatched edges that lie within the tolerance [m] of each other, if that leaves fewer
// unmatched edges. A chain of close vertices that is longer than two tolerances is not a crack but a finely
// divided edge, and stays. If too many vertices are close to the tolerance, but not within it, nothing
// changes, which the report says. mesh: welded exactly.
void weld_within_tolerance(TriangleMesh& mesh, double tolerance, RepairReport& report);

// Returns the mesh with each vertex replaced by its representative, without faces that then use a vertex
// twice and without unused vertices.
TriangleMesh merge_vertices(const TriangleMesh& mesh, const std::vector<std::int32_t>& representative);

}  // namespace buoyancy
