#include "engine/pose_request_adapter.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <bot_core/rigid_transform_t.hpp>
#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/support/allocation_count.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kFirstSession = 70;

PoseRequestAdapter two_channels(VelocityFrame frame, double lead_time = 0.0) {
  return {{.channels = {{"HULL", kBox, ""}, {"BUOY", kOffsetBox, "BUOY_FORCE"}},
           .velocity_frame = frame,
           .lead_time = lead_time},
          kFirstSession};
}

WrenchRequest decoded_request(PoseRequestAdapter& poses, std::size_t channel,
                              const std::vector<std::uint8_t>& message) {
  const auto bytes = poses.make_request(channel, message);
  if (!bytes) throw std::runtime_error(to_string(bytes.error()));
  return decoded<WrenchRequest>(*bytes);
}

TEST(PoseRequestAdapter, UsesOneSessionPerChannel) {
  PoseRequestAdapter poses = two_channels(VelocityFrame::kWorld);
  for (std::int64_t i = 0; i < 3; ++i) {
    const WrenchRequest hull = decoded_request(poses, 0, encoded_by_lcm(upright_pose(0.25, 10 + i)));
    EXPECT_EQ(hull.id.utime, 10 + i);
    EXPECT_EQ(hull.id.session_id, kFirstSession);
    EXPECT_EQ(hull.id.seq, i);
    ASSERT_EQ(hull.bodies.size(), 1U);
    EXPECT_EQ(hull.bodies[0].body_id, kBox);
    EXPECT_EQ(hull.bodies[0].position[2], 0.25);
  }
  const WrenchRequest buoy = decoded_request(poses, 1, encoded_by_lcm(upright_pose(0.0, -1)));
  EXPECT_EQ(buoy.id.session_id, kFirstSession + 1);
  EXPECT_EQ(buoy.id.seq, 0);
  EXPECT_EQ(buoy.bodies[0].body_id, kOffsetBox);
}

TEST(PoseRequestAdapter, FindsChannelOfSession) {
  const PoseRequestAdapter poses = two_channels(VelocityFrame::kWorld);
  EXPECT_EQ(poses.channel_of_session(kFirstSession), poses.channels().data());
  EXPECT_EQ(poses.channel_of_session(kFirstSession + 1), &poses.channels()[1]);
  for (const std::int64_t other :
       {kFirstSession - 1, kFirstSession + 2, std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(poses.channel_of_session(other), nullptr) << other;
  }
}

TEST(PoseRequestAdapter, RotatesBodyFrameVelocitiesToWorld) {
  bot_core::pose_t pose = upright_pose(0.0, 1);
  pose.orientation[0] = pose.orientation[3] = std::sqrt(0.5);  // a quarter turn about z: x becomes y
  pose.vel[0] = 2.0;
  pose.rotation_rate[0] = 3.0;
  PoseRequestAdapter world_adapter = two_channels(VelocityFrame::kWorld, 0.5);
  const WrenchRequest world = decoded_request(world_adapter, 0, encoded_by_lcm(pose));
  EXPECT_EQ(world.lead_time, 0.5);
  EXPECT_EQ(world.bodies[0].linear_velocity, (std::array<double, 3>{2.0, 0.0, 0.0}));
  PoseRequestAdapter body_adapter = two_channels(VelocityFrame::kBody, 0.5);
  const WrenchRequest body = decoded_request(body_adapter, 0, encoded_by_lcm(pose));
  EXPECT_NEAR(body.bodies[0].linear_velocity[0], 0.0, 1e-15);
  EXPECT_NEAR(body.bodies[0].linear_velocity[1], 2.0, 1e-15);
  EXPECT_NEAR(body.bodies[0].angular_velocity[1], 3.0, 1e-15);
}

TEST(PoseRequestAdapter, KeepsVelocitiesOfUnknownFrame) {
  bot_core::pose_t pose = upright_pose(0.0, 9);
  pose.orientation[0] = pose.orientation[3] = std::sqrt(0.5);
  pose.vel[0] = 2.0;
  const auto stamped = decode_pose({.channels = {{"HULL", kBox, ""}}}, 0, encoded_by_lcm(pose));
  ASSERT_TRUE(stamped);
  EXPECT_EQ(stamped->utime, 9);
  EXPECT_EQ(stamped->state.body_id, kBox);
  EXPECT_EQ(stamped->state.linear_velocity, (std::array<double, 3>{2.0, 0.0, 0.0}));
}

TEST(PoseRequestAdapter, MakesNoRequestWithVelocitiesOfUnknownFrame) {
  bot_core::pose_t pose = upright_pose(0.0, 9);
  pose.vel[0] = 2.0;
  PoseRequestAdapter unknown({.channels = {{"HULL", kBox, ""}}}, kFirstSession);
  const WrenchRequest without = decoded_request(unknown, 0, encoded_by_lcm(pose));
  for (const double value : without.bodies[0].linear_velocity) EXPECT_TRUE(std::isnan(value));
  for (const double value : without.bodies[0].angular_velocity) EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(unknown.without_velocities(0), 1);

  bot_core::rigid_transform_t transform{};
  transform.quat[0] = 1.0;
  PoseRequestAdapter poses = two_channels(VelocityFrame::kWorld);
  EXPECT_EQ(decoded_request(poses, 0, encoded_by_lcm(pose)).bodies[0].linear_velocity[0], 2.0);
  const WrenchRequest of_transform = decoded_request(poses, 1, encoded_by_lcm(transform));
  EXPECT_TRUE(std::isnan(of_transform.bodies[0].angular_velocity[2]));
  EXPECT_EQ(poses.without_velocities(0), 0);
  EXPECT_EQ(poses.without_velocities(1), 1);
}

TEST(PoseRequestAdapter, CountsRequestsOfEachChannel) {
  PoseRequestAdapter poses = two_channels(VelocityFrame::kBody, 0.0);
  const std::vector<std::uint8_t> pose = encoded_by_lcm(upright_pose(0.0, 1));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(poses.make_request(1, pose));
  EXPECT_FALSE(poses.make_request(1, std::vector<std::uint8_t>{1}));
  EXPECT_EQ(poses.next_seq(0), 0);
  EXPECT_EQ(poses.next_seq(1), 3);
  EXPECT_EQ(poses.session_of(1), poses.session_of(0) + 1);
  EXPECT_EQ(poses.channel_of_session(poses.session_of(1)), &poses.channels()[1]);
}

TEST(PoseRequestAdapter, DoesNotAllocateAfterWarmUp) {
  const Scene scene = box_scene();
  RequestHandler handler(scene, {.threads = 1});
  PoseRequestAdapter poses = two_channels(VelocityFrame::kBody, 0.01);
  WrenchResponse decoded;
  std::vector<std::uint8_t> bytes;
  const auto allocations_at = [&](double height) {
    const std::vector<std::uint8_t> pose = encoded_by_lcm(upright_pose(height, 1));
    const AllocationCount allocations;
    const auto request = poses.make_request(1, pose);
    encode_force_torque(handler.handle(*request), decoded, bytes);
    return allocations.count();
  };
  for (const double height : {0.1, -3.0, 3.0}) allocations_at(height);
  for (const double height : {0.2, -4.0, 4.0}) EXPECT_EQ(allocations_at(height), 0) << height;
}

}  // namespace
}  // namespace buoyancy
