// Requests for the water at points, over UDP: by an independent client, by the client library, and hostile
// ones.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/client.h"
#include "engine/request_handler.h"
#include "tests/service/raw_lcm.h"
#include "tests/service/running_service.h"
#include "tests/support/scene_of.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

using testing::HasSubstr;

const std::string kSea = R"(
[water]
density = 1000
[[water.layer]]
below = -1.5
density = 1025
[[water.waves]]
type = "jonswap"
significant_wave_height = 0.6
peak_period = 4
[[body]]
id = 1
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
tolerance = 1e-3
)";

std::vector<WaterPoint> points_of(std::size_t count) {
  std::vector<WaterPoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<double>(i);
    points[i].position = {30.0 * std::sin(t), 20.0 * std::cos(1.3 * t),
                          0.5 - 3.0 * std::abs(std::sin(1.7 * t))};
  }
  return points;
}

RawBytes points_request(const RequestId& id, const std::vector<WaterPoint>& points) {
  RawBytes bytes;
  encode(BorrowedWaterPoints{id, points}, bytes);
  return bytes;
}

void send_points(RawLcmSocket& socket, const RawBytes& request) {
  socket.send("BUOYANCY_WATER_POINTS", request);
}

RawBytes receive_samples(RawLcmSocket& socket) {
  const std::optional<RawBytes> bytes = socket.receive("BUOYANCY_WATER_SAMPLES", kWaitTimeout);
  if (!bytes) throw std::runtime_error("no samples");
  return *bytes;
}

TEST(WaterOverUdp, IsThatOfTheHandlerAndOfItsRetries) {
  const RunningService service({}, kSea);
  RawLcmSocket socket;
  const Scene scene = scene_of(kSea);
  RequestHandler handler(scene, {.threads = 1});
  for (const std::size_t count : {1U, 3'000U}) {
    const RawBytes request =
        points_request({12'345'678, -7, static_cast<std::int64_t>(count)}, points_of(count));
    const Bytes expected = handler.handle(request);
    for (int sent = 0; sent < 2; ++sent) {
      send_points(socket, request);
      EXPECT_TRUE(std::ranges::equal(receive_samples(socket), expected)) << count;
    }
  }
  // The same session and seq of bodies is another session.
  WrenchRequest states = one_body(-7, 3'000, 0.2);
  send_request(socket, states);
  EXPECT_EQ(receive(socket).id.seq, 3'000);
  const auto status =
      wait_for_status(socket, [](const ServiceStatus& now) { return now.counters.computed == 3; });
  ASSERT_TRUE(status);
  EXPECT_EQ(status->counters.retries, 2);
  EXPECT_EQ(status->counters.conflicting_retries, 0);
  EXPECT_EQ(status->counters.sessions, 2);
  EXPECT_EQ(status->counters.water_points, 3'001);
}

TEST(WaterOverUdp, RejectsAndCountsWhatIsNoRequest) {
  const RunningService service({}, kSea);
  RawLcmSocket socket;
  const RawBytes good = points_request({1, 2, 3}, points_of(2));
  RawBytes longer = good;
  longer.push_back(0);
  send_points(socket, longer);
  RawBytes negative = good;
  negative[32] = 0xff;
  send_points(socket, negative);
  send_points(socket, RawBytes(20));
  send_points(socket, encoded(one_body(2, 1, 0.0)));  // a body_states_t
  socket.send("BUOYANCY_STATES", good);               // and the other way round
  ASSERT_TRUE(wait_for_status(socket, [](const ServiceStatus& status) {
    const ServiceCounters& counters = status.counters;
    return counters.rejected_length == 1 && counters.rejected_count == 1 &&
           counters.rejected_truncated == 1 && counters.rejected_fingerprint == 2 && counters.requests == 5;
  })) << service.log();
  std::vector<WaterPoint> points = points_of(2);
  points[1].position[0] = std::nan("");
  send_points(socket, points_request({1, 2, 4}, points));
  const auto samples = decoded<WaterSamples>(receive_samples(socket));
  EXPECT_EQ(samples.id.seq, 4);
  EXPECT_EQ(samples.status, BodyStatus::kNonFinitePose);
  ASSERT_EQ(samples.samples.size(), 2U);
  EXPECT_EQ(samples.samples[0].density, 0.0);
}

TEST(WaterOverUdp, IsThatOfTheNewestRequestInModeLatest) {
  const RunningService service(
      {"--mode", "latest", "--water-points-channel", "ASK", "--water-samples-channel", "ANSWER"}, kSea);
  RawLcmSocket socket;
  for (std::int64_t seq = 1; seq <= 30; ++seq) {
    socket.send("ASK", points_request({seq, 2, seq}, points_of(100)));
  }
  std::int64_t newest = 0;
  while (newest != 30) {
    const auto bytes = socket.receive("ANSWER", kWaitTimeout);
    ASSERT_TRUE(bytes);
    newest = decoded<WaterSamples>(*bytes).id.seq;
  }
}

TEST(ClientLibrary, SamplesTheWater) {
  const RunningService service({}, kSea);
  const Scene scene = scene_of(kSea);
  RequestHandler handler(scene, {.threads = 1});
  const std::vector<WaterPoint> points = points_of(500);
  for (const std::optional<double> interval : {std::optional<double>(), std::optional(0.001)}) {
    ClientOptions options;
    options.interval = interval;
    options.retry_policy.max_retries = 100'000;
    Expected<Client> client = Client::open(options);
    ASSERT_TRUE(client) << client.error().message();
    for (std::int64_t utime = 1; utime <= 3; ++utime) {
      const BodyState state = one_body(1, 1, 0.1).bodies[0];
      ASSERT_TRUE(client->request(utime, {&state, 1}));
      const auto samples = client->sample_water(utime, points);
      ASSERT_TRUE(samples) << samples.error().message();
      EXPECT_EQ((*samples)->id.seq, utime - 1);
      const auto expected = decoded<WaterSamples>(
          handler.handle(points_request({utime, (*samples)->id.session_id, utime}, points)));
      ASSERT_EQ((*samples)->samples.size(), points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ((*samples)->samples[i].pressure, expected.samples[i].pressure);
        EXPECT_EQ((*samples)->samples[i].velocity, expected.samples[i].velocity);
      }
    }
    EXPECT_EQ(client->statistics().requests, 6);
  }
}

TEST(ClientLibrary, SaysWhyThereIsNoWater) {
  ClientOptions options;
  options.retry_policy = {0.01, 2};
  Expected<Client> client = Client::open(options);
  ASSERT_TRUE(client);
  const std::vector<WaterPoint> points = points_of(400'000);
  const auto none = client->sample_water(1, {points.data(), 3});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("request 0 for the water at 3 points"));
  EXPECT_THAT(none.error().message(), HasSubstr("BUOYANCY_WATER_POINTS and BUOYANCY_WATER_SAMPLES"));
  EXPECT_EQ(client->statistics().retries, 2);
  const auto large = client->sample_water(1, points);
  ASSERT_FALSE(large);
  EXPECT_THAT(large.error().message(), HasSubstr("water at 400000 points"));
  EXPECT_EQ(client->statistics().requests, 1) << "it was not sent";
}

}  // namespace
}  // namespace buoyancy
