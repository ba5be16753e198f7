// The lowest vertex of a surface along any direction, by branch and bound over the moment tree.
#pragma once

#include "geometry/moment_tree.h"

namespace buoyancy {

// Returns the least coordinate of the vertices along up_B [m], from the mesh's centre. up_B: unit, in the
// mesh's frame. Complexity: O(log n) where few vertices are nearly as low, O(n) where all are.
double lowest_vertex(const MomentTree& tree, const Vec3& up_B);

}  // namespace buoyancy
