// Spans closed loops of edges with triangles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/boundary_loops.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the triangulation of least area if the loop has at most this number of edges and the work, edges^3
// / 6, is left; else one that cuts off the corner with the shortest diagonal first, which suits cracks.
// Neither adds vertices. loop: at least three vertices. Complexity for n edges: O(n^3) for least area, else
// O(n log n).
std::vector<Triangle> cap_loop(const TriangleMesh& mesh, const Loop& loop, std::size_t max_for_least_area,
                               std::int64_t& work_left);

// Returns a triangulation by ear clipping in the projection along the loop's area vector (triangulation.h),
// which suits flat loops of any shape. It adds no vertices. Complexity: that of triangulate().
std::vector<Triangle> cap_in_projection(const TriangleMesh& mesh, const Loop& loop);

// Returns the total area of the faces [m^2].
double area_of(const TriangleMesh& mesh, const std::vector<Triangle>& faces);

// Returns the volume of a hemisphere over a disc of this area [m^2]: 0.376 area^1.5 [m^3].
double bulge_of(double area);

}  // namespace buoyancy
