#include "geometry/rotation_between.h"

#include <cmath>

namespace buoyancy {
namespace {

// Returns a unit vector perpendicular to two unit vectors that are opposite, or nearly so.
Vec3 common_perpendicular(const Vec3& from, const Vec3& to) {
  constexpr double kRoundingOfUnitVectors = 1e-14;
  const Vec3 sum = from + to;
  const Vec3 sideways = sum - sum.dot(from) * from;
  if (sideways.norm() < kRoundingOfUnitVectors) return from.cross(from.unitOrthogonal());
  return from.cross(sideways).normalized();
}

}  // namespace

Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 unit_from = from.normalized();
  const Vec3 unit_to = to.normalized();
  const double cosine = unit_to.dot(unit_from);
  Eigen::Quaterniond rotation;
  if (cosine < -1.0 + 1e-6) {  // 1 + cosine and the cross product are too small to be accurate
    rotation.w() = 0.5 * (unit_from + unit_to).norm();
    rotation.vec() = std::sqrt(1.0 - rotation.w() * rotation.w()) * common_perpendicular(unit_from, unit_to);
  } else {
    const double twice_w = std::sqrt(2.0 * (1.0 + cosine));
    rotation.w() = 0.5 * twice_w;
    rotation.vec() = unit_from.cross(unit_to) * (1.0 / twice_w);
  }
  return rotation;
}

}  // namespace buoyancy
