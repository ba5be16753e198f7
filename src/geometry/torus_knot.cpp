#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

// The curve winds on a torus of radii 2/3 and 1/3 of the knot's radius.
struct CurvePoint {
  Vec3 place_B;
  Vec3 tangent_B;  // unit
  Vec3
      normal_B;  // unit, across the curve: the torus's own outward normal, so that the frame closes on itself
};

CurvePoint curve_point(const TorusKnotShape& knot, double t) {
  const double around_ring = knot.p * t;
  const double around_axis = knot.q * t;
  const Vec3 outward_B(std::cos(around_axis), std::sin(around_axis), 0.0);
  const Vec3 onward_B(-outward_B.y(), outward_B.x(), 0.0);
  const double third = knot.radius / 3.0;
  const double distance = third * (2.0 + std::cos(around_ring));

  CurvePoint point;
  point.place_B = distance * outward_B + third * std::sin(around_ring) * Vec3::UnitZ();
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
      mesh.add_vertex(point.place_B +
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

double largest_tube(const TorusKnotShape& knot) {
  const std::int32_t samples = 96 * std::max(knot.p, knot.q);
  std::vector<CurvePoint> points;
  points.reserve(static_cast<std::size_t>(samples));
  for (std::int32_t i = 0; i < samples; ++i) {
    points.push_back(curve_point(knot, 2.0 * std::numbers::pi * i / samples));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const CurvePoint& at : points) {
    for (const CurvePoint& through : points) {
      const Vec3 chord_B = through.place_B - at.place_B;
      const double across = chord_B.cross(at.tangent_B).norm();
      if (across > 0.0) least = std::min(least, chord_B.squaredNorm() / (2.0 * across));
    }
  }
  return least;
}

}  // namespace buoyancy
