// Sends requests over UDP with an independent client and compares the responses with closed forms.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "tests/service/raw_lcm.h"
#include "tests/service/running_service.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

constexpr double kRelative = 1e-13;

struct Expected3 {
  double force_z = 0.0;
  std::array<double, 3> torque{};
  double volume = 0.0;
  std::array<double, 3> center{};
};

// A box of 2 x 3 x 4 m rotated about the vertical by yaw, or lying on its side.
Expected3 box_in_water(const BodyState& state, double yaw, bool lying) {
  const double height = lying ? 3.0 : 4.0;
  const double area = 24.0 / height;
  const double depth = std::clamp(height / 2 - state.position[2], 0.0, height);
  Expected3 expected;
  expected.volume = area * depth;
  expected.force_z = kDensity * kGravity * expected.volume;
  if (depth > 0.0) expected.center[2] = -height / 2 + depth / 2;
  if (state.body_id == 2) {
    const double x = std::cos(yaw) * kReferenceInB[0] - std::sin(yaw) * kReferenceInB[1];
    const double y = std::sin(yaw) * kReferenceInB[0] + std::cos(yaw) * kReferenceInB[1];
    expected.torque = {-y * expected.force_z, x * expected.force_z, 0.0};
  }
  return expected;
}

struct Pose {
  BodyState state;
  double yaw = 0.0;
  bool lying = false;
};

std::vector<Pose> poses(std::size_t count) {
  std::vector<Pose> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    Pose& pose = result[i];
    const double t = static_cast<double>(i);
    pose.state.body_id = i % 3 == 1 ? 2 : 1;
    pose.lying = i % 3 == 2;
    pose.state.position = {10.0 * std::sin(t), -5.0 * std::cos(t), 2.5 * std::sin(1.7 * t)};
    if (pose.lying) {
      pose.state.quaternion_wxyz = {std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0};
    } else {
      pose.yaw = 0.3 * t;
      pose.state.quaternion_wxyz = {std::cos(pose.yaw / 2), 0.0, 0.0, std::sin(pose.yaw / 2)};
    }
  }
  return result;
}

class RoundTrip : public testing::TestWithParam<std::size_t> {};

TEST_P(RoundTrip, MatchesArchimedesPrincipleForIndependentClient) {
  const RunningService service;
  RawLcmSocket socket;
  const std::vector<Pose> requested = poses(GetParam());
  WrenchRequest states;
  states.id.utime = -123'456'789;
  states.id.session_id = 0x0123'4567'89AB'CDEF;
  states.id.seq = 42;
  for (const Pose& pose : requested) states.bodies.push_back(pose.state);
  send_request(socket, states);
  const WrenchResponse response = receive(socket);
  EXPECT_EQ(response.id.utime, states.id.utime);
  EXPECT_EQ(response.id.session_id, states.id.session_id);
  EXPECT_EQ(response.id.seq, states.id.seq);
  ASSERT_EQ(response.bodies.size(), requested.size());
  for (std::size_t i = 0; i < requested.size(); ++i) {
    const BodyWrench& wrench = response.bodies[i];
    const Expected3 expected = box_in_water(requested[i].state, requested[i].yaw, requested[i].lying);
    const double full_force = kDensity * kGravity * 24.0;
    EXPECT_EQ(wrench.body_id, requested[i].state.body_id) << i;
    EXPECT_EQ(wrench.status, BodyStatus::kOk) << i;
    EXPECT_EQ(wrench.force[0], 0.0) << i;
    EXPECT_EQ(wrench.force[1], 0.0) << i;
    EXPECT_NEAR(wrench.force[2], expected.force_z, kRelative * full_force) << i;
    EXPECT_NEAR(wrench.submerged_volume, expected.volume, kRelative * 24.0) << i;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(wrench.torque[axis], expected.torque[axis], kRelative * full_force * 4.0) << i;
      if (expected.volume > 0.01) {
        EXPECT_NEAR(wrench.center_of_buoyancy[axis], expected.center[axis], 1e-10) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, RoundTrip, testing::Values(1U, 100U, 1000U));

// The hydrostatics message is larger than the receive buffer.
TEST(HydrostaticsRoundTrip, DropsNoRequestForServicesOwnPackets) {
  const RunningService service({"-l", "udpm://239.255.76.67:7667?recv_buf_size=106496"},
                               kHydrostaticBoxScene);
  RawLcmSocket socket;
  WrenchRequest states = one_body(9, 1, 0.5);
  states.bodies[0].body_id = 2;
  states.bodies.resize(600, states.bodies[0]);
  send_request(socket, states);
  const auto hydrostatics = socket.receive("BUOYANCY_HYDROSTATICS", kWaitTimeout);
  ASSERT_TRUE(hydrostatics);
  EXPECT_GT(hydrostatics->size(), 250'000U);
  send_request(socket, one_body(9, 2, 0.5));
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& now) { return now.counters.requests == 2; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->packets_dropped, 0);
}

TEST(RoundTrip, CompletesWithoutSpinning) {
  const RunningService service({"--no-spin"});
  RawLcmSocket socket;
  for (std::int64_t seq = 1; seq <= 300; ++seq) {
    send_request(socket, one_body(3, seq, 0.001 * static_cast<double>(seq)));
    ASSERT_EQ(receive(socket).id.seq, seq);
  }
}

TEST(HydrostaticsRoundTrip, MatchesClosedFormForBox) {
  const RunningService service({}, kHydrostaticBoxScene);
  RawLcmSocket socket;
  WrenchRequest states = one_body(9, 3, 0.5);
  states.id.utime = 77;
  states.bodies.resize(3, states.bodies[0]);
  states.bodies[1].body_id = 2;
  states.bodies[2].body_id = 5;  // unknown
  send_request(socket, states);
  EXPECT_EQ(receive(socket).bodies.size(), 3U);
  const auto bytes = socket.receive("BUOYANCY_HYDROSTATICS", kWaitTimeout);
  ASSERT_TRUE(bytes);
  const BodiesHydrostatics message = decoded<BodiesHydrostatics>(*bytes);
  EXPECT_EQ(message.id.utime, 77);
  EXPECT_EQ(message.id.session_id, 9);
  EXPECT_EQ(message.id.seq, 3);
  ASSERT_EQ(message.bodies.size(), 1U) << "the scene requests none of body 1";
  const BodyHydrostatics& body = message.bodies[0];
  EXPECT_EQ(body.body_id, 2);
  EXPECT_EQ(body.status, BodyStatus::kOk);
  const double draft = 1.5;
  const double volume = 6.0 * draft;
  EXPECT_NEAR(body.submerged_volume, volume, 1e-12);
  EXPECT_NEAR(body.center_of_buoyancy[2], -2.0 + draft / 2, 1e-12);
  EXPECT_NEAR(body.wetted_area, 6.0 + 10.0 * draft, 1e-12);
  EXPECT_NEAR(body.waterplane_area, 6.0, 1e-12);
  EXPECT_NEAR(body.waterplane_centroid[2], -0.5, 1e-12);
  // The box is 2 m long along x and 3 m along y, so the stiffness about y is smaller.
  const std::array<double, 2> second_moments{3.0 * 8.0 / 12.0, 2.0 * 27.0 / 12.0};
  EXPECT_NEAR(std::abs(body.waterplane_axes[0][1]), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(body.waterplane_axes[1][0]), 1.0, 1e-12);
  for (std::size_t i = 0; i < 2; ++i) {
    const double radius = second_moments[i] / volume;
    EXPECT_NEAR(body.waterplane_second_moments[i], second_moments[i], 1e-12);
    EXPECT_NEAR(body.metacentric_radii[i], radius, 1e-12);
    EXPECT_NEAR(body.metacenters[i][2], -2.0 + draft / 2 + radius, 1e-12);
    EXPECT_NEAR(body.metacentric_heights[i], -2.0 + draft / 2 + radius, 1e-12);
    const std::size_t about = i == 0 ? 4 : 3;
    EXPECT_NEAR(body.stiffness[about][about], kDensity * kGravity * volume * body.metacentric_heights[i],
                1e-7)
        << "about the centre of mass, which is B's origin";
  }
  EXPECT_NEAR(body.stiffness[2][2], kDensity * kGravity * 6.0, 1e-7);
  EXPECT_TRUE(
      wait_for_status(socket, [](const ServiceStatus& status) { return status.counters.hydrostatics == 1; }));
}

TEST(HydrostaticsRoundTrip, IsSentAgainForRetriesAndOnlyForBodiesThatRequestIt) {
  const RunningService service({"--hydrostatics-channel", "H"}, kHydrostaticBoxScene);
  RawLcmSocket socket;
  WrenchRequest with_hydrostatics = one_body(1, 1, 0.3);
  with_hydrostatics.bodies[0].body_id = 2;
  send_request(socket, with_hydrostatics);
  const auto first = socket.receive("H", kWaitTimeout);
  ASSERT_TRUE(first);
  send_request(socket, with_hydrostatics);
  EXPECT_EQ(socket.receive("H", kWaitTimeout), first);
  send_request(socket, one_body(1, 2, 0.3));
  with_hydrostatics.id.seq = 3;
  send_request(socket, with_hydrostatics);
  const auto next = socket.receive("H", kWaitTimeout);
  ASSERT_TRUE(next);
  EXPECT_EQ(decoded<BodiesHydrostatics>(*next).id.seq, 3) << "request 2 gets none";
}

TEST(LoadsRoundTrip, MatchesClosedFormForMovingBox) {
  const RunningService service({}, kLoadsBoxScene);
  RawLcmSocket socket;
  WrenchRequest states = one_body(9, 3, 0.5);
  states.id.utime = 77;
  states.bodies[0].linear_velocity = {1.0, 0.0, 0.0};
  states.bodies.resize(2, states.bodies[0]);
  states.bodies[1].body_id = 5;  // unknown
  send_request(socket, states);
  const WrenchResponse response = receive(socket);
  const auto bytes = socket.receive("BUOYANCY_LOADS", kWaitTimeout);
  ASSERT_TRUE(bytes);
  const BodiesLoads message = decoded<BodiesLoads>(*bytes);
  EXPECT_EQ(message.id.utime, 77);
  EXPECT_EQ(message.id.session_id, 9);
  EXPECT_EQ(message.id.seq, 3);
  ASSERT_EQ(message.bodies.size(), 1U);
  const BodyLoads& body = message.bodies[0];
  EXPECT_EQ(body.body_id, 1);
  EXPECT_EQ(body.status, BodyStatus::kOk);
  const double s = 1.5 / 4.0;
  const std::array<double, 2> nu{0.5, -0.25};  // relative to the current
  EXPECT_NEAR(body.immersion, s, 1e-14);
  EXPECT_NEAR(body.buoyancy_force[2], kDensity * kGravity * 9.0, 1e-7);
  EXPECT_NEAR(body.drag_force[0], -s * (20.0 + 18.0 * 0.5) * nu[0], 1e-12);
  EXPECT_NEAR(body.drag_force[1], -s * (60.0 + 22.0 * 0.25) * nu[1], 1e-12);
  EXPECT_NEAR(body.added_mass_torque[2], -s * (126.0 - 5.0) * nu[0] * nu[1], 1e-12) << "Munk's moment";
  EXPECT_NEAR(body.added_mass[1][1], s * 126.0, 1e-12);
  EXPECT_NEAR(body.added_mass[1][5], s * 126.0 * -0.5, 1e-12) << "the centre is beside the reference point";
  EXPECT_NEAR(body.damping[0][0], s * (20.0 + 2.0 * 18.0 * 0.5), 1e-12);
  EXPECT_EQ(body.water_velocity, (std::array<double, 3>{0.5, 0.25, 0.0}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(response.bodies[0].force[axis],
                body.buoyancy_force[axis] + body.drag_force[axis] + body.added_mass_force[axis], 1e-9);
    EXPECT_NEAR(response.bodies[0].torque[axis],
                body.buoyancy_torque[axis] + body.drag_torque[axis] + body.added_mass_torque[axis], 1e-9);
  }
}

TEST(LoadsRoundTrip, IsSentAgainForRetriesAndOnlyForBodiesThatRequestIt) {
  const RunningService service({"--loads-channel", "L"},
                               kLoadsBoxScene + "[[body]]\nid = 2\nshape = { type = \"box\" }\n");
  RawLcmSocket socket;
  WrenchRequest states = one_body(1, 1, 0.3);
  send_request(socket, states);
  const auto first = socket.receive("L", kWaitTimeout);
  ASSERT_TRUE(first);
  send_request(socket, states);
  EXPECT_EQ(socket.receive("L", kWaitTimeout), first);
  WrenchRequest without = one_body(1, 2, 0.3);
  without.bodies[0].body_id = 2;
  send_request(socket, without);
  states.id.seq = 3;
  send_request(socket, states);
  const auto next = socket.receive("L", kWaitTimeout);
  ASSERT_TRUE(next);
  EXPECT_EQ(decoded<BodiesLoads>(*next).id.seq, 3) << "request 2 gets none";
}

TEST(LockstepMode, RepeatsSameBytesForRetryWithoutComputing) {
  const RunningService service;
  RawLcmSocket socket;
  send_request(socket, one_body(1, 5, 0.3));
  const auto first = receive_bytes(socket);
  ASSERT_TRUE(first);
  for (int retry = 0; retry < 3; ++retry) {
    send_request(socket, one_body(1, 5, 0.3));
    EXPECT_EQ(receive_bytes(socket), first);
  }
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    const LatencyPercentiles& latency = status.latency;
    const bool measured = 0.0 < latency.p50 && latency.p50 <= latency.p99 && latency.max < kWaitTimeout;
    return status.counters.computed == 1 && status.counters.retries == 3 && status.counters.requests == 4 &&
           measured;
  }));
}

TEST(LockstepMode, RecomputesChangedRequestWithSameSeq) {
  const RunningService service;
  RawLcmSocket socket;
  send_request(socket, one_body(1, 5, 1.0));
  EXPECT_DOUBLE_EQ(receive(socket).bodies[0].submerged_volume, 6.0);
  send_request(socket, one_body(1, 5, 0.0));
  EXPECT_DOUBLE_EQ(receive(socket).bodies[0].submerged_volume, 12.0);
  EXPECT_TRUE(wait_for_status(
      socket, [](const ServiceStatus& status) { return status.counters.conflicting_retries == 1; }));
}

TEST(LockstepMode, HandlesEveryRequestOfBurstInOrder) {
  const RunningService service;
  RawLcmSocket socket;
  for (std::int64_t seq = 0; seq < 200; ++seq)
    send_request(socket, one_body(1, seq, 0.01 * static_cast<double>(seq)));
  for (std::int64_t seq = 0; seq < 200; ++seq) ASSERT_EQ(receive(socket).id.seq, seq);
}

TEST(LockstepMode, HandlesRequestsOfRestartedClientAtOnce) {
  const RunningService service;
  RawLcmSocket socket;
  send_request(socket, one_body(1, 1'000'000, 0.0));
  EXPECT_EQ(receive(socket).id.seq, 1'000'000);
  send_request(socket, one_body(2, 0, 1.0));
  const WrenchResponse other_session = receive(socket);
  EXPECT_EQ(other_session.id.session_id, 2);
  EXPECT_DOUBLE_EQ(other_session.bodies[0].submerged_volume, 6.0);
  send_request(socket, one_body(1, 0, -1.0));
  const WrenchResponse same_session = receive(socket);
  EXPECT_EQ(same_session.id.seq, 0);
  EXPECT_DOUBLE_EQ(same_session.bodies[0].submerged_volume, 18.0);
}

TEST(LockstepMode, ReturnsSameBytesAfterKillAndRestart) {
  RawLcmSocket socket;
  std::optional<RawBytes> before;
  std::optional<ServiceStatus> status_before;
  {
    RunningService service;
    send_request(socket, one_body(1, 5, 0.3));
    before = receive_bytes(socket);
    status_before = wait_for_status(socket, [](const ServiceStatus&) { return true; });
    service.child().send_signal(SIGKILL);
    EXPECT_EQ(service.child().wait(kWaitTimeout), 128 + SIGKILL);
  }
  send_request(socket, one_body(1, 6, 0.3));  // not received: no service runs
  const RunningService service;
  send_request(socket, one_body(1, 5, 0.3));
  ASSERT_TRUE(before);
  EXPECT_EQ(receive_bytes(socket), before);
  ASSERT_TRUE(status_before);
  const std::int64_t first_instance = status_before->instance_id;
  EXPECT_TRUE(wait_for_status(socket, [first_instance](const ServiceStatus& status) {
    return status.instance_id != first_instance && status.counters.requests == 1;
  }));
}

TEST(LockstepMode, AcceptsAnyClientClock) {
  constexpr std::int64_t kHour = 3'600'000'000;  // us
  const RunningService service;
  RawLcmSocket socket;
  std::int64_t seq = 0;
  for (const std::int64_t utime : {std::int64_t{0}, kHour, -kHour, std::numeric_limits<std::int64_t>::max(),
                                   std::numeric_limits<std::int64_t>::min(), std::int64_t{1}}) {
    WrenchRequest states = one_body(1, ++seq, 0.5);
    states.id.utime = utime;
    send_request(socket, states);
    const WrenchResponse response = receive(socket);
    EXPECT_EQ(response.id.utime, utime);
    EXPECT_EQ(response.id.seq, seq);
    EXPECT_NEAR(response.bodies[0].force[2], 90'000.0, 1e-6) << utime;
  }
  EXPECT_TRUE(wait_for_status(socket, [seq](const ServiceStatus& status) {
    return status.counters.computed == seq && status.counters.stale == 0;
  }));
}

TEST(LockstepMode, ReturnsStatusAndZerosForEachInvalidBody) {
  const RunningService service;
  RawLcmSocket socket;
  WrenchRequest states = one_body(1, 1, 0.0);
  states.bodies.resize(5, states.bodies[0]);
  states.bodies[1].body_id = 77;
  states.bodies[2].position[1] = NAN;
  states.bodies[3].quaternion_wxyz = {1.1, 0.0, 0.0, 0.0};
  states.bodies[4].quaternion_wxyz = {1.0005, 0.0, 0.0, 0.0};
  send_request(socket, states);
  const WrenchResponse response = receive(socket);
  ASSERT_EQ(response.bodies.size(), 5U);
  using enum BodyStatus;
  const std::array<BodyStatus, 5> statuses{kOk, kUnknownBody, kNonFinitePose, kBadQuaternion, kOk};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(response.bodies[i].status, statuses[i]) << i;
    EXPECT_NEAR(response.bodies[i].force[2], statuses[i] == kOk ? 120'000.0 : 0.0, 1e-6) << i;
  }
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    return status.counters.bodies[0] == 2 && status.counters.bodies[1] == 1 &&
           status.counters.bodies[2] == 1 && status.counters.bodies[3] == 1 &&
           status.counters.quaternions_normalised == 1;
  }));
}

TEST(LatestMode, HandlesNewestPendingRequestOfEachSession) {
  RunningService service({"--mode", "latest"});
  RawLcmSocket socket;
  constexpr std::int64_t kRequests = 50;
  service.child().send_signal(SIGSTOP);
  for (std::int64_t seq = 1; seq <= kRequests; ++seq) {
    for (const std::int64_t session : {7, 8}) send_request(socket, one_body(session, seq, 0.1));
  }
  service.child().send_signal(SIGCONT);
  std::map<std::int64_t, std::int64_t> newest;
  while (newest[7] < kRequests || newest[8] < kRequests) {
    const WrenchResponse response = receive(socket);
    EXPECT_GT(response.id.seq, newest[response.id.session_id]) << "never an older one";
    newest[response.id.session_id] = response.id.seq;
  }
  EXPECT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    const ServiceCounters& counters = status.counters;
    return counters.requests == 2 * kRequests && counters.computed + counters.superseded == 2 * kRequests;
  }));
}

TEST(LatestMode, DropsStaleRequestsAndAcceptsRestartedClients) {
  RunningService service({"--mode", "latest"});
  RawLcmSocket socket;
  // It receives all three at once: after a pause, 99 would be that of a restarted client.
  service.stop();
  send_request(socket, one_body(1, 100, 0.0));
  send_request(socket, one_body(1, 99, 0.0));
  send_request(socket, one_body(2, 1, 0.0));
  service.child().send_signal(SIGCONT);
  EXPECT_EQ(receive(socket).id.seq, 100);
  const WrenchResponse next = receive(socket);
  EXPECT_EQ(next.id.session_id, 2) << "99 is stale";
  for (const std::int64_t seq : {0, 1, 2}) {
    send_request(socket, one_body(1, seq, 0.0));
    EXPECT_EQ(receive(socket).id.seq, seq);
  }
  EXPECT_TRUE(
      wait_for_status(socket, [](const ServiceStatus& status) { return status.counters.stale >= 1; }));
}

TEST(Buoyancyd, UsesChannelNamesLiterally) {
  const RunningService service(
      {"--states-channel", "a.b", "--wrenches-channel", "w(1|2)", "--status-channel", "s"});
  RawLcmSocket socket;
  socket.send("BUOYANCY_STATES", encoded(one_body(1, 1, 0.0)));
  socket.send("axb", encoded(one_body(1, 2, 0.0)));
  socket.send("a.b", encoded(one_body(1, 3, 0.0)));
  const auto bytes = socket.receive("w(1|2)", kWaitTimeout);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(decoded<WrenchResponse>(*bytes).id.seq, 3);
  EXPECT_TRUE(socket.receive("s", kWaitTimeout));
}

}  // namespace
}  // namespace buoyancy
