// Counts the pairs of faces of a mesh that cross each other: on such a mesh the volume integrals count the
// overlap twice (winding number 2), which a person should be told.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Pairs of faces without a common vertex whose triangles have a point in common, plus pairs with common
// vertices that have points in common besides those vertices and the edge between them. Faces of zero area
// are left out. mesh: welded, finite. Complexity: O(n log n) for meshes whose faces are small against the
// whole. Decisions by exact predicates (exact_predicates.h): touching counts.
std::int64_t count_intersecting_pairs(const TriangleMesh& mesh);

}  // namespace buoyancy
