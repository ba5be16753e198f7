// Requests about scenes whose sea comes on grids, and the timeline of these grids.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "engine/request_handler.h"
#include "messages/conversions.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/grid_bytes.h"
#include "tests/engine/reply.h"
#include "tests/support/allocation_count.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
const std::string kGrid = "[water]\nwaves = \"grid\"\n";

std::string bodies(const std::string& more = "") {
  return "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1], segments = [4, 4, 4] }\n" + more +
         "[[body]]\nid = 2\nshape = { type = \"rock\", radius = 0.6, frequency = 6, seed = 2 }\n";
}

BodyState placed(std::int32_t id, double x, double y, double z) {
  BodyState state;
  state.body_id = id;
  state.position = {x, y, z};
  state.quaternion_wxyz = {0.8, 0.6, 0.0, 0.0};
  return state;
}

ByteVector request(std::int64_t utime, std::vector<BodyState> states, double lead_time = 0.0) {
  static std::int64_t seq = 0;
  return request_bytes({utime, 1, ++seq}, std::move(states), lead_time);
}

BodyWrench wrench_of(RequestHandler& handler, std::int64_t utime, const BodyState& state,
                     double lead_time = 0.0) {
  return decoded<WrenchResponse>(handler.handle(request(utime, {state}, lead_time))).bodies.at(0);
}

SeaGridHeader at(std::int64_t utime, SeaGridHeader header = kGridAroundOrigin) {
  header.utime = utime;
  return header;
}

void expect_within_bounds(const BodyWrench& a, const BodyWrench& b, double margin = 1e-6) {
  ASSERT_EQ(a.status, BodyStatus::kOk);
  ASSERT_EQ(b.status, BodyStatus::kOk);
  EXPECT_LE((to_vec3(a.force) - to_vec3(b.force)).norm(), a.force_error_bound + b.force_error_bound + margin);
  EXPECT_LE((to_vec3(a.torque) - to_vec3(b.torque)).norm(),
            a.torque_error_bound + b.torque_error_bound + margin);
}

const auto kFlat = [](double, double) { return 0.0; };
const auto kSlope = [](double x1, double x2) { return 0.1 * x1 - 0.05 * x2; };
const auto kHump = [](double x1, double x2) { return 0.3 * std::exp(-0.1 * (x1 * x1 + x2 * x2)); };

// Each grid holds between those beside it, of the same sender: a model that keeps everything.
RC_GTEST_PROP(SeaTimeline, InterpolatesBetweenTheGridsOfASender, ()) {
  static const Scene scene = scene_of(kGrid + bodies());
  SeaTimeline timeline(scene);
  std::map<std::int64_t, double> kept;
  std::int64_t sender = 0;
  const auto count = *rc::gen::inRange(0, 40);
  for (int n = 0; n < count; ++n) {
    SeaGridHeader header = at(*rc::gen::inRange<std::int64_t>(-30, 30));
    header.instance_id = *rc::gen::weightedElement<std::int64_t>({{9, 1}, {1, 2}});
    header.level = *rc::gen::inRange(-2, 3);
    const double elevation = *rc::gen::inRange(-3, 4);
    RC_ASSERT(
        timeline.receive(grid_bytes(header, [=](double, double) { return elevation; }), scene).has_value());
    if (std::exchange(sender, header.instance_id) != header.instance_id) kept.clear();
    kept[header.utime] = header.level + elevation;
    if (kept.size() > SeaTimeline::kMaxSeas) kept.erase(kept.begin());
  }
  for (std::int64_t utime = -31; utime <= 30; ++utime) {
    const std::shared_ptr<const SeaPeriod>* const period = timeline.at(utime);
    const auto after = kept.lower_bound(utime);
    const bool known = after != kept.end() && (after->first == utime || after != kept.begin());
    RC_ASSERT((period != nullptr) == known);
    if (!known) continue;
    double expected = after->second;
    if (after->first != utime) {
      const auto before = std::prev(after);
      const auto share =
          static_cast<double>(utime - before->first) / static_cast<double>(after->first - before->first);
      expected = (1.0 - share) * before->second + share * after->second;
    }
    const SeaAtTime now(*(*period)->sea, utime);
    RC_ASSERT(std::abs((*period)->water.level + now.elevation(1.0, 2.0) - expected) < 1e-12);
    RC_ASSERT((*period)->water.level == (*period)->sea->water().level);
  }
}

TEST(SeaTimeline, FindsGridsAtTheTimeOfThePose) {
  const Scene scene = scene_of(kGrid + bodies());
  SeaTimeline timeline(scene);
  for (const std::int64_t utime : {kNow, kNow + 20'000}) {
    ASSERT_TRUE(timeline.receive(grid_bytes(at(utime), kFlat), scene));
  }
  EXPECT_NE(timeline.at(kNow - 10'000, 0.01), nullptr);
  EXPECT_EQ(timeline.at(kNow - 10'000, 0.0), nullptr);
  EXPECT_NE(timeline.at(kNow, 0.02), nullptr);
  EXPECT_EQ(timeline.at(kNow, 0.020'001), nullptr);
  EXPECT_NE(timeline.at(kNow, std::nan("")), nullptr);
  for (const double far : {1e300, -1e300}) EXPECT_EQ(timeline.at(kNow, far), nullptr);
}

TEST(RequestHandlerOnGrids, EqualsWaterAtRestOverALevelPlane) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler on_grid(scene);
  SeaGridHeader header = at(kNow);
  header.level = 7.5;
  ASSERT_TRUE(on_grid.receive_sea(grid_bytes(header, [](double, double) { return 0.25; })));
  const Scene still = scene_of("[water]\nlevel = 7.75\n" + bodies("tolerance = 1e-3\n"));
  RequestHandler at_rest(still);
  for (const double height : {0.3, 0.0, -0.4, -3.0, 2.0}) {
    const BodyState state = placed(1, 0.4, -1.0, 7.75 + height);
    expect_within_bounds(wrench_of(on_grid, kNow, state), wrench_of(at_rest, kNow, state));
  }
}

// The spline's error at the surface is at most 10.2 H (h / lambda)^4 away from edges.
TEST(RequestHandlerOnGrids, IsWithinTheInterpolationErrorOfAComponentSea) {
  constexpr double kHeight = 0.4;
  constexpr double kLength = 6.0;
  constexpr double kWaveNumber = 2.0 * std::numbers::pi / kLength;
  const double period = 2.0 * std::numbers::pi / std::sqrt(kStandardGravity * kWaveNumber);
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler on_grid(scene);
  ASSERT_TRUE(on_grid.receive_sea(
      grid_bytes(at(0), [=](double x1, double) { return 0.5 * kHeight * std::cos(kWaveNumber * x1); })));
  const Scene described = scene_of(
      "[water]\nwave_pressure = \"hydrostatic\"\nwaves = { type = \"regular\", height = 0.4, period = " +
      std::to_string(period) + " }\n" + bodies());
  RequestHandler of_components(described);
  const double surface_error = 10.2 * kHeight * std::pow(0.5 / kLength, 4) + 1e-5;
  for (const double x : {-2.0, 0.0, 1.3}) {
    const BodyState state = placed(1, x, 0.5, 0.1);
    // No more than the area of the box is wet.
    const double margin = kSeawaterDensity * kStandardGravity * 6.0 * surface_error;
    expect_within_bounds(wrench_of(on_grid, 0, state), wrench_of(of_components, 0, state), margin);
  }
}

TEST(RequestHandlerOnGrids, EqualsTheMeanOfTwoGridsBetweenThem) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler between(scene);
  SeaGridHeader later = at(kNow + 16'666);
  later.level = -0.25;
  ASSERT_TRUE(between.receive_sea(grid_bytes(at(kNow), kSlope)));
  ASSERT_TRUE(between.receive_sea(grid_bytes(later, kHump)));
  RequestHandler of_mean(scene);
  ASSERT_TRUE(of_mean.receive_sea(grid_bytes(
      at(kNow + 8'333), [](double x1, double x2) { return 0.5 * (kSlope(x1, x2) + kHump(x1, x2) - 0.25); })));
  for (const std::int32_t id : {1, 2}) {
    const BodyState state = placed(id, 0.5, -1.0, 0.05);
    expect_within_bounds(wrench_of(between, kNow + 8'333, state), wrench_of(of_mean, kNow + 8'333, state),
                         1e-2);
  }
}

TEST(RequestHandlerOnGrids, RepeatsAfterAPeriod) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  SeaGridHeader header = at(kNow);
  header.periodic = 1;
  const double period_1 = header.columns * header.spacing[0];
  const double period_2 = header.rows * header.spacing[1];
  ASSERT_TRUE(handler.receive_sea(grid_bytes(header, [&](double x1, double x2) {
    return 0.3 * std::sin(2.0 * std::numbers::pi * (x1 / period_1 + 2.0 * x2 / period_2));
  })));
  const BodyWrench here = wrench_of(handler, kNow, placed(2, 0.5, -1.0, 0.05));
  for (const auto& [n1, n2] : {std::pair{1, 0}, {0, -1}, {-40, 25}}) {
    expect_within_bounds(wrench_of(handler, kNow, placed(2, 0.5 + n1 * period_1, -1.0 + n2 * period_2, 0.05)),
                         here);
  }
}

TEST(RequestHandlerOnGrids, AnswersARetryOnceTheGridsAreThere) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  const ByteVector bytes = request(kNow + 10, {placed(1, 0.0, 0.0, 0.1), placed(77, 0.0, 0.0, 0.1)});
  const ByteVector first = copy_of(handler.handle(bytes));
  const auto before = decoded<WrenchResponse>(first);
  EXPECT_EQ(before.bodies[0].status, BodyStatus::kNoSea);
  EXPECT_EQ(before.bodies[0].force, (std::array<double, 3>{}));
  EXPECT_EQ(before.bodies[1].status, BodyStatus::kUnknownBody);
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kHump)));
  EXPECT_TRUE(handler.is_retry(1, bytes));
  EXPECT_EQ(copy_of(handler.handle(bytes)), first) << "one grid is not enough";
  EXPECT_EQ(handler.counters().retries, 1);
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow + 20), kHump)));
  EXPECT_FALSE(handler.is_retry(1, bytes));
  const ByteVector computed = copy_of(handler.handle(bytes));
  EXPECT_EQ(decoded<WrenchResponse>(computed).bodies[0].status, BodyStatus::kOk);
  EXPECT_EQ(handler.counters().computed, 2);
  EXPECT_EQ(handler.counters().conflicting_retries, 0);
  // From then on the response stays.
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow + 20), kSlope)));
  EXPECT_EQ(copy_of(handler.handle(bytes)), computed);
  EXPECT_EQ(handler.counters().seas_received, 3);
}

TEST(RequestHandlerOnGrids, GivesABodyThatLeavesTheGridAStatus) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kHump)));
  for (const auto& [x, y, status] : {std::tuple{7.0, 0.0, BodyStatus::kOk},
                                     {7.6, 0.0, BodyStatus::kOutOfRange},
                                     {0.0, 8.1, BodyStatus::kOutOfRange},
                                     {0.0, -7.0, BodyStatus::kOutOfRange},
                                     {1e9, 0.0, BodyStatus::kOutOfRange}}) {
    for (const double height : {0.1, 50.0, -50.0}) {
      const BodyWrench wrench = wrench_of(handler, kNow, placed(1, x, y, height));
      EXPECT_EQ(wrench.status, status) << x << ", " << y << ", " << height;
      if (status != BodyStatus::kOk) {
        EXPECT_EQ(wrench.force, (std::array<double, 3>{}));
      }
    }
  }
}

TEST(RequestHandlerOnGrids, RejectsAGridThatCannotBeUsed) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kHump)));
  const BodyState state = placed(1, 0.0, 0.0, 0.1);
  const BodyWrench before = wrench_of(handler, kNow, state);
  ByteVector cut = grid_bytes(at(kNow), kSlope);
  cut.pop_back();
  SeaGridHeader no_spacing = at(kNow);
  no_spacing.spacing[1] = 0.0;
  const ByteVector other_type = request(kNow, {});
  std::int64_t rejected = 0;
  for (const auto& [bytes, text] :
       {std::pair{cut, "sea_grid_t"},
        {other_type, "sea_grid_t"},
        {grid_bytes(no_spacing, kFlat), "spacing[1] = 0"},
        {grid_bytes(at(kNow), [](double, double) { return 1001.0; }), "elevation[0][0] = 1001"},
        {grid_bytes(at(kNow), [](double x1, double) { return std::sqrt(x1); }), "elevation[0][0] = "}}) {
    const Expected<void> received = handler.receive_sea(bytes);
    ASSERT_FALSE(received) << text;
    EXPECT_THAT(received.error().message(), HasSubstr(text));
    EXPECT_EQ(handler.counters().seas_rejected, ++rejected);
  }
  EXPECT_EQ(wrench_of(handler, kNow, state).force, before.force);
}

TEST(RequestHandlerOnGrids, StartsAfreshForANewSender) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(10), kHump)));
  SeaGridHeader restarted = at(20);
  ++restarted.instance_id;
  ASSERT_TRUE(handler.receive_sea(grid_bytes(restarted, kHump)));
  const BodyState state = placed(1, 0.0, 0.0, 0.1);
  EXPECT_EQ(wrench_of(handler, 10, state).status, BodyStatus::kNoSea);
  EXPECT_EQ(wrench_of(handler, 15, state).status, BodyStatus::kNoSea);
  EXPECT_EQ(wrench_of(handler, 20, state).status, BodyStatus::kOk);
}

TEST(RequestHandlerOnGrids, KeepsTheNewestGridsOfASender) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene);
  constexpr auto kMax = static_cast<std::int64_t>(SeaTimeline::kMaxSeas);
  // The first one comes late.
  for (std::int64_t n = 1; n <= kMax; ++n) ASSERT_TRUE(handler.receive_sea(grid_bytes(at(10 * n), kHump)));
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(0), kHump)));
  const BodyState state = placed(1, 0.0, 0.0, 0.1);
  for (const auto& [utime, status] : {std::pair<std::int64_t, BodyStatus>{0, BodyStatus::kNoSea},
                                      {9, BodyStatus::kNoSea},
                                      {10, BodyStatus::kOk},
                                      {10 * kMax, BodyStatus::kOk},
                                      {10 * kMax + 1, BodyStatus::kNoSea}}) {
    EXPECT_EQ(wrench_of(handler, utime, state).status, status) << utime;
  }
}

TEST(RequestHandlerOnGrids, KeepsReceivedGridsOnAReload) {
  const Scene before = scene_of(kGrid + bodies());
  const BodyState state = placed(1, 0.0, 0.0, 0.1);
  for (const auto& [kept, head] : {std::pair{true, kGrid},
                                   {false, std::string("[water]\nwaves = \"received\"\n")},
                                   {false, kGrid + "density = 1000\n"}}) {
    const Scene after = scene_of(head + bodies());
    RequestHandler handler(before);
    ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kHump)));
    const BodyWrench first = wrench_of(handler, kNow, state);
    handler.set_scene(after);
    const BodyWrench again = wrench_of(handler, kNow, state);
    EXPECT_EQ(again.status, kept ? BodyStatus::kOk : BodyStatus::kNoSea);
    if (kept) {
      EXPECT_EQ(again.force, first.force);
    }
    if (!after.receives_grids()) continue;
    // The water of the new scene counts.
    ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kHump)));
    RequestHandler fresh(after);
    ASSERT_TRUE(fresh.receive_sea(grid_bytes(at(kNow), kHump)));
    EXPECT_EQ(wrench_of(handler, kNow, state).force, wrench_of(fresh, kNow, state).force);
  }
}

// The velocity of the water is that of the surface between two grids, and the current.
TEST(RequestHandlerOnGrids, AppliesDragRelativeToTheMovingSurface) {
  const Scene scene =
      scene_of(kGrid + "current = { velocity = [0.5, 0, 0] }\n" +
               bodies("outputs = [\"wrench\", \"loads\"]\n[body.drag]\nlinear = [20, 20, 20, 5, 5, 5]\n"));
  RequestHandler handler(scene);
  const auto water_velocity = [&](std::int64_t utime) {
    const ByteVector bytes = request(utime, {placed(1, 0.5, 1.0, -0.2)});
    EXPECT_EQ(decoded<WrenchResponse>(handler.handle(bytes)).bodies[0].status, BodyStatus::kOk);
    return to_vec3(decoded<BodiesLoads>(handler.last_loads()).bodies.at(0).water_velocity);
  };
  ASSERT_TRUE(handler.receive_sea(grid_bytes(at(kNow), kSlope)));
  EXPECT_EQ(water_velocity(kNow), Vec3(0.5, 0.0, 0.0)) << "of one grid, the surface is at rest";
  SeaGridHeader later = at(kNow + 100'000);
  later.level = 0.02;
  ASSERT_TRUE(handler.receive_sea(grid_bytes(later, kFlat)));
  const double rise = (0.02 - kSlope(0.5, 1.0)) / 0.1;
  for (const std::int64_t utime : {kNow + 1, kNow + 50'000, kNow + 100'000}) {
    EXPECT_NEAR((water_velocity(utime) - Vec3(0.5, 0.0, rise)).norm(), 0.0, 1e-6) << utime - kNow;
  }
  EXPECT_EQ(water_velocity(kNow), Vec3(0.5, 0.0, 0.0));
}

TEST(RequestHandlerOnGrids, AllocatesNothingOnceItsMemoryIsWarm) {
  const Scene scene = scene_of(kGrid + bodies());
  RequestHandler handler(scene, {.threads = 1});  // each thread has buffers of its own
  std::vector<ByteVector> grids, requests;
  constexpr std::int64_t kWarm = 40;
  for (std::int64_t n = 0; n < 2 * kWarm; ++n) {
    grids.push_back(
        grid_bytes(at(1'000 * n), n % 2 == 0 ? std::function<double(double, double)>(kHump) : kSlope));
    requests.push_back(
        request(1'000 * n - (n > 0 ? 300 : 0), {placed(1, 0.0, 0.0, 0.1), placed(2, 0.2, 0.0, 0.0)}));
  }
  const auto receive = [&](std::int64_t begin, std::int64_t end) {
    for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
      ASSERT_TRUE(handler.receive_sea(grids[n]));
      ASSERT_FALSE(handler.handle(requests[n]).empty());
    }
  };
  receive(0, kWarm);
  const AllocationCount allocations;
  receive(kWarm, 2 * kWarm);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(handler.counters().bodies[static_cast<std::size_t>(BodyStatus::kOk)], 4 * kWarm);
}

}  // namespace
}  // namespace buoyancy
