// Requests for the water at points, against closed forms and SeaSnapshot.
#include "engine/water_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/sea_bytes.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using Step = RequestHandler::Step;

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
constexpr double kGravity = 9.81;                     // [m/s^2], of the scenes here
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const std::string kWorld = "[world]\ngravity = 9.81\n";
const std::string kBody = "[[body]]\nid = 1\nshape = { type = \"box\" }\n";
const std::string kCurrent = "[water.current]\nvelocity = [0.5, -0.25, 0]\n";
const std::string kLayers =
    "[[water.layer]]\nbelow = -1\ndensity = 1010\n[[water.layer]]\nbelow = -3\ndensity = 1030\n";
const std::string kProfile =
    "[[water.current.profile]]\nheight = 0\nvelocity = [1, 0, 0]\n"
    "[[water.current.profile]]\nheight = -4\nvelocity = [0, 2, 0]\n";
const std::string kManyWaves =
    "[[water.waves]]\ntype = \"jonswap\"\nsignificant_wave_height = 1\npeak_period = 4\nfrequencies = 200\n";

Scene scene_with(const std::string& water) {
  return scene_of(kWorld + "[water]\ndensity = 1000\n" + water + kBody);
}

ByteVector points_request(const RequestId& id, const std::vector<WaterPoint>& points) {
  ByteVector bytes;
  encode(BorrowedWaterPoints{id, points}, bytes);
  return bytes;
}

WaterSamples samples_of(const Scene& scene, const std::vector<WaterPoint>& points,
                        std::int64_t utime = kNow) {
  RequestHandler handler(scene, {.threads = 1});
  return decoded<WaterSamples>(handler.handle(points_request({utime, 1, 1}, points)));
}

std::vector<WaterPoint> random_points(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> horizontal(-50.0, 50.0), height(-8.0, 1.0);
  std::vector<WaterPoint> points(count);
  for (WaterPoint& point : points) point.position = {horizontal(random), horizontal(random), height(random)};
  return points;
}

TEST(WaterAtPoints, AtRestIsThatOfLayersAndCurrent) {
  struct Case {
    std::string water;
    double z;
    double pressure_over_gravity;
    std::array<double, 3> velocity;
    double density;
  };
  const std::vector<Case> cases{
      {"", -2.0, 2000.0, {}, 1000.0},
      {"", 0.5, 0.0, {}, 1000.0},
      {"level = 3\n" + kCurrent, 1.0, 2000.0, {0.5, -0.25, 0.0}, 1000.0},
      {"level = 3\n" + kCurrent, 3.5, 0.0, {}, 1000.0},
      {kCurrent, 0.0, 0.0, {0.5, -0.25, 0.0}, 1000.0},
      {kLayers + kProfile, -0.5, 500.0, {0.875, 0.25, 0.0}, 1000.0},
      {kLayers + kProfile, -1.0, 1000.0, {0.75, 0.5, 0.0}, 1000.0},
      {kLayers + kProfile, -2.0, 1000.0 + 1010.0, {0.5, 1.0, 0.0}, 1010.0},
      {kLayers + kProfile, -5.0, 1000.0 + 2.0 * 1010.0 + 2.0 * 1030.0, {0.0, 2.0, 0.0}, 1030.0},
      {kLayers + kProfile, 2.0, 0.0, {}, 1000.0}};
  for (const Case& each : cases) {
    const Scene scene = scene_with(each.water);
    const std::string where = each.water + " at " + std::to_string(each.z);
    const WaterSamples samples = samples_of(scene, {{{70.0, -3.0, each.z}}});
    EXPECT_EQ(samples.status, BodyStatus::kOk) << where;
    ASSERT_EQ(samples.samples.size(), 1U) << where;
    const WaterSample& sample = samples.samples[0];
    EXPECT_EQ(sample.elevation, 0.0) << where;
    EXPECT_NEAR(sample.pressure, kGravity * each.pressure_over_gravity, 1e-10) << where;
    EXPECT_EQ(sample.density, each.density) << where;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(sample.velocity[axis], each.velocity[axis], 1e-15) << where;
    }
  }
}

// A regular wave along x over deep water, stretched after Wheeler: p = rho g (a exp(k s) cos - z).
TEST(WaterAtPoints, OfARegularWaveIsItsClosedForm) {
  const Scene scene =
      scene_with(kCurrent + "[[water.waves]]\ntype = \"regular\"\nheight = 0.8\nperiod = 4\ndirection = 0\n");
  const double a = 0.4, w = 0.5 * std::numbers::pi, k = w * w / kGravity;
  constexpr std::int64_t kTime = 1'250'000;  // [us]
  const std::vector<WaterPoint> points = random_points(500);
  const WaterSamples samples = samples_of(scene, points, kTime);
  ASSERT_EQ(samples.status, BodyStatus::kOk);
  std::size_t above = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z] = points[i].position;
    const double theta = k * (x - 0.5e-6 * kTime) - 1e-6 * w * kTime;
    const double eta = a * std::cos(theta);
    const double s = z - eta;
    const WaterSample& sample = samples.samples[i];
    EXPECT_NEAR(sample.elevation, eta, 1e-13) << i;
    EXPECT_EQ(sample.density, 1000.0) << i;
    if (s > 0.0) {
      ++above;
      EXPECT_EQ(sample.pressure, 0.0) << i;
      EXPECT_EQ(sample.velocity, (std::array<double, 3>{})) << i;
      continue;
    }
    EXPECT_NEAR(sample.pressure, 1000.0 * kGravity * (a * std::exp(k * s) * std::cos(theta) - z), 1e-8) << i;
    EXPECT_NEAR(sample.velocity[0], 0.5 + a * w * std::exp(k * s) * std::cos(theta), 1e-12) << i;
    EXPECT_NEAR(sample.velocity[1], -0.25, 1e-12) << i;
    EXPECT_NEAR(sample.velocity[2], a * w * std::exp(k * s) * std::sin(theta), 1e-12) << i;
  }
  EXPECT_GT(above, 20U);
}

// Bits and all: the surface and the pressure that the loads of bodies integrate.
TEST(WaterAtPoints, InWavesIsThatOfTheSnapshotWithLayersAndProfile) {
  const Scene scene = scene_with("depth = 12\n" + kLayers + kProfile + kManyWaves);
  const SeaSnapshot snapshot(*scene.sea(), kNow);
  const std::vector<WaterPoint> points = random_points(200);
  const WaterSamples samples = samples_of(scene, points);
  ASSERT_EQ(samples.status, BodyStatus::kOk);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [x, y, z] = points[i].position;
    const WaterAtPoint expected = snapshot.at({x, y, z});
    const WaterSample& sample = samples.samples[i];
    EXPECT_EQ(sample.elevation, snapshot.elevation(x, y)) << i;
    if (expected.height > 0.0) {
      EXPECT_EQ(sample.pressure, 0.0) << i;
      EXPECT_EQ(sample.density, 1000.0) << i;
      continue;
    }
    const double of_layers = 10.0 * std::max(0.0, -1.0 - z) + 20.0 * std::max(0.0, -3.0 - z);
    EXPECT_NEAR(sample.pressure, expected.pressure + kGravity * of_layers, 1e-9) << i;
    EXPECT_EQ(sample.density, z < -3.0 ? 1030.0 : z < -1.0 ? 1010.0 : 1000.0) << i;
    const Vec3 current_W = velocity_at(scene.current().profile, z);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<Eigen::Index>(axis);
      EXPECT_EQ(sample.velocity[axis], current_W[n] + expected.velocity_W[n]) << i;
    }
  }
}

TEST(WaterAtPoints, IsUnknownBeyondTheEdgeOfAGrid) {
  auto spline = std::make_shared<ElevationSpline>();
  const std::vector<double> level(64, 0.5);
  ASSERT_TRUE(spline->set(ElevationGrid<double>{level, 8, 8, {0.0, 0.0}, {1.0, 1.0}, false}));
  const Water water{.density = 1000.0, .gravity = kGravity};
  const PreparedSea sea(Sea::of_surfaces({{0, spline}}, water));
  const SeaAtTime now(sea, 0);
  const WaterState state{&water, &now};
  const WaterSample inside = sample_at(state, {}, {{3.0, 4.0, -1.0}});
  EXPECT_NEAR(inside.elevation, 0.5, 1e-12);
  EXPECT_NEAR(inside.pressure, 1000.0 * kGravity * 1.5, 1e-8);
  const WaterSample outside = sample_at(state, {}, {{7.5, 4.0, -1.0}});
  EXPECT_TRUE(std::isnan(outside.elevation));
}

void expect_failed(const WaterSamples& samples, BodyStatus status, std::size_t count) {
  EXPECT_EQ(samples.status, status);
  ASSERT_EQ(samples.samples.size(), count);
  for (const WaterSample& sample : samples.samples) {
    EXPECT_EQ(sample.elevation, 0.0);
    EXPECT_EQ(sample.pressure, 0.0);
    EXPECT_EQ(sample.velocity, (std::array<double, 3>{}));
    EXPECT_EQ(sample.density, 0.0);
  }
}

TEST(WaterAtPoints, OfAHostileRequestIsZeroWithAStatus) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double largest = std::numeric_limits<double>::max();
  for (const std::string& water : {std::string(), kManyWaves}) {
    const Scene scene = scene_with(water);
    for (const double bad : {kNaN, infinity, -infinity}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<WaterPoint> points = random_points(5);
        points[3].position[axis] = bad;
        expect_failed(samples_of(scene, points), BodyStatus::kNonFinitePose, 5);
      }
    }
    std::vector<WaterPoint> points = random_points(5);
    points[4].position[2] = -largest;
    expect_failed(samples_of(scene, points), BodyStatus::kOutOfRange, 5);
    EXPECT_EQ(samples_of(scene, {}).status, BodyStatus::kOk) << "no point is no error";
    for (const std::int64_t utime :
         {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
      EXPECT_EQ(samples_of(scene, random_points(3), utime).status, BodyStatus::kOk) << utime;
    }
  }
}

TEST(WaterAtPoints, IsUnknownUntilASeaIsReceived) {
  const Scene scene = scene_of("[water]\nwaves = \"received\"\n" + kBody);
  RequestHandler handler(scene, {.threads = 1});
  const std::vector<WaterPoint> points = random_points(3);
  const auto samples_at = [&](std::int64_t utime) {
    return decoded<WaterSamples>(handler.handle(points_request({utime, 1, utime}, points)));
  };
  expect_failed(samples_at(500), BodyStatus::kNoSea, 3);
  ASSERT_TRUE(
      handler.receive_sea(sea_bytes("waves = { type = \"regular\", period = 8, height = 2 }\n", 1000)));
  expect_failed(samples_at(999), BodyStatus::kNoSea, 3);
  EXPECT_EQ(samples_at(1000).status, BodyStatus::kOk);
  EXPECT_NE(samples_at(1001).samples[0].elevation, 0.0);
  EXPECT_EQ(handler.counters().water_points, 6);
  EXPECT_EQ(handler.counters().water_points_failed, 6);
}

TEST(WaterRequests, AreSessionsOfTheirOwn) {
  const Scene scene = scene_with(kManyWaves);
  RequestHandler handler(scene, {.threads = 1});
  const ByteVector points = points_request({kNow, 5, 9}, random_points(4));
  const ByteVector bodies = request_bytes({kNow, 5, 3}, {upright(1, 0.0)});
  const ByteVector samples = copy_of(handler.handle(points));
  const ByteVector wrenches = copy_of(handler.handle(bodies));
  EXPECT_EQ(handler.last_session(), SessionKey(5));
  EXPECT_EQ(copy_of(handler.handle(points)), samples);
  EXPECT_EQ(handler.last_session(), (SessionKey{5, RequestKind::kWaterPoints}));
  EXPECT_EQ(copy_of(handler.handle(bodies)), wrenches);
  const ServiceCounters& counters = handler.counters();
  EXPECT_EQ(counters.requests, 4);
  EXPECT_EQ(counters.computed, 2);
  EXPECT_EQ(counters.retries, 2);
  EXPECT_EQ(counters.stale, 0);
  EXPECT_EQ(counters.sessions, 2);
  EXPECT_EQ(counters.water_points, 4);
  // The same number with other points is another request.
  EXPECT_NE(copy_of(handler.handle(points_request({kNow, 5, 9}, random_points(3)))), samples);
  EXPECT_EQ(counters.conflicting_retries, 1);
  EXPECT_EQ(handler.newest_seq({5, RequestKind::kWaterPoints}), 9);
  EXPECT_EQ(handler.newest_seq(5), 3);
}

// The water between two requests about bodies is that of another time.
TEST(WaterRequests, ChangeNoWrench) {
  const Scene scene = scene_with(kManyWaves);
  RequestHandler handler(scene, {.threads = 1});
  RequestHandler alone(scene, {.threads = 1});
  for (std::int64_t seq = 1; seq < 20; ++seq) {
    // At the time of the bodies, or at another one.
    const std::int64_t utime = kNow + 1'000 * (seq / 2);
    handler.handle(points_request({seq % 4 == 3 ? utime + 7 : utime, 5, seq}, random_points(4)));
    const ByteVector bodies = request_bytes({utime, 5, seq}, {upright(1, 0.0)});
    ASSERT_EQ(copy_of(handler.handle(bodies)), copy_of(alone.handle(bodies))) << seq;
  }
}

TEST(WaterRequests, InSlicesAndOnThreadsHaveTheSameBytes) {
  const Scene scene = scene_with(kManyWaves);
  const ByteVector request = points_request({kNow, 1, 1}, random_points(3'000));
  RequestHandler whole(scene, {.threads = 1});
  const ByteVector expected = copy_of(whole.handle(request));
  for (const unsigned threads : {1U, 4U}) {
    RequestHandler handler(scene, {.threads = threads});
    ASSERT_EQ(handler.begin(request, Deadline{}), Step::kStarted);
    EXPECT_EQ(handler.begin(request, Deadline{}), Step::kStarted) << "a retry";
    int slices = 1;
    for (; handler.in_progress() > 0; ++slices) {
      handler.handle(points_request({kNow + slices, 2, slices}, random_points(5)));
      handler.resume(Deadline{});
    }
    EXPECT_EQ(copy_of(handler.last_response()), expected) << threads;
    EXPECT_GT(slices, 5);
    EXPECT_EQ(handler.counters().requests_sliced, 1);
    EXPECT_EQ(handler.counters().water_points, 3'000 + 5 * (slices - 1));
  }
}

TEST(WaterRequests, AreWithinTheBudgetOfAResponse) {
  const Scene scene = scene_with("");
  RequestHandler handler(scene, {.threads = 1, .budgets = {.message_bytes = water_samples_size(100)}});
  const std::vector<WaterPoint> points = random_points(101);
  EXPECT_EQ(handler.begin(points_request({0, 1, 1}, points), kNoDeadline), Step::kRejected);
  EXPECT_EQ(handler.counters().rejected_points, 1);
  EXPECT_EQ(handler.counters().rejected(), 1);
  EXPECT_EQ(handler.counters().sessions, 0);
  EXPECT_EQ(handler.begin(points_request({0, 1, 1}, {points.begin(), points.begin() + 100}), kNoDeadline),
            Step::kAnswered);
}

TEST(WaterRequests, OfAWrongLengthAreRejectedAndCounted) {
  const Scene scene = scene_with("");
  RequestHandler handler(scene, {.threads = 1});
  ByteVector request = points_request({0, 1, 1}, random_points(2));
  request.pop_back();
  EXPECT_TRUE(handler.handle(request).empty());
  EXPECT_EQ(handler.counters().rejected_length, 1);
  request.resize(20);
  EXPECT_TRUE(handler.handle(request).empty());
  EXPECT_EQ(handler.counters().rejected_truncated, 1);
}

TEST(WaterRequests, AllocateNothingOnceBuffersAreLargeEnough) {
  const Scene scene = scene_with(kLayers + kProfile + kManyWaves);
  for (const unsigned threads : {1U, 3U}) {
    RequestHandler handler(scene, {.threads = threads});
    std::vector<ByteVector> requests;
    for (std::int64_t i = 0; i < 6; ++i) {
      requests.push_back(points_request({kNow + i, 1, i}, random_points(i == 0 ? 300 : 200)));
    }
    handler.handle(requests[0]);
    handler.handle(requests[1]);
    const AllocationCount allocations;
    for (std::size_t i = 2; i < requests.size(); ++i) {
      ASSERT_FALSE(handler.handle(requests[i]).empty());
    }
    EXPECT_EQ(threads == 1 ? allocations.count() : 0, 0);
  }
}

}  // namespace
}  // namespace buoyancy
