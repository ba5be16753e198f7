#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

// A point of the curve, which winds on a torus of radii 2/3 and 1/3 of the knot's radius.
struct CurvePoint {
  Vec3 position_B;
  Vec3 tangent_B;  // unit vector
  Vec3
      normal_B;  // unit vector normal to the curve: the torus's outward normal, so that the frame is periodic
};

CurvePoint curve_point(const TorusKnotShape& knot, double t) {
  const double around_ring = knot.p * t;
  const double around_axis = knot.q * t;
  const Vec3 outward_B(std::cos(around_axis), std::sin(around_axis), 0.0);
  const Vec3 onward_B(-outward_B.y(), outward_B.x(), 0.0);
  const double third = knot.radius / 3.0;
  const double distance = third * (2.0 + std::cos(around_ring));

  CurvePoint point;
  point.position_B = distance * outward_B + third * std::sin(around_ring) * Vec3::UnitZ();
  point.tangent_B =
      (knot.q * distance * onward_B +
       knot.p * third * (std::cos(around_ring) * Vec3::UnitZ() - std::sin(around_ring) * outward_B))
          .normalized();
  point.normal_B = std::cos(around_ring) * outward_B + std::sin(around_ring) * Vec3::UnitZ();
  return point;
}

}  // namespace

TriangleMesh generate(const TorusKnotShape& knot) {
  TriangleMesh mesh;
  for (std::int32_t i = 0; i < knot.tubular; ++i) {
    const CurvePoint point = curve_point(knot, 2.0 * std::numbers::pi * i / knot.tubular);
    const Vec3 binormal_B = point.tangent_B.cross(point.normal_B);
    for (std::int32_t j = 0; j < knot.radial; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / knot.radial;
      mesh.add_vertex(point.position_B +
                      knot.tube * (std::cos(angle) * point.normal_B + std::sin(angle) * binormal_B));
    }
  }
  for (std::int32_t i = 0; i < knot.tubular; ++i) {
    const std::int32_t here = i * knot.radial;
    const std::int32_t onward = (i + 1) % knot.tubular * knot.radial;
    for (std::int32_t j = 0; j < knot.radial; ++j) {
      const std::int32_t next = (j + 1) % knot.radial;
      mesh.triangles.push_back({here + j, here + next, onward + next});
      mesh.triangles.push_back({here + j, onward + next, onward + j});
    }
  }
  return mesh;
}

double max_tube_radius(const TorusKnotShape& knot) {
  const std::int32_t samples = 96 * std::max(knot.p, knot.q);
  std::vector<CurvePoint> points;
  points.reserve(static_cast<std::size_t>(samples));
  for (std::int32_t i = 0; i < samples; ++i) {
    points.push_back(curve_point(knot, 2.0 * std::numbers::pi * i / samples));
  }
  double min_radius = std::numeric_limits<double>::infinity();
  for (const CurvePoint& at : points) {
    for (const CurvePoint& through : points) {
      const Vec3 chord_B = through.position_B - at.position_B;
      const double across = chord_B.cross(at.tangent_B).norm();
      if (across > 0.0) min_radius = std::min(min_radius, chord_B.squaredNorm() / (2.0 * across));
    }
  }
  return min_radius;
}

}  // namespace buoyancy
