#include "geometry/flatness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace buoyancy {

double distance_from_plane(const TriangleMesh& mesh, std::span<const std::int32_t> faces) {
  Vec3 origin = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  Vec3 along = Vec3::Zero();  // the longer side
  for (const std::int32_t f : faces) {
    const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
    const Vec3 a = mesh.vertex(face[0]);
    const Vec3 ab = mesh.vertex(face[1]) - a;
    const Vec3 ac = mesh.vertex(face[2]) - a;
    const Vec3 n = ab.cross(ac);
    if (n.squaredNorm() <= normal.squaredNorm()) continue;
    normal = n;
    origin = a;
    along = ab.squaredNorm() > ac.squaredNorm() ? ab : ac;
  }
  if (!(normal.squaredNorm() > 0.0)) return std::numeric_limits<double>::infinity();
  // The computed normal of a needle is a difference of products and need not be perpendicular to its sides.
  along.normalize();
  normal = (normal - normal.dot(along) * along).normalized();
  double distance = 0.0;
  for (const std::int32_t f : faces) {
    for (const std::int32_t v : mesh.triangles[static_cast<std::size_t>(f)]) {
      distance = std::max(distance, std::abs(normal.dot(mesh.vertex(v) - origin)));
    }
  }
  return distance;
}

}  // namespace buoyancy
