// Triangles that span a closed loop of edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/boundary_loops.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the triangulation of least area if the loop has at most this number of edges and the work,
// edges^3 / 6, is left; else one that cuts off the corner with the shortest diagonal first, which suits
// cracks. Without further vertices. loop: at least three vertices. Complexity for n edges: O(n^3), else
// O(n log n).
std::vector<Triangle> cap_loop(const TriangleMesh& mesh, const Loop& loop, std::size_t max_for_least_area,
                               std::int64_t& work_left);

// Returns ears of the loop's projection along its area vector (triangulation.h), without further vertices:
// what a flat loop wants, whatever its shape. Complexity: that of triangulate().
std::vector<Triangle> cap_in_projection(const TriangleMesh& mesh, const Loop& loop);

// [m^2]
double area_of(const TriangleMesh& mesh, const std::vector<Triangle>& faces);

// [m^3], 0.376 area^1.5: of a hemisphere over a disc of this area [m^2].
double bulge_of(double area);

}  // namespace buoyancy
