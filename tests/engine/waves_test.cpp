// Requests about scenes with waves.

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>

#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/reply.h"
#include "tests/engine/sea_bytes.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026

const std::string kSwell =
    "waves = { type = \"regular\", height = 0.4, period = 4.0, direction = 20.0, phase = 30.0 }\n";
const std::string kReceived = "waves = \"received\"\n";

std::string boxes(const std::string& water) {
  return "[water]\n" + water +
         "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1], segments = [4, 4, 4] }\n"
         "[[body]]\nid = 2\nshape = { type = \"box\", size = [1, 1, 1], segments = [4, 4, 4] }\n"
         "method = \"exact_surface\"\n"
         "[[body]]\nid = 3\nshape = { type = \"rock\", radius = 0.6, frequency = 6, seed = 2 }\n";
}

BodyState placed(std::int32_t id, double x, double z) {
  BodyState state;
  state.body_id = id;
  state.position = {x, -2.0, z};
  state.quaternion_wxyz = {0.8, 0.6, 0.0, 0.0};
  return state;
}

WrenchResponse response_to(RequestHandler& handler, std::int64_t utime, std::vector<BodyState> bodies,
                           double lead_time = 0.0) {
  static std::int64_t seq = 0;
  return decoded<WrenchResponse>(
      handler.handle(request_bytes({utime, 1, ++seq}, std::move(bodies), lead_time)));
}

bool same_wrench(const BodyWrench& a, const BodyWrench& b) {
  return a.force == b.force && a.torque == b.torque && a.submerged_volume == b.submerged_volume &&
         a.force_error_bound == b.force_error_bound && a.status == b.status;
}

TEST(RequestHandlerInWaves, EvaluatesTheSeaAtTheRequestsTime) {
  const Scene scene = scene_of(boxes(kSwell));
  RequestHandler handler(scene);
  SeaSnapshot snapshot(*scene.sea());
  double lowest = 1e9;
  double highest = -1e9;
  for (int i = 0; i < 8; ++i) {
    const std::int64_t utime = kNow + 500'000 * i;
    const WrenchResponse response = response_to(handler, utime, {placed(1, 3.0, 0.0)});
    const BodyWrench& wrench = response.bodies[0];
    ASSERT_EQ(wrench.status, BodyStatus::kOk);
    snapshot.set_time(utime);
    // The waves are long beside the box.
    EXPECT_NEAR(wrench.submerged_volume, 0.5 + snapshot.elevation(3.0, -2.0), 0.03) << i;
    EXPECT_GT(wrench.force_error_bound, 0.0);
    EXPECT_LE(wrench.force_error_bound, 1.01e-3 * kSeawaterDensity * kStandardGravity);
    lowest = std::min(lowest, wrench.force[2]);
    highest = std::max(highest, wrench.force[2]);
  }
  EXPECT_GT(highest, lowest + 1000.0);
}

TEST(RequestHandlerInWaves, AddsTheLeadTimeToTheTimeOfTheWaves) {
  const Scene scene = scene_of(boxes(kSwell));
  RequestHandler handler(scene);
  const BodyWrench led = response_to(handler, kNow, {placed(3, 1.0, 0.0)}, 0.25).bodies[0];
  const BodyWrench later = response_to(handler, kNow + 250'000, {placed(3, 1.0, 0.0)}).bodies[0];
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(led.force[i], later.force[i], 1e-6);
  for (const double sign : {-1.0, 1.0}) {
    const auto status_at = [&](double lead_time) {
      return response_to(handler, kNow, {placed(3, 1.0, 0.0)}, sign * lead_time).bodies[0].status;
    };
    EXPECT_EQ(status_at(1e12), BodyStatus::kOk);
    EXPECT_EQ(status_at(std::nextafter(1e12, 2e12)), BodyStatus::kOutOfRange);
  }
}

TEST(RequestHandlerInWaves, IsUnchangedOnlyAtTheSameTime) {
  const Scene scene = scene_of(boxes(kSwell));
  RequestHandler handler(scene);
  const std::vector<BodyState> bodies{placed(1, 0.0, 0.1), placed(3, 2.0, 20.0)};
  const WrenchResponse first = response_to(handler, kNow, bodies);
  const WrenchResponse again = response_to(handler, kNow, bodies);
  EXPECT_EQ(handler.counters().bodies_unchanged, 2);
  EXPECT_TRUE(same_wrench(first.bodies[0], again.bodies[0]));
  const WrenchResponse later = response_to(handler, kNow + 1'000'000, bodies);
  EXPECT_EQ(handler.counters().bodies_unchanged, 2);
  EXPECT_NE(first.bodies[0].force, later.bodies[0].force);
  response_to(handler, kNow + 1'000'000, bodies, 0.5);
  EXPECT_EQ(handler.counters().bodies_unchanged, 2);
}

TEST(RequestHandlerInWaves, DecidesDryAndDeepBodiesFromBounds) {
  const Scene scene = scene_of(boxes(kSwell));
  RequestHandler handler(scene);
  const WrenchResponse response =
      response_to(handler, kNow, {placed(1, 0.0, 5.0), placed(2, 0.0, 5.0), placed(3, 0.0, -200.0)});
  EXPECT_EQ(handler.counters().bodies_dry, 2);
  EXPECT_EQ(handler.counters().bodies_wet, 1);
  EXPECT_EQ(handler.counters().wave_patches, 0);
  EXPECT_EQ(response.bodies[0].force, (std::array<double, 3>{}));
  EXPECT_EQ(response.bodies[0].force_error_bound, 0.0);
  EXPECT_EQ(response.bodies[2].force[0], 0.0);
  EXPECT_GT(response.bodies[2].force_error_bound, 0.0);
  response_to(handler, kNow, {placed(3, 0.0, 0.0)});
  EXPECT_GT(handler.counters().wave_patches, 0);
}

TEST(RequestHandlerInWaves, PublishesNoBoundOfTheBaselines) {
  const Scene scene = scene_of(boxes(kSwell));
  RequestHandler handler(scene);
  const WrenchResponse response = response_to(handler, kNow, {placed(1, 0.0, 0.1), placed(2, 0.0, 0.1)});
  EXPECT_EQ(response.bodies[1].status, BodyStatus::kOk);
  EXPECT_EQ(response.bodies[1].force_error_bound, std::numeric_limits<double>::infinity());
  EXPECT_EQ(response.bodies[1].torque_error_bound, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(response.bodies[1].force[i], response.bodies[0].force[i], 40.0) << i;
  }
}

TEST(RequestHandlerInWaves, EqualsWaterAtRestBeforeTheRamp) {
  const std::string tolerance = "tolerance = 1e-3\n";
  const Scene waves = scene_of(boxes(kSwell + "ramp = 10.0\ntime_origin = 1000000\n") + tolerance);
  const Scene still = scene_of(boxes("") + tolerance);
  RequestHandler in_waves(waves);
  RequestHandler at_rest(still);
  const std::vector<BodyState> bodies{placed(3, 1.0, 0.1)};
  EXPECT_TRUE(same_wrench(response_to(in_waves, 1'000'000, bodies).bodies[0],
                          response_to(at_rest, 1'000'000, bodies).bodies[0]));
  EXPECT_FALSE(same_wrench(response_to(in_waves, 9'000'000, bodies).bodies[0],
                           response_to(at_rest, 9'000'000, bodies).bodies[0]));
}

TEST(RequestHandlerInWaves, HasNoSeaBeforeOneIsReceived) {
  const Scene scene = scene_of(boxes(kReceived));
  RequestHandler handler(scene);
  const std::vector<BodyState> bodies{placed(1, 0.0, 0.1), placed(77, 0.0, 0.1)};
  const WrenchResponse before = response_to(handler, kNow, bodies);
  EXPECT_EQ(before.bodies[0].status, BodyStatus::kNoSea);
  EXPECT_EQ(before.bodies[0].force, (std::array<double, 3>{}));
  EXPECT_EQ(before.bodies[1].status, BodyStatus::kUnknownBody);
  ASSERT_TRUE(handler.receive_sea(sea_bytes(kSwell, kNow)));
  EXPECT_EQ(response_to(handler, kNow - 1, bodies).bodies[0].status, BodyStatus::kNoSea);
  EXPECT_EQ(response_to(handler, kNow, bodies).bodies[0].status, BodyStatus::kOk);
  EXPECT_EQ(handler.counters().seas_received, 1);
}

TEST(RequestHandlerInWaves, EvaluatesAReceivedSeaAsTheScenes) {
  const Scene described = scene_of(boxes(kSwell));
  const Scene receiving = scene_of(boxes(kReceived));
  RequestHandler one(described);
  RequestHandler other(receiving);
  ASSERT_TRUE(other.receive_sea(sea_bytes(kSwell, 0)));
  const std::vector<BodyState> bodies{placed(1, 1.0, 0.1), placed(3, 900.0, -0.2)};
  const WrenchResponse a = response_to(one, kNow, bodies);
  const WrenchResponse b = response_to(other, kNow, bodies);
  for (std::size_t body = 0; body < 2; ++body) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a.bodies[body].force[i], b.bodies[body].force[i], 1e-3);
  }
}

TEST(RequestHandlerInWaves, ReplacesTheSeaFromItsTimeOn) {
  const Scene scene = scene_of(boxes(kReceived));
  RequestHandler handler(scene);
  const std::vector<BodyState> bodies{placed(1, 0.0, 0.1)};
  ASSERT_TRUE(handler.receive_sea(sea_bytes(kSwell, 0)));
  const BodyWrench swell = response_to(handler, 5'000'000, bodies).bodies[0];
  ASSERT_TRUE(handler.receive_sea(sea_bytes("", 6'000'000)));
  EXPECT_TRUE(same_wrench(response_to(handler, 5'000'000, bodies).bodies[0], swell));
  const BodyWrench still = response_to(handler, 6'000'000, bodies).bodies[0];
  EXPECT_NEAR(still.force[0], 0.0, 1e-9) << "a sea without amplitude is water at rest";
  // The sender starts over.
  ASSERT_TRUE(handler.receive_sea(sea_bytes("", 1'000'000)));
  EXPECT_TRUE(same_wrench(response_to(handler, 5'000'000, bodies).bodies[0], still));
}

TEST(RequestHandlerInWaves, RejectsASeaThatCannotBeUsed) {
  const Scene scene = scene_of(boxes(kReceived));
  RequestHandler handler(scene);
  ASSERT_TRUE(handler.receive_sea(sea_bytes(kSwell, 0)));
  ByteVector bytes = sea_bytes(kSwell, 0);
  bytes.pop_back();
  const Expected<void> cut = handler.receive_sea(bytes);
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().message(), HasSubstr("sea_state_t"));
  EXPECT_EQ(handler.counters().seas_rejected, 1);
  EXPECT_EQ(response_to(handler, kNow, {placed(1, 0.0, 0.1)}).bodies[0].status, BodyStatus::kOk);
}

// A received sea is the same sea in another scene only where that has the same water.
TEST(RequestHandlerInWaves, KeepsReceivedSeasOnAReload) {
  const Scene before = scene_of(boxes(kReceived));
  const std::vector<BodyState> bodies{placed(1, 0.0, 0.1)};
  for (const auto& [kept, world, water] : {std::tuple{true, "", ""},
                                           {true, "", "level = 1.0\n"},
                                           {false, "", "density = 1000.0\n"},
                                           {false, "[world]\ngravity = 9.8\n", ""},
                                           {false, "[world]\nup = [0, 0.001, 1]\n", ""},
                                           {false, "", "current = { velocity = [0, 0.1, 0] }\n"}}) {
    const Scene after = scene_of(world + boxes(water + kReceived));
    RequestHandler handler(before);
    ASSERT_TRUE(handler.receive_sea(sea_bytes(kSwell, 0)));
    const BodyWrench first = response_to(handler, kNow, bodies).bodies[0];
    handler.set_scene(after);
    const BodyWrench again = response_to(handler, kNow, bodies).bodies[0];
    EXPECT_EQ(again.status, kept ? BodyStatus::kOk : BodyStatus::kNoSea) << world << water;
    if (kept) {
      EXPECT_TRUE(same_wrench(again, first)) << "the level is that of the message";
    }
    // Into a scene with a sea of its own, and back.
    const Scene described = scene_of(boxes(kSwell));
    handler.set_scene(described);
    EXPECT_EQ(response_to(handler, kNow, bodies).bodies[0].status, BodyStatus::kOk);
    handler.set_scene(before);
    EXPECT_EQ(response_to(handler, kNow, bodies).bodies[0].status, BodyStatus::kNoSea);
  }
}

}  // namespace
}  // namespace buoyancy
