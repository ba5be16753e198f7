#include "scene/floating_pose.h"

#include "flotation/balance.h"

namespace buoyancy {

std::optional<FloatingPose> find_floating_pose(const FloatingBody& body, const Eigen::Quaterniond& q_WB,
                                               const Water& water) {
  const Vec3 up_B = q_WB.conjugate() * water.up_W;
  const std::optional<BalancedAttitude> balanced = Balance(body, water).at(up_B);
  if (!balanced) return std::nullopt;
  const double height = balanced->height - up_B.dot(body.center_B());  // [m], of B's origin over the water
  const Pose pose{water.up_W * (water.level + height), q_WB};
  const std::optional<FloatingState> state = floating_state(body, pose, water);
  if (!state) return std::nullopt;
  return FloatingPose{pose, -balanced->height - lowest_along(body, up_B), *state};
}

}  // namespace buoyancy
