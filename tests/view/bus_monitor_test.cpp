#include "view/live/bus_monitor.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/box_scene.h"
#include "tests/engine/malformed_messages.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "view/live/snapshot_json.h"

namespace buoyancy::view {
namespace {

using nlohmann::json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::uint8_t> response_bytes(const RequestId& id, std::vector<BodyWrench> bodies) {
  return encoded(WrenchResponse{.id = id, .bodies = std::move(bodies)});
}

std::vector<std::uint8_t> status_bytes(std::int64_t instance_id, const std::string& scene = "scene.toml") {
  ServiceStatus status;
  status.instance_id = instance_id;
  status.version = "0.1.0";
  status.scene = scene;
  return encoded(status);
}

BodyWrench vertical_force(std::int32_t id, double force) {
  BodyWrench wrench;
  wrench.body_id = id;
  wrench.force = {0.0, 0.0, force};
  return wrench;
}

class BusMonitorTest : public testing::Test {
 protected:
  explicit BusMonitorTest(PoseChannels poses = {}) : monitor_(scene_, 0.0, std::move(poses)) {}
  ArrivalTime at(double now) { return {static_cast<std::int64_t>(1e6 * now), now}; }
  json snapshot(double now) { return parse_json(snapshot_json(monitor_, 1, 0.0, now, now)); }

  const Scene scene_ = box_scene();
  BusMonitor monitor_;
};

TEST_F(BusMonitorTest, ShowsLatestPoseAndWrenchOfEachBody) {
  EXPECT_TRUE(snapshot(0.0)["bodies"].empty()) << "no request yet";
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, 2.0), upright(kFastBox, 3.0)}), at(0.1));
  EXPECT_TRUE(snapshot(0.1)["bodies"][0]["f"].is_null()) << "no response yet";
  monitor_.on_response(response_bytes({0, 1, 1}, {vertical_force(kBox, 5.0), vertical_force(kFastBox, 6.0)}),
                       at(0.1));
  monitor_.on_request(request_bytes({0, 1, 2}, {upright(kBox, 1.5)}), at(0.2));
  monitor_.on_response(response_bytes({0, 1, 2}, {vertical_force(kBox, 7.0)}), at(0.2));
  const json bodies = snapshot(0.5)["bodies"];
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0]["id"], kBox);
  EXPECT_EQ(bodies[0]["p"], json({3.0, -2.0, 1.5}));
  EXPECT_EQ(bodies[0]["q"], json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(bodies[0]["f"], json({0.0, 0.0, 7.0}));
  EXPECT_EQ(bodies[0]["status"], 0);
  EXPECT_NEAR(bodies[0]["age"].get<double>(), 0.3, 1e-6);
  EXPECT_EQ(bodies[1]["id"], kFastBox);
  EXPECT_EQ(bodies[1]["f"], json({0.0, 0.0, 6.0}));
}

TEST_F(BusMonitorTest, KeepsLastValidPoseAndShowsStatus) {
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, 2.0)}), at(0.1));
  BodyState bad = upright(kBox, 1.0);
  bad.position[0] = kNan;
  monitor_.on_request(request_bytes({0, 1, 2}, {bad}), at(0.2));
  bad = upright(kBox, 1.0);
  bad.quaternion_wxyz[0] = 1.1;
  monitor_.on_request(request_bytes({0, 1, 3}, {bad}), at(0.3));
  BodyWrench rejected;
  rejected.body_id = kBox;
  rejected.status = BodyStatus::kBadQuaternion;
  monitor_.on_response(response_bytes({0, 1, 3}, {rejected}), at(0.3));
  const json body = snapshot(0.3)["bodies"][0];
  EXPECT_EQ(body["p"], json({3.0, -2.0, 2.0}));
  EXPECT_EQ(body["status"], 3);
}

TEST_F(BusMonitorTest, HidesOverdueWrench) {
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, 2.0)}), at(0.1));
  monitor_.on_response(response_bytes({0, 1, 1}, {vertical_force(kBox, 5.0)}), at(0.1));
  EXPECT_FALSE(snapshot(100.0)["bodies"][0]["f"].is_null()) << "no request since";
  for (const double now : {0.5, 1.05}) {
    monitor_.on_request(request_bytes({0, 1, 2}, {upright(kBox, 1.0)}), at(now));
    EXPECT_EQ(snapshot(now)["bodies"][0]["status"], 0) << "the response is not overdue yet";
  }
  monitor_.on_request(request_bytes({0, 1, 3}, {upright(kBox, 0.5)}), at(1.2));
  for (const char* unknown : {"status", "f", "t", "b", "volume"}) {
    EXPECT_TRUE(snapshot(1.2)["bodies"][0][unknown].is_null()) << unknown;
  }
  monitor_.on_response(response_bytes({0, 1, 3}, {vertical_force(kBox, 6.0)}), at(1.3));
  EXPECT_EQ(snapshot(1.3)["bodies"][0]["f"], json({0.0, 0.0, 6.0}));
}

TEST_F(BusMonitorTest, ShowsKnownMetacentres) {
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kHydrostaticBox, 0.0)}), at(0.1));
  BodyHydrostatics body;
  body.body_id = kHydrostaticBox;
  body.metacenters = {{{0.0, 0.0, 0.25}, {0.0, 0.0, 0.5}}};
  body.metacentric_heights = {0.75, kNan};
  monitor_.on_hydrostatics(encoded(BodiesHydrostatics{.id = {}, .bodies = {body}}));
  json shown = snapshot(0.1)["bodies"][0];
  EXPECT_EQ(shown["m"], json({{0.0, 0.0, 0.25}, {0.0, 0.0, 0.5}}));
  EXPECT_EQ(shown["gm"], json({0.75, nullptr}));
  body.metacenters[1][2] = kNan;  // dry
  monitor_.on_hydrostatics(encoded(BodiesHydrostatics{.id = {}, .bodies = {body}}));
  EXPECT_TRUE(snapshot(0.1)["bodies"][0]["m"].is_null());
}

class BusMonitorLoads : public BusMonitorTest {
 protected:
  void SetUp() override {
    monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, 0.0), upright(kFastBox, 0.0)}), at(0.1));
    loads_.body_id = kBox;
    loads_.immersion = 0.5;
    loads_.buoyancy_force = {0.0, 0.25, 4'000.0};
    loads_.buoyancy_torque = {1.0, 2.0, 3.0};
    loads_.drag_force = {-4.0, -5.0, -6.0};
    loads_.drag_torque = {-7.0, -8.0, -9.0};
    loads_.added_mass_force = {10.0, 11.0, 12.0};
    loads_.added_mass_torque = {13.0, 14.0, 15.0};
    loads_.water_velocity = {0.5, -0.25, 0.125};
  }
  static std::vector<std::uint8_t> bytes_of(const BodyLoads& loads) {
    return encoded(BodiesLoads{.id = {0, 1, 1}, .bodies = {loads}});
  }
  bool shows_loads(double now = 0.1) { return snapshot(now)["bodies"][0].contains("loads"); }

  BodyLoads loads_;
};

TEST_F(BusMonitorLoads, AreShownForTheirBody) {
  EXPECT_FALSE(shows_loads());
  monitor_.on_loads(bytes_of(loads_));
  const json bodies = snapshot(0.1)["bodies"];
  EXPECT_EQ(bodies[0]["loads"], json({{"immersion", 0.5},
                                      {"buoyancy", {0.0, 0.25, 4000.0, 1.0, 2.0, 3.0}},
                                      {"drag", {-4.0, -5.0, -6.0, -7.0, -8.0, -9.0}},
                                      {"added_mass", {10.0, 11.0, 12.0, 13.0, 14.0, 15.0}},
                                      {"water_velocity", {0.5, -0.25, 0.125}}}));
  EXPECT_FALSE(bodies[1].contains("loads"));
}

TEST_F(BusMonitorLoads, AreHiddenIfLaterOnesAreNotOkOrFinite) {
  monitor_.on_loads(bytes_of(loads_));
  BodyLoads other = loads_;
  other.status = BodyStatus::kNonFiniteTwist;
  monitor_.on_loads(bytes_of(other));
  EXPECT_FALSE(shows_loads());
  for (auto* numbers :
       {&loads_.buoyancy_force, &loads_.buoyancy_torque, &loads_.drag_force, &loads_.drag_torque,
        &loads_.added_mass_force, &loads_.added_mass_torque, &loads_.water_velocity}) {
    monitor_.on_loads(bytes_of(loads_));
    ASSERT_TRUE(shows_loads());
    const double original = std::exchange((*numbers)[1], kNan);
    monitor_.on_loads(bytes_of(loads_));
    EXPECT_FALSE(shows_loads());
    (*numbers)[1] = original;
  }
  loads_.immersion = std::numeric_limits<double>::infinity();
  monitor_.on_loads(bytes_of(loads_));
  EXPECT_FALSE(shows_loads());
}

TEST_F(BusMonitorLoads, AreHiddenWhenOverdue) {
  monitor_.on_response(response_bytes({0, 1, 1}, {vertical_force(kBox, 5.0)}), at(0.1));
  monitor_.on_loads(bytes_of(loads_));
  monitor_.on_request(request_bytes({0, 1, 2}, {upright(kBox, 0.0)}), at(1.05));
  EXPECT_TRUE(shows_loads(1.05));
  monitor_.on_request(request_bytes({0, 1, 3}, {upright(kBox, 0.0)}), at(1.2));
  EXPECT_FALSE(shows_loads(1.2));
}

TEST_F(BusMonitorLoads, AreUnchangedByMalformedMessages) {
  monitor_.on_loads(bytes_of(loads_));
  const json before = snapshot(0.1)["bodies"];
  loads_.immersion = 0.75;
  const std::vector<std::uint8_t> valid = bytes_of(loads_);
  for (std::size_t size = 0; size < valid.size(); ++size) monitor_.on_loads(Bytes(valid).first(size));
  std::vector<std::uint8_t> negative = valid;
  negative[32] = 0xff;  // the number of bodies
  monitor_.on_loads(negative);
  std::vector<std::uint8_t> other_type = valid;
  other_type[0] ^= 1U;
  monitor_.on_loads(other_type);
  loads_.body_id = kNoBody;
  monitor_.on_loads(bytes_of(loads_));
  EXPECT_EQ(snapshot(0.1)["bodies"], before);
  EXPECT_EQ(monitor_.counts().malformed,
            (std::array<std::int64_t, 4>{36, 1, 1, static_cast<std::int64_t>(valid.size()) - 36}));
}

TEST_F(BusMonitorTest, KeepsPositionsFarFromOriginExact) {
  constexpr double kFarHeight = 5'000'000.125;  // [m]; adjacent floats are 0.5 m apart
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, kFarHeight)}), at(0.0));
  EXPECT_EQ(snapshot(0.0)["bodies"][0]["p"], json({3.0, -2.0, kFarHeight}));
}

TEST_F(BusMonitorTest, CountsMalformedMessagesByError) {
  std::array<std::int64_t, 4> expected{};
  for (const MalformedMessage& malformed : malformed_messages()) {
    monitor_.on_request(malformed.bytes, at(0.0));
    ++expected[static_cast<std::size_t>(malformed.error)];
  }
  EXPECT_EQ(monitor_.counts().malformed, expected);
  EXPECT_EQ(monitor_.tracker().requests, 0);
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kBox, 2.0)}), at(0.1));
  EXPECT_EQ(snapshot(0.1)["bodies"].size(), 1U);
}

// Poses of bot_core: responses are wrenches for the box, force and torque for the fast box.
class BusMonitorPoses : public BusMonitorTest {
 protected:
  BusMonitorPoses() : BusMonitorTest({.channels = {{"BOX", kBox, ""}, {"FAST", kFastBox, "FORCE"}}}) {}
  void on_pose(std::size_t channel, std::int64_t utime, double height) {
    monitor_.on_pose(channel, encoded_by_lcm(upright_pose(height, utime)),
                     at(1e-6 * static_cast<double>(utime)));
  }
  void on_force(std::int64_t utime, double force, double now) {
    std::vector<std::uint8_t> bytes;
    encode_six_axis_force_torque(utime, {0.0, 0.0, force}, {1.0, 2.0, 3.0}, bytes);
    monitor_.on_force_torque(1, bytes, at(now));
  }
};

TEST_F(BusMonitorPoses, MatchesResponsesByBodyAndTime) {
  on_pose(0, 100'000, 0.25);
  on_pose(1, 100'000, 0.5);
  EXPECT_EQ(snapshot(0.1)["bodies"].size(), 2U);
  monitor_.on_response(response_bytes({100'000, 8'765, 4'321}, {vertical_force(kBox, 5.0)}), at(0.103));
  EXPECT_EQ(monitor_.tracker().responses, 1) << "session_id and seq are unknown to the observer";
  EXPECT_NEAR(monitor_.latency().max, 0.003, 1e-5);
  on_force(100'000, 7.0, 0.104);
  EXPECT_EQ(monitor_.tracker().responses, 2);
  EXPECT_EQ(monitor_.tracker().requests, 2);
  EXPECT_EQ(monitor_.tracker().responses_without_request, 0);
  EXPECT_EQ(monitor_.service_state(0.2), ServiceState::kAnswering);
  const json bodies = snapshot(0.2)["bodies"];
  EXPECT_EQ(bodies[0]["p"], json({0.0, 0.0, 0.25}));
  EXPECT_EQ(bodies[0]["f"], json({0.0, 0.0, 5.0}));
  EXPECT_EQ(bodies[0]["status"], 0);
  EXPECT_EQ(bodies[1]["f"], json({0.0, 0.0, 7.0}));
  EXPECT_EQ(bodies[1]["t"], json({1.0, 2.0, 3.0}));
  for (const char* unknown : {"status", "b", "volume", "force_bound", "torque_bound"}) {
    EXPECT_TRUE(bodies[1][unknown].is_null()) << unknown;
  }
}

TEST_F(BusMonitorPoses, CountsUnansweredPosesButNoGaps) {
  for (std::int64_t i = 0; i < 5; ++i) on_pose(0, 10'000 * i, 0.0);
  monitor_.on_response(response_bytes({40'000, 1, 4}, {vertical_force(kBox, 1.0)}), at(0.041));
  monitor_.on_response(response_bytes({40'001, 1, 5}, {vertical_force(kBox, 1.0)}), at(0.042));
  monitor_.tick(3.0);
  EXPECT_EQ(monitor_.tracker().requests_missed, 0);
  EXPECT_EQ(monitor_.tracker().unanswered, 4);
  EXPECT_EQ(monitor_.tracker().responses_without_request, 1) << "1 us after the latest pose";
}

TEST_F(BusMonitorPoses, PrefersRequestOverPoseForResponse) {
  on_pose(0, 100'000, 0.25);
  monitor_.on_request(request_bytes({100'000, 1, 1}, {upright(kBox, 2.0)}), at(0.105));
  monitor_.on_response(response_bytes({100'000, 1, 1}, {vertical_force(kBox, 5.0)}), at(0.11));
  EXPECT_NEAR(monitor_.latency().max, 0.005, 1e-5) << "from the request, not from the pose";
  monitor_.tick(3.0);
  EXPECT_EQ(monitor_.tracker().responses, 1);
  EXPECT_EQ(monitor_.tracker().unanswered, 1) << "the pose";
}

TEST_F(BusMonitorPoses, CountsMalformedPosesByError) {
  monitor_.on_pose(0, Bytes(), at(0.0));
  monitor_.on_pose(0, request_bytes({0, 1, 1}, {upright(kBox, 2.0)}), at(0.0));
  std::vector<std::uint8_t> longer = encoded_by_lcm(upright_pose(0.0, 1));
  monitor_.on_force_torque(1, longer, at(0.0));
  longer.push_back(0);
  monitor_.on_pose(0, longer, at(0.0));
  const std::array<std::int64_t, 4>& malformed = monitor_.counts().malformed;
  EXPECT_EQ(malformed[static_cast<std::size_t>(DecodeError::kTruncated)], 1);
  EXPECT_EQ(malformed[static_cast<std::size_t>(DecodeError::kFingerprint)], 2);
  EXPECT_EQ(malformed[static_cast<std::size_t>(DecodeError::kLength)], 1);
  EXPECT_EQ(monitor_.tracker().requests, 0);
}

TEST_F(BusMonitorTest, CountsBodiesNotInScene) {
  monitor_.on_request(request_bytes({0, 1, 1}, {upright(kNoBody, 2.0), upright(kBox, 1.0)}), at(0.0));
  monitor_.on_response(response_bytes({0, 1, 1}, {vertical_force(kNoBody, 1.0)}), at(0.0));
  EXPECT_EQ(monitor_.counts().bodies_not_in_scene, 1);
  EXPECT_EQ(snapshot(0.0)["bodies"].size(), 1U);
}

TEST_F(BusMonitorTest, ComputesPercentilesPerSecondAndInTotal) {
  for (int i = 0; i < 100; ++i) {
    const double begin = 0.1 + 0.001 * i;
    monitor_.on_request(request_bytes({0, 1, i}, {}), at(begin));
    monitor_.on_response(response_bytes({0, 1, i}, {}), at(begin + (i < 60 ? 0.001 : 0.004)));
  }
  monitor_.tick(1.0);
  ASSERT_EQ(monitor_.seconds().size(), 1U);
  const SecondStats& second = monitor_.seconds().back();
  EXPECT_EQ(second.requests, 100);
  EXPECT_EQ(second.responses, 100);
  EXPECT_NEAR(second.latency.p50, 0.001, 0.03 * 0.001);
  EXPECT_NEAR(second.latency.max, 0.004, 1e-5);
  monitor_.tick(2.0);
  EXPECT_EQ(monitor_.seconds().back().responses, 0);
  EXPECT_TRUE(snapshot(2.0)["second"]["p50"].is_null());
  EXPECT_NEAR(snapshot(2.0)["latency"]["p50"].get<double>(), 0.001, 0.03 * 0.001);
}

TEST_F(BusMonitorTest, KeepsOneMinuteAndSkipsPauses) {
  for (int i = 1; i <= 100; ++i) monitor_.tick(i);
  EXPECT_EQ(monitor_.seconds().size(), BusMonitor::kSecondsKept);
  EXPECT_EQ(monitor_.seconds().back().number, 99);
  monitor_.tick(1e6);
  monitor_.tick(1e6 + 0.5);
  EXPECT_EQ(monitor_.seconds().back().number, 100);
  EXPECT_EQ(parse_json(history_json(monitor_)).size(), BusMonitor::kSecondsKept);
}

TEST_F(BusMonitorTest, ReportsServiceState) {
  EXPECT_EQ(monitor_.service_state(0.0), ServiceState::kOffline) << "no message yet";
  monitor_.on_status(status_bytes(7), 1.0);
  EXPECT_EQ(monitor_.service_state(1.5), ServiceState::kIdle);
  monitor_.on_request(request_bytes({0, 1, 1}, {}), at(2.0));
  monitor_.on_response(response_bytes({0, 1, 1}, {}), at(2.0));
  EXPECT_EQ(monitor_.service_state(2.1), ServiceState::kAnswering);
  monitor_.on_request(request_bytes({0, 1, 2}, {}), at(2.2));
  monitor_.on_request(request_bytes({0, 1, 2}, {}), at(3.2));
  EXPECT_EQ(monitor_.service_state(3.5), ServiceState::kNotAnswering) << "the last status is 2.5 s old";
  monitor_.on_request(request_bytes({0, 1, 2}, {}), at(4.2));
  EXPECT_EQ(monitor_.service_state(4.3), ServiceState::kOffline);
  monitor_.on_status(status_bytes(8), 5.0);
  monitor_.on_request(request_bytes({0, 1, 2}, {}), at(5.1));
  monitor_.on_response(response_bytes({0, 1, 2}, {}), at(5.1));
  EXPECT_EQ(monitor_.service_state(5.2), ServiceState::kAnswering);
  EXPECT_EQ(monitor_.counts().services_started, 2);
}

TEST_F(BusMonitorTest, BecomesIdleWithoutNewRequests) {
  monitor_.on_request(request_bytes({0, 1, 1}, {}), at(0.0));
  for (const double now : {1.0, 2.0, 3.0, 4.0, 5.0}) monitor_.on_status(status_bytes(7), now);
  EXPECT_EQ(monitor_.service_state(1.5), ServiceState::kNotAnswering);
  EXPECT_EQ(monitor_.service_state(5.0), ServiceState::kIdle) << "the request is older than kStatusTimeout";
  monitor_.on_request(request_bytes({0, 1, 2}, {}), at(5.1));
  EXPECT_EQ(monitor_.service_state(5.2), ServiceState::kIdle) << "a new request has its own timeout";
}

TEST_F(BusMonitorTest, ListsServicesSeenRecently) {
  monitor_.on_status(status_bytes(7), 0.0);
  monitor_.on_status(status_bytes(std::numeric_limits<std::int64_t>::min()), 0.5);
  monitor_.on_status(status_bytes(7), 1.0);
  EXPECT_EQ(snapshot(1.0)["services"], json({"7", "-9223372036854775808"}));
  EXPECT_EQ(snapshot(3.8)["services"], json({"7"}));
  for (std::int64_t id = 100; id < 1'000; ++id) monitor_.on_status(status_bytes(id), 4.0);
  EXPECT_EQ(snapshot(4.0)["services"].size(), BusMonitor::kMaxServices);
}

TEST_F(BusMonitorTest, ReplacesInvalidUtf8InSceneName) {
  monitor_.on_status(status_bytes(7, "sc\xff\n\"ene"), 0.0);
  const std::string text = snapshot_json(monitor_, 1, 0.0, 0.0, 0.0);
  EXPECT_FALSE(contains(text, "\n")) << "an event is a single line";
  EXPECT_EQ(parse_json(text)["status"]["scene"], "sc\xEF\xBF\xBD\n\"ene");
}

// Messages with one random byte, some truncated, as from an untrusted network.
RC_GTEST_FIXTURE_PROP(BusMonitorTest, WritesValidJsonForAnyTraffic, ()) {
  double now = 0.0;
  const std::vector<std::vector<std::uint8_t>> messages{
      request_bytes({1, 2, 3}, {upright(kBox, 1.0), upright(kHydrostaticBox, kNan)}, 0.5),
      response_bytes({1, 2, 3}, {vertical_force(kBox, 1e300), vertical_force(kFastBox, kNan)}),
      status_bytes(5)};
  const int count = *rc::gen::inRange(0, 50);
  for (int i = 0; i < count; ++i) {
    std::vector<std::uint8_t> bytes = *rc::gen::elementOf(messages);
    const auto position = *rc::gen::inRange<std::size_t>(0, bytes.size());
    bytes[position] = *rc::gen::arbitrary<std::uint8_t>();
    if (*rc::gen::inRange(0, 8) == 0) bytes.resize(position);
    now += 0.1 * *rc::gen::inRange(0, 10);
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        monitor_.on_request(bytes, at(now));
        break;
      case 1:
        monitor_.on_response(bytes, at(now));
        break;
      case 2:
        monitor_.on_hydrostatics(bytes);
        break;
      default:
        monitor_.on_status(bytes, now);
    }
    monitor_.tick(now);
    const std::string text = snapshot_json(monitor_, i, 0.0, now, now);
    RC_ASSERT(json::accept(text));
    RC_ASSERT(text.find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace buoyancy::view
