// Messages of package bot_core, which are common in robot logs: the pose of one body per channel, and the
// force and torque on it. An LCM type is identified by its fingerprint, a hash of its fields' names and
// types; the package name is not part of it.
//
//   pose_t                   int64 utime; double pos[3], vel[3], orientation[4], rotation_rate[3], accel[3]
//   rigid_transform_t        int64 utime; double trans[3], quat[4]
//   six_axis_force_torque_t  int64 utime; double force[3], moment[3]
//
// Quaternions are (w, x, y, z). The type does not define the frame of vel and rotation_rate: some projects
// use the world frame, others the body frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tl/expected.hpp>

#include "messages/wire.h"

namespace buoyancy {

inline constexpr std::uint64_t kBotPoseFingerprint = 0x2e16efb052b0105e;
inline constexpr std::uint64_t kBotRigidTransformFingerprint = 0xea9ffbf2acc5c5ae;
inline constexpr std::uint64_t kBotForceTorqueFingerprint = 0xf70790658aea38ec;

struct BotPose {
  std::int64_t utime = 0;                   // [us]
  std::array<double, 3> position{};         // [m]
  std::array<double, 4> quaternion_wxyz{};  // body to world
  // [m/s] and [rad/s], in the sender's choice of frame; NaN for a rigid_transform_t, which has no velocities.
  std::array<double, 3> velocity{};
  std::array<double, 3> rotation_rate{};
};

struct BotForceTorque {
  std::int64_t utime = 0;          // [us]
  std::array<double, 3> force{};   // [N]
  std::array<double, 3> torque{};  // [N m]
};

// Decodes a pose_t or a rigid_transform_t, which must have exactly the length of its type. Values are not
// validated. Errors: kTruncated, kFingerprint, kLength. O(1).
tl::expected<BotPose, DecodeError> decode_bot_pose(Bytes bytes);

// Decodes a six_axis_force_torque_t. Contract and errors: see decode_bot_pose().
tl::expected<BotForceTorque, DecodeError> decode_six_axis_force_torque(Bytes bytes);

// Replaces bytes by an encoded six_axis_force_torque_t. utime: [us]; force: [N]; torque: [N m].
void encode_six_axis_force_torque(std::int64_t utime, const std::array<double, 3>& force,
                                  const std::array<double, 3>& torque, std::vector<std::uint8_t>& bytes);

}  // namespace buoyancy
