// Measures how far the surface of one mesh is from another's.
#pragma once

#include "geometry/aabb_tree.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Distances from points to a mesh, with its triangles in a tree.
class SurfaceDistance {
 public:
  // mesh: at least one triangle; must outlive this object. O(n log n).
  explicit SurfaceDistance(const TriangleMesh& mesh);

  // Returns the distance from the point to the surface [m]. O(log n) for points near the surface.
  double to(const Vec3& point);

 private:
  const TriangleMesh& mesh_;
  AabbTree tree_;
  std::int32_t last_ = 0;  // the nearest triangle of the last call, where the next is likely too
};

// Returns the largest distance [m] from a vertex or a triangle's centroid of `from` to the surface of `to`.
// Another point of a triangle may be farther away, by less than the triangle's size. O(n log m) for meshes
// near each other.
double largest_distance(const TriangleMesh& from, const TriangleMesh& to);

}  // namespace buoyancy
