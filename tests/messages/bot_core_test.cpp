#include "messages/bot_core.h"

#include <cmath>

#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/six_axis_force_torque_t.hpp>
#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"

namespace buoyancy {
namespace {

using Three = std::array<double, 3>;
using Four = std::array<double, 4>;

bot_core::pose_t pose() {
  bot_core::pose_t pose{};
  pose.utime = 1'234'567'890'123;
  for (int i = 0; i < 3; ++i) {
    pose.pos[i] = 1.0 + i;
    pose.vel[i] = 10.0 + i;
    pose.rotation_rate[i] = 20.0 + i;
    pose.accel[i] = 30.0 + i;
  }
  for (int i = 0; i < 4; ++i) pose.orientation[i] = 40.0 + i;
  return pose;
}

TEST(BotCore, DecodesPoseOfGeneratedEncoder) {
  const auto decoded = decode_bot_pose(encoded_by_lcm(pose()));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->utime, 1'234'567'890'123);
  EXPECT_EQ(decoded->position, (Three{1, 2, 3}));
  EXPECT_EQ(decoded->quaternion_wxyz, (Four{40, 41, 42, 43}));
  EXPECT_EQ(decoded->velocity, (Three{10, 11, 12}));
  EXPECT_EQ(decoded->rotation_rate, (Three{20, 21, 22}));
}

TEST(BotCore, DecodesRigidTransformWithNanVelocities) {
  bot_core::rigid_transform_t transform{};
  transform.utime = -5;
  for (int i = 0; i < 3; ++i) transform.trans[i] = 1.0 + i;
  for (int i = 0; i < 4; ++i) transform.quat[i] = 40.0 + i;
  const auto decoded = decode_bot_pose(encoded_by_lcm(transform));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->utime, -5);
  EXPECT_EQ(decoded->position, (Three{1, 2, 3}));
  EXPECT_EQ(decoded->quaternion_wxyz, (Four{40, 41, 42, 43}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(std::isnan(decoded->velocity.at(static_cast<std::size_t>(i))));
    EXPECT_TRUE(std::isnan(decoded->rotation_rate.at(static_cast<std::size_t>(i))));
  }
}

TEST(BotCore, EncodesForceTorqueForGeneratedDecoder) {
  std::vector<std::uint8_t> bytes{9, 9, 9};
  encode_six_axis_force_torque(77, {1, 2, 3}, {4, 5, 6}, bytes);
  bot_core::six_axis_force_torque_t message{};
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), static_cast<int>(bytes.size()));
  EXPECT_EQ(message.utime, 77);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(message.force[i], 1.0 + i);
    EXPECT_EQ(message.moment[i], 4.0 + i);
  }
  const auto decoded = decode_six_axis_force_torque(bytes);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->utime, 77);
  EXPECT_EQ(decoded->force, (Three{1, 2, 3}));
  EXPECT_EQ(decoded->torque, (Three{4, 5, 6}));
}

// message: one that `decode` accepts.
template <typename Decode>
void expect_exact_length_required(const Decode& decode, const std::vector<std::uint8_t>& message) {
  ASSERT_TRUE(decode(message));
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_EQ(decode(Bytes(message).first(size)).error(), DecodeError::kTruncated) << size;
  }
  std::vector<std::uint8_t> longer = message;
  longer.push_back(0);
  EXPECT_EQ(decode(longer).error(), DecodeError::kLength);
  std::vector<std::uint8_t> foreign = message;
  ++foreign[3];
  EXPECT_EQ(decode(foreign).error(), DecodeError::kFingerprint);
}

TEST(BotCore, RejectsOtherLengthsAndFingerprints) {
  const std::vector<std::uint8_t> force_torque = encoded_by_lcm(bot_core::six_axis_force_torque_t{});
  expect_exact_length_required(decode_bot_pose, encoded_by_lcm(pose()));
  expect_exact_length_required(decode_bot_pose, encoded_by_lcm(bot_core::rigid_transform_t{}));
  expect_exact_length_required(decode_six_axis_force_torque, force_torque);
  EXPECT_EQ(decode_bot_pose(force_torque).error(), DecodeError::kFingerprint);
  EXPECT_EQ(decode_six_axis_force_torque(encoded_by_lcm(pose())).error(), DecodeError::kFingerprint);
}

}  // namespace
}  // namespace buoyancy
