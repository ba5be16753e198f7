// Welds a mesh: merges vertices at the same position, so that neighbouring triangles share their edges.
//
// The exact weld merges vertices of equal coordinates (-0 equals 0). If it leaves unmatched edges, the
// tolerance weld also merges those edges' vertices that lie within 1e-6 L of each other (L: bounding-box
// diagonal). Its result is used only if every edge is then matched (closed or balanced, mesh_topology.h);
// otherwise the exact weld is kept. Vertices that are not on an unmatched edge never move. Vertices keep the
// order of their first occurrence. Triangles that use a vertex twice enclose nothing; they are dropped and
// counted. Complexity: O(n log n) for n vertices, unless many of them lie in two neighbouring cells of the
// tolerance's size without being within the tolerance of each other.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr double kWeldTolerance = 1e-6;  // relative to the bounding-box diagonal

enum class WeldKind { kExact, kTolerance };

struct WeldedMesh {
  TriangleMesh mesh;  // without unused vertices and triangles with two equal indices
  WeldKind kind = WeldKind::kExact;
  std::int64_t vertices_stored = 0;
  std::int64_t faces_dropped = 0;  // used a vertex twice, before or after welding
  double max_move = 0.0;           // largest displacement of a vertex by a tolerance weld [m]
};

// Requires finite coordinates and valid indices.
WeldedMesh weld(const TriangleMesh& mesh);

}  // namespace buoyancy
