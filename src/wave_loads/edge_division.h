// Divides the long edges of a surface, so that patches of its triangles can be small everywhere.
//
// Patches of waves are integrated with a quadratic model each (patch_tree.h). A triangle that is long against
// the waves, such as those of a cylinder without stacks, cannot be in small patches unless it is divided.
#pragma once

#include <cstddef>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the same surface with every edge that is longer than `longest` [m] divided into the fewest equal
// parts that are not; into fewer where there would be more than max_triangles. The triangles at an edge share
// its points, so that a closed surface stays closed. A triangle is divided in rows between its two longer
// edges: a needle whose edges have n parts becomes 2 n triangles, an equilateral one n^2. The vertices of
// `surface` come first and are not changed. Complexity: O(triangles) of the result.
TriangleMesh with_divided_edges(const TriangleMesh& surface, double longest, std::size_t max_triangles);

}  // namespace buoyancy
