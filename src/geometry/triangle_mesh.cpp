#include "geometry/triangle_mesh.h"

#include <limits>
#include <vector>

#include "geometry/parallel_tasks.h"

namespace buoyancy {

BoundingBox bounding_box(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const BoundingBox empty{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  const std::size_t count = mesh.triangles.size();
  std::vector<BoundingBox> boxes((count + kParallelRange - 1) / kParallelRange, empty);
  run_parallel_ranges(count, [&](std::size_t begin, std::size_t end) {
    BoundingBox box = empty;
    for (std::size_t t = begin; t < end; ++t) {
      for (const std::int32_t i : mesh.triangles[t]) {
        const Vec3 vertex_B = mesh.vertex(i);
        box.min_B = box.min_B.cwiseMin(vertex_B);
        box.max_B = box.max_B.cwiseMax(vertex_B);
      }
    }
    boxes[begin / kParallelRange] = box;
  });
  // In their order, so that of a 0 and a -0 the same one remains.
  BoundingBox all = empty;
  for (const BoundingBox& box : boxes) {
    all.min_B = all.min_B.cwiseMin(box.min_B);
    all.max_B = all.max_B.cwiseMax(box.max_B);
  }
  return all;
}

}  // namespace buoyancy
