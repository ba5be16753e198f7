// Makes vertices that lie at the same place one vertex, so that neighbouring triangles share their edges.
//
// First vertices of equal coordinates (-0 equals 0). If that leaves edges without a partner, also vertices
// within 1e-6 L of each other (L: bounding-box diagonal), but only if the result is then closed; else the
// exact weld stands. Triangles that thereby name a vertex twice enclose nothing and are dropped and counted.
// Complexity O(n log n) or better, n vertices.
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

WeldedMesh weld(const TriangleMesh& mesh);

}  // namespace buoyancy
