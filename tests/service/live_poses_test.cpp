// Live bot_core poses over UDP: buoyancyd receives them and publishes wrenches or forces and torques.
#include <csignal>

#include <bot_core/rigid_transform_t.hpp>
#include <bot_core/six_axis_force_torque_t.hpp>
#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/running_service.h"
#include "tests/support/contains.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

// [N], for the box of kBoxScene, which is 4 m high and centred on its origin.
double force_at(double height) {
  return kDensity * kGravity * 6.0 * (2.0 - height);
}

RawBytes pose_at(double height, std::int64_t utime) {
  return encoded_by_lcm(upright_pose(height, utime));
}

bot_core::six_axis_force_torque_t receive_force_torque(RawLcmSocket& socket, const std::string& channel) {
  const std::optional<RawBytes> bytes = socket.receive(channel, kWaitTimeout);
  if (!bytes) throw std::runtime_error("no response on " + channel);
  bot_core::six_axis_force_torque_t message{};
  const auto size = static_cast<int>(bytes->size());
  EXPECT_EQ(message.decode(bytes->data(), 0, size), size);
  return message;
}

class LivePoses : public testing::TestWithParam<const char*> {};

TEST_P(LivePoses, PublishesWrenchesAndForceTorqueBesideRequests) {
  RunningService service({"--mode", GetParam(), "--pose", "HULL=1", "--pose", "HULL_ESTIMATE=2",
                          "--force-torque", "BUOYANCY_OF_2=2"},
                         kHydrostaticBoxScene);
  RawLcmSocket socket;
  for (std::int64_t i = 0; i < 20; ++i) {
    const double height = 0.1 * static_cast<double>(i) - 1.0;
    socket.send("HULL", pose_at(height, 100 + i));
    const WrenchResponse response = receive(socket);
    EXPECT_EQ(response.id.utime, 100 + i);
    EXPECT_EQ(response.id.seq, i);
    ASSERT_EQ(response.bodies.size(), 1U);
    EXPECT_EQ(response.bodies[0].body_id, 1);
    EXPECT_NEAR(response.bodies[0].force[2], force_at(height), 1e-6);

    socket.send("HULL_ESTIMATE", pose_at(0.5 * height, 200 + i));
    const auto message = receive_force_torque(socket, "BUOYANCY_OF_2");
    EXPECT_EQ(message.utime, 200 + i);
    EXPECT_NEAR(message.force[2], force_at(0.5 * height), 1e-6);

    send_request(socket, one_body(1, i, height));
    EXPECT_EQ(receive(socket).id.session_id, 1);
  }
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.computed == 60 && status.counters.sessions == 3 &&
           status.counters.hydrostatics == 20;
  }));
}

TEST_P(LivePoses, CountsInvalidPosesByCause) {
  RunningService service({"--mode", GetParam(), "--pose", "HULL=1"});
  RawLcmSocket socket;
  RawBytes too_long = pose_at(0.0, 1);
  too_long.push_back(0);
  RawBytes other_type = pose_at(0.0, 1);
  ++other_type[0];
  for (const RawBytes& invalid : {RawBytes{1, 2, 3}, too_long, other_type}) socket.send("HULL", invalid);
  socket.send("HULL", pose_at(0.0, 2));
  EXPECT_EQ(receive(socket).id.utime, 2);
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    const ServiceCounters& counters = status.counters;
    return counters.requests == 4 && counters.computed == 1 && counters.rejected_truncated == 1 &&
           counters.rejected_length == 1 && counters.rejected_fingerprint == 1;
  }));
}

TEST_P(LivePoses, GetDragOnlyWithVelocities) {
  RunningService service(
      {"--mode", GetParam(), "--pose", "HULL=1", "--pose", "FRAME=1", "--velocity-frame", "body"},
      kLoadsBoxScene);
  RawLcmSocket socket;
  bot_core::pose_t pose = upright_pose(0.5, 3);
  pose.orientation[0] = pose.orientation[3] = std::sqrt(0.5);  // the body's x is the world's y
  pose.vel[0] = 1.25;
  socket.send("HULL", encoded_by_lcm(pose));
  const BodyWrench moving = receive(socket).bodies.at(0);
  EXPECT_EQ(moving.status, BodyStatus::kOk);
  const double s = 1.5 / 4.0;
  EXPECT_NEAR(moving.force[0], s * (60.0 + 22.0 * 0.5) * 0.5, 1e-9) << "the current along the body's -y";
  EXPECT_NEAR(moving.force[1], -s * (20.0 + 18.0 * 1.0) * 1.0, 1e-9) << "1 m/s faster than the current";

  bot_core::rigid_transform_t transform{};
  transform.utime = 4;
  transform.trans[2] = 0.5;
  transform.quat[0] = 1.0;
  socket.send("FRAME", encoded_by_lcm(transform));
  const BodyWrench unknown = receive(socket).bodies.at(0);
  EXPECT_EQ(unknown.status, BodyStatus::kNonFiniteTwist);
  EXPECT_EQ(unknown.force, (std::array<double, 3>{}));
  EXPECT_EQ(unknown.submerged_volume, 0.0);
  const auto loads = socket.receive("BUOYANCY_LOADS", kWaitTimeout);
  ASSERT_TRUE(loads);
  EXPECT_EQ(decoded<BodiesLoads>(*loads).bodies.at(0).status, BodyStatus::kNonFiniteTwist);
  EXPECT_TRUE(service.child().wait_for_text(
      "poses without velocities on FRAME, whose body 'hull' has drag or added mass: 1; such a body needs its "
      "velocities",
      kWaitTimeout))
      << service.log();
  EXPECT_FALSE(contains(service.log(), "on HULL, whose body"));
}

TEST_P(LivePoses, LackVelocitiesAfterAReloadThatAddsDrag) {
  RunningService service({"--mode", GetParam(), "--pose", "HULL=1"}, kBoxScene);
  RawLcmSocket socket;
  socket.send("HULL", pose_at(0.5, 1));
  EXPECT_EQ(receive(socket).bodies.at(0).status, BodyStatus::kOk);
  // A status reports the poses since the last one, by the scene of its moment.
  ASSERT_TRUE(
      wait_for_status(socket, [](const ServiceStatus& status) { return status.counters.computed == 1; }));
  service.write("scene.toml", kLoadsBoxScene);
  service.child().send_signal(SIGHUP);
  ASSERT_TRUE(service.child().wait_for_text("reloaded:", kWaitTimeout)) << service.log();
  EXPECT_FALSE(contains(service.log(), "poses without velocities")) << "not needed until then";
  socket.send("HULL", pose_at(0.5, 2));
  EXPECT_EQ(receive(socket).bodies.at(0).status, BodyStatus::kNonFiniteTwist) << "their frame is unknown";
  EXPECT_TRUE(service.child().wait_for_text("--velocity-frame", kWaitTimeout)) << service.log();
}

INSTANTIATE_TEST_SUITE_P(Modes, LivePoses, testing::Values("lockstep", "latest"),
                         [](const auto& mode) { return std::string(mode.param); });

}  // namespace
}  // namespace buoyancy
