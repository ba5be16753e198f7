#include "geometry/mass_properties.h"

#include <Eigen/Geometry>

#include "geometry/pairwise_total.h"

namespace buoyancy {
namespace {

// Integrals of 1, y and y y^T over the solid, y measured from the centre of the bounding box.
struct SolidMoments {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  SolidMoments& operator+=(const SolidMoments& other) {
    volume += other.volume;
    first += other.first;
    second += other.second;
    return *this;
  }
};

// Returns the signed integrals over the tetrahedron between the origin and the triangle abc. Their sum over a
// closed surface is the integral over the enclosed solid.
SolidMoments moments_of_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 sum = a + b + c;
  SolidMoments moments;
  moments.volume = a.dot(b.cross(c)) / 6.0;
  moments.first = moments.volume / 4.0 * sum;
  moments.second = moments.volume / 20.0 *
                   (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  return moments;
}

}  // namespace

MassProperties mass_properties(const TriangleMesh& mesh) {
  MassProperties properties;
  if (mesh.triangles.empty()) return properties;
  const Vec3 center_B = bounding_box(mesh).center();
  const auto total = pairwise_total<SolidMoments>(mesh.triangles.size(), [&](std::size_t i) {
    const Triangle& triangle = mesh.triangles[i];
    return moments_of_tetrahedron(mesh.vertex(triangle[0]) - center_B, mesh.vertex(triangle[1]) - center_B,
                                  mesh.vertex(triangle[2]) - center_B);
  });

  properties.volume = total.volume;
  properties.centroid_B = center_B;
  if (total.volume == 0.0) return properties;
  const Vec3 centroid = total.first / total.volume;
  const Mat3 central = total.second - centroid * total.first.transpose();
  properties.centroid_B += centroid;
  properties.inertia_B = central.trace() * Mat3::Identity() - central;
  return properties;
}

}  // namespace buoyancy
