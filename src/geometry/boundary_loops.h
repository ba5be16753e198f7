// Finds the edges that a mesh lacks, as closed loops over which caps belong.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/edge_uses.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

using Loop = std::vector<std::int32_t>;  // vertices in the direction of the cap's edges

// Returns the net chain of the edges that a mesh lacks: each as often, and in the direction, as it lacks
// uses; ascending. O(n).
std::vector<Edge> missing_edges(const TriangleMesh& mesh);

// Divides directed edges into closed loops that use no vertex twice. A walk that ends away from its start
// counts as a loop with one more edge; a net chain has no such walk. edges: ascending. O(n log n).
std::vector<Loop> find_loops(const std::vector<Edge>& edges);

// Directs edges along trails, each continued as far as it goes, and returns them ascending. Where faces
// around a hole have no consistent winding, its edges do not follow each other.
std::vector<Edge> directed_along_trails(const std::vector<Edge>& edges);

}  // namespace buoyancy
