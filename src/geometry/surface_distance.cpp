#include "geometry/surface_distance.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

double squared_distance(const Vec3& point, const BoundingBox& box) {
  return (point - point.cwiseMax(box.min_B).cwiseMin(box.max_B)).squaredNorm();
}

double squared_distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::clamp((point - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (point - a - t * ab).squaredNorm();
}

double squared_distance_to_triangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vec3& from, const Vec3& to) {
    return (to - from).cross(point - from).dot(normal) >= 0.0;
  };
  const double area = normal.squaredNorm();
  if (area > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    const double height = (point - a).dot(normal);
    return height * height / area;
  }
  return std::min({squared_distance_to_segment(point, a, b), squared_distance_to_segment(point, b, c),
                   squared_distance_to_segment(point, c, a)});
}

}  // namespace

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh)
    : mesh_(mesh), tree_(boxes_of_faces(mesh, mesh.triangles)) {}

double SurfaceDistance::to(const Vec3& point) {
  const auto distance_to = [&](std::int32_t i) {
    const Triangle& t = mesh_.triangles[static_cast<std::size_t>(i)];
    return squared_distance_to_triangle(point, mesh_.vertex(t[0]), mesh_.vertex(t[1]), mesh_.vertex(t[2]));
  };
  double nearest = distance_to(last_);
  tree_.for_each([&](const BoundingBox& box) { return squared_distance(point, box) < nearest; },
                 [&](std::int32_t i) {
                   const double distance = distance_to(i);
                   if (distance >= nearest) return;
                   nearest = distance;
                   last_ = i;
                 });
  return std::sqrt(nearest);
}

double largest_distance(const TriangleMesh& from, const TriangleMesh& to) {
  SurfaceDistance distance(to);
  double largest = 0.0;
  for (const Triangle& t : from.triangles) {
    const Vec3 a = from.vertex(t[0]);
    const Vec3 b = from.vertex(t[1]);
    const Vec3 c = from.vertex(t[2]);
    for (const Vec3& point : {a, b, c, Vec3((a + b + c) / 3.0)})
      largest = std::max(largest, distance.to(point));
  }
  return largest;
}

}  // namespace buoyancy
