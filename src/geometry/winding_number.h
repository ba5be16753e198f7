// Computes the winding number of a closed surface about a point, by exact predicates.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/aabb_tree.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// The faces of a surface, against which rays along +x are cast. Refers to the mesh, which must outlive it.
class WindingNumber {
 public:
  WindingNumber(const TriangleMesh& mesh, std::vector<Triangle> faces);

  struct Position {
    int winding = 0;             // signed count of the surface's crossings of a ray from the point
    bool touched = false;        // the point lies on a face
    std::int64_t faces_met = 0;  // whose boxes the ray meets
  };
  // Complexity: O(log n) for n faces, and the faces that the ray meets.
  Position about(const Vec3& point) const;

 private:
  const TriangleMesh* mesh_;
  std::vector<Triangle> faces_;
  AabbTree tree_;
};

}  // namespace buoyancy
