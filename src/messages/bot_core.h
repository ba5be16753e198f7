// Messages of package bot_core, which many robots' logs hold: poses of one body on a channel of its own, and
// the force and torque that somebody who reads such logs expects back. An LCM type is known by its
// fingerprint, which follows from its fields' names and types; the package's name has no part in it.
//
//   pose_t                   int64 utime; double pos[3], vel[3], orientation[4], rotation_rate[3], accel[3]
//   rigid_transform_t        int64 utime; double trans[3], quat[4]
//   six_axis_force_torque_t  int64 utime; double force[3], moment[3]
//
// Quaternions are (w, x, y, z). In which frame vel and rotation_rate are, the type does not say: some
// projects mean the world's, others the body's.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

#include "messages/wire.h"

namespace buoyancy {

struct BotPose {
  std::int64_t utime = 0;                   // us
  std::array<double, 3> position{};         // m
  std::array<double, 4> quaternion_wxyz{};  // body to world
  // m/s and rad/s, in a frame that its sender knows; NaN of a rigid_transform_t, which has none.
  std::array<double, 3> velocity{};
  std::array<double, 3> rotation_rate{};
};

struct BotForceTorque {
  std::int64_t utime = 0;          // us
  std::array<double, 3> force{};   // N
  std::array<double, 3> torque{};  // N m
};

// A pose_t or a rigid_transform_t, of exactly its length. Values are not judged. Causes: kTruncated,
// kFingerprint, kLength. O(1).
tl::expected<BotPose, DecodeError> decode_bot_pose(Bytes bytes);

// A six_axis_force_torque_t of exactly its length; else as decode_bot_pose().
tl::expected<BotForceTorque, DecodeError> decode_six_axis_force_torque(Bytes bytes);

// Replaces bytes by a six_axis_force_torque_t. utime: us; force: N; torque: N m.
void encode_six_axis_force_torque(std::int64_t utime, const std::array<double, 3>& force,
                                  const std::array<double, 3>& torque, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
