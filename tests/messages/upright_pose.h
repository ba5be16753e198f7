// bot_core poses for tests.
#pragma once

#include <cstdint>

#include <bot_core/pose_t.hpp>

namespace buoyancy {

// An upright body at rest, at this height over the origin [m].
inline bot_core::pose_t upright_pose(double height, std::int64_t utime) {
  bot_core::pose_t pose{};
  pose.utime = utime;
  pose.pos[2] = height;
  pose.orientation[0] = 1.0;
  return pose;
}

}  // namespace buoyancy
