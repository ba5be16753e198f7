// The lowest vertex of a surface along any direction, by branch and bound over the moment tree.
#pragma once

#include "geometry/moment_tree.h"

namespace buoyancy {

// [m], of the vertex whose distance from the mesh's centre along up_B is the least: that distance. up_B:
// unit, in the mesh's frame. Complexity: O(log n) where few vertices are nearly as low, O(n) where all are.
double lowest_vertex(const MomentTree& tree, const Vec3& up_B);

}  // namespace buoyancy
