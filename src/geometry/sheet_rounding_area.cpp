#include "geometry/sheet_rounding_area.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "geometry/pairwise_total.h"

namespace buoyancy {

double sheet_rounding_area(const TriangleMesh& mesh) {
  return pairwise_total<double>(mesh.triangles.size(), [&](std::size_t i) {
    const Triangle& face = mesh.triangles[i];
    const Vec3 ab = mesh.vertex(face[1]) - mesh.vertex(face[0]);
    const Vec3 ac = mesh.vertex(face[2]) - mesh.vertex(face[0]);
    const double max_edge_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    return std::max(0.5 * ab.cross(ac).norm(), 0.25 * max_edge_squared);
  });
}

}  // namespace buoyancy
