#include "flotation/ship_axes.h"

#include <cmath>

#include "base/format.h"

namespace buoyancy {

Expected<ShipAxes> make_ship_axes(const Vec3& forward_B, const Vec3& up_B) {
  for (const Vec3* axis : {&forward_B, &up_B}) {
    const double norm = axis->stableNorm();
    if (std::isfinite(norm) && norm > 0.0) continue;
    return make_error({.subject = "ship axes",
                       .actual = format_vector(*axis),
                       .expected = "a direction: three finite numbers that are not all 0",
                       .cause = "",
                       .hint = "Give a direction of the body frame, such as +x"});
  }
  ShipAxes axes{forward_B.stableNormalized(), up_B.stableNormalized()};
  const double along = axes.forward_B.dot(axes.up_B);
  if (!(std::abs(along) <= 1e-6)) {
    return make_error({.subject = "ship axes",
                       .actual = "forward " + format_vector(forward_B) + " and up " + format_vector(up_B),
                       .expected = "directions at right angles",
                       .cause = "one of them points the wrong way",
                       .hint = "Name two different axes of the body frame, such as forward +x and up +z"});
  }
  axes.up_B = (axes.up_B - along * axes.forward_B).normalized();
  return axes;
}

ShipAxes axes_with_up(const Vec3& up_B) {
  return {.forward_B = up_B.x() == 0.0 ? Vec3::UnitX() : Vec3::UnitY(), .up_B = up_B};
}

Vec3 nearest_axis(const Vec3& direction) {
  int nearest = 2;
  for (const int i : {1, 0}) {
    if (std::abs(direction[i]) > std::abs(direction[nearest])) nearest = i;
  }
  return std::copysign(1.0, direction[nearest]) * Vec3::Unit(nearest);
}

Vec3 up_at(const ShipAxes& axes, const HeelTrim& angles) {
  const double cos_trim = std::cos(angles.trim);
  return std::sin(angles.trim) * axes.forward_B + cos_trim * std::sin(angles.heel) * axes.port_B() +
         cos_trim * std::cos(angles.heel) * axes.up_B;
}

HeelTrim heel_trim_of(const ShipAxes& axes, const Vec3& up_B) {
  const Vec3 k = axes.components(up_B);
  const double across = std::hypot(k.y(), k.z());
  return {across > 0.0 ? std::atan2(k.y(), k.z()) : 0.0, std::atan2(k.x(), across)};
}

Vec3 starboard_at(const ShipAxes& axes, double heel) {
  return std::sin(heel) * axes.up_B - std::cos(heel) * axes.port_B();
}

Eigen::Quaterniond attitude_at(const ShipAxes& axes, const HeelTrim& angles, const Vec3& up_W) {
  const Vec3 start = std::abs(up_W.x()) > 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  Mat3 horizon_W;  // columns: forward, port and up of an upright ship
  horizon_W.col(0) = (start - up_W.dot(start) * up_W).normalized();
  horizon_W.col(1) = up_W.cross(horizon_W.col(0));
  horizon_W.col(2) = up_W;
  Mat3 ship_B;
  ship_B << axes.forward_B, axes.port_B(), axes.up_B;
  return (Eigen::Quaterniond(horizon_W) * Eigen::AngleAxisd(-angles.trim, Vec3::UnitY()) *
          Eigen::AngleAxisd(angles.heel, Vec3::UnitX()) * Eigen::Quaterniond(ship_B).conjugate())
      .normalized();
}

}  // namespace buoyancy
