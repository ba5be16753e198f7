// Makes vertices that lie at the same place one vertex, so that neighbouring triangles share their edges.
//
// First vertices of equal coordinates (-0 equals 0). If that leaves edges without a partner, also those
// edges' vertices that lie within 1e-6 L of each other (L: bounding-box diagonal), but only if every edge
// then has its partner (closed or balanced, mesh_topology.h); else the exact weld stands. What is not beside
// a crack never moves. Vertices keep the order of their first occurrence. Triangles that name a vertex twice
// enclose nothing and are dropped and counted. Complexity: O(n log n) for n vertices, unless many of them
// crowd into two neighbouring cells of the tolerance's size without being within it.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr double kWeldTolerance = 1e-6;  // of the bounding-box diagonal

enum class WeldKind { kExact, kTolerance };

struct WeldedMesh {
  TriangleMesh mesh;  // no vertex unused, no triangle with two equal indices
  WeldKind kind = WeldKind::kExact;
  std::int64_t vertices_stored = 0;
  std::int64_t faces_dropped = 0;  // named a vertex twice, before or after welding
  double largest_move = 0.0;       // m: farthest any vertex was moved by a tolerance weld
};

// mesh: coordinates finite, indices in range.
WeldedMesh weld(const TriangleMesh& mesh);

}  // namespace buoyancy
