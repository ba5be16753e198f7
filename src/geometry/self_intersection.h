// Counts the pairs of intersecting faces of a mesh. The volume integrals of a self-intersecting mesh count
// the overlap twice (winding number 2), which the report states.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the number of pairs of faces without a common vertex that share a point, plus the number of pairs
// with common vertices that share points other than these vertices and the edge between them. Touching
// counts; all decisions use exact predicates (exact_predicates.h). Faces of zero area are ignored. mesh:
// welded, finite. Ends after some 64 pairs per face whose boxes overlap, and 5,000,000 more: what it returns
// is then a lower bound, and *cut_off is set. Complexity: O(n log n).
std::int64_t count_intersecting_pairs(const TriangleMesh& mesh, bool* cut_off = nullptr);

}  // namespace buoyancy
