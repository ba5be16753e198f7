#include "view/report/attitude.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/rotation_between.h"

namespace buoyancy::view {
namespace {

Eigen::Quaterniond upright(MeshUp mesh_up) {
  constexpr double kRightAngle = std::numbers::pi / 2.0;
  switch (mesh_up) {
    case MeshUp::kY:
      return Eigen::Quaterniond(Eigen::AngleAxisd(kRightAngle, Vec3::UnitX()));
    case MeshUp::kX:
      return Eigen::Quaterniond(Eigen::AngleAxisd(-kRightAngle, Vec3::UnitY()));
    case MeshUp::kZ:
      break;
  }
  return Eigen::Quaterniond::Identity();
}

}  // namespace

Attitude attitude(const Pose& pose, const Water& water, MeshUp mesh_up) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const Eigen::Quaterniond q =
      rotation_between(water.up_W, Vec3::UnitZ()) * pose.q_WB.normalized() * upright(mesh_up).conjugate();
  return {.heave = water.up_W.dot(pose.p_WB) - water.level,
          .roll = kDegrees * std::atan2(2.0 * (q.w() * q.x() + q.y() * q.z()),
                                        1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y())),
          .pitch = kDegrees * std::asin(std::clamp(2.0 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0))};
}

}  // namespace buoyancy::view
