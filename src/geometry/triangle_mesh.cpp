#include "geometry/triangle_mesh.h"

#include <limits>

namespace buoyancy {

BoundingBox bounding_box(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  BoundingBox box{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t i : triangle) {
      const Vec3 vertex_B = mesh.vertex(i);
      box.min_B = box.min_B.cwiseMin(vertex_B);
      box.max_B = box.max_B.cwiseMax(vertex_B);
    }
  }
  return box;
}

}  // namespace buoyancy
