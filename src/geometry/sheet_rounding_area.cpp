#include "geometry/sheet_rounding_area.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "geometry/pairwise_sum.h"

namespace buoyancy {

double sheet_rounding_area(const TriangleMesh& mesh) {
  PairwiseSum<double> sum;
  for (const Triangle& face : mesh.triangles) {
    const Vec3 ab = mesh.vertex(face[1]) - mesh.vertex(face[0]);
    const Vec3 ac = mesh.vertex(face[2]) - mesh.vertex(face[0]);
    const double max_edge_squared = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    sum.add(std::max(0.5 * ab.cross(ac).norm(), 0.25 * max_edge_squared));
  }
  return sum.total();
}

}  // namespace buoyancy
