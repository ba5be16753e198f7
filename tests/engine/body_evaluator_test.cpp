#include "engine/body_evaluator.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#ifdef BUOYANCY_WITH_TBB
#include <tbb/global_control.h>
#endif

#include "tests/engine/box_scene.h"
#include "tests/engine/evaluate_alone.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

BodyState placed(std::int32_t id, double height, double tilt = 0.0) {
  BodyState state;
  state.body_id = id;
  state.position = {0.0, 0.0, height};
  state.quaternion_wxyz = {std::cos(0.5 * tilt), std::sin(0.5 * tilt), 0.0, 0.0};
  return state;
}

WrenchRequest make_request(std::vector<BodyState> bodies, double lead_time = 0.0) {
  return {.id = {}, .lead_time = lead_time, .bodies = std::move(bodies)};
}

// Bodies 1 to count, all with one rock mesh.
Scene rocks(int count, int frequency, const std::string& method) {
  std::string text;
  for (int id = 1; id <= count; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) + "\nmethod = \"" + method +
            "\"\nshape = { type = \"rock\", radius = 1, frequency = " + std::to_string(frequency) + " }\n";
  }
  return scene_of(text);
}

bool equal_wrenches(const BodyWrench& a, const BodyWrench& b) {
  return a.body_id == b.body_id && a.status == b.status && a.force == b.force && a.torque == b.torque &&
         a.submerged_volume == b.submerged_volume && a.center_of_buoyancy == b.center_of_buoyancy;
}

TEST(BodyEvaluator, MatchesEvaluationOfEachBodyAlone) {
  const Scene scene = box_scene();
  BodyEvaluator evaluator(scene, 1);
  std::vector<BodyState> bodies;
  for (const std::int32_t id : {kBox, kNoBody, kFastBox, kHierarchicalBox, kOffsetBox, kBox}) {
    for (const double height : {-3.0, 0.1, 3.0, std::numeric_limits<double>::infinity()}) {
      bodies.push_back(placed(id, height, 0.3));
    }
  }
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  evaluator.evaluate_all(make_request(bodies), wrenches, counters);
  ServiceCounters expected;
  ASSERT_EQ(wrenches.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    EXPECT_TRUE(equal_wrenches(wrenches[i], evaluate_alone(scene, bodies[i], 0.0, expected))) << i;
  }
  EXPECT_EQ(counters.bodies, expected.bodies);
  EXPECT_EQ(counters.bodies_dry, expected.bodies_dry);
  EXPECT_EQ(counters.bodies_wet, expected.bodies_wet);
  EXPECT_EQ(counters.bodies_crossing, expected.bodies_crossing);
}

TEST(BodyEvaluator, ReusesAndCountsResultsOfUnmovedBodies) {
  const Scene scene = box_scene();
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> first;
  std::vector<BodyWrench> second;
  evaluator.evaluate_all(make_request({placed(kBox, 0.1, 0.2), placed(kFastBox, 0.3)}), first, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0);
  evaluator.evaluate_all(make_request({placed(kFastBox, 0.2), placed(kBox, 0.1, 0.2)}), second, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1);
  EXPECT_TRUE(equal_wrenches(first[0], second[1]));
  EXPECT_EQ(counters.bodies_crossing, 4) << "an unchanged body is counted by its immersion, too";

  // The next representable height is another pose.
  evaluator.evaluate_all(make_request({placed(kBox, std::nextafter(0.1, 1.0), 0.2)}), second, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1);
  EXPECT_LT(second[0].submerged_volume, first[0].submerged_volume);
}

TEST(BodyEvaluator, CachesByExtrapolatedPose) {
  const Scene scene = box_scene();
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  BodyState rising = placed(kBox, 0.0);
  rising.linear_velocity = {0.0, 0.0, 0.5};
  evaluator.evaluate_all(make_request({rising}, 0.5), wrenches, counters);
  evaluator.evaluate_all(make_request({rising}, 0.25), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0) << "another lead time is another pose";
  evaluator.evaluate_all(make_request({placed(kBox, 0.125)}), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1) << "the same pose, sent instead of extrapolated";
}

TEST(BodyEvaluator, RecoversAfterInvalidState) {
  const Scene scene = scene_of(R"(
    [[body]]
    id = 1
    shape = { type = "box", size = [1, 1, 1] }
    method = "exact"
)");
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  evaluator.evaluate_all(make_request({placed(1, 0.1)}), wrenches, counters);
  evaluator.evaluate_all(make_request({placed(1, std::nan(""))}), wrenches, counters);
  EXPECT_EQ(wrenches[0].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(wrenches[0].force, (std::array<double, 3>{}));
  evaluator.evaluate_all(make_request({placed(1, 0.1)}), wrenches, counters);
  EXPECT_EQ(wrenches[0].status, BodyStatus::kOk);
  EXPECT_GT(wrenches[0].force[2], 0.0);
}

TEST(BodyEvaluator, ComputesRepeatedBodyForEachPose) {
  const Scene scene = box_scene();
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  evaluator.evaluate_all(make_request({placed(kBox, 0.1), placed(kBox, 0.2)}), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0);
  EXPECT_GT(wrenches[0].submerged_volume, wrenches[1].submerged_volume);
  evaluator.evaluate_all(make_request({placed(kBox, 0.2)}), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1);
}

TEST(BodyEvaluator, IsBitIdenticalOnOneAndEightThreads) {
#ifdef BUOYANCY_WITH_TBB
  const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 8);
#endif
  for (const std::string method : {"hierarchical", "exact", "exact_surface"}) {
    const Scene scene = rocks(60, 12, method);
    BodyEvaluator alone(scene, 1);
    BodyEvaluator together(scene, 8);
    for (int step = 0; step < 20; ++step) {
      std::vector<BodyState> bodies;
      for (int id = 1; id <= 60; ++id) {
        bodies.push_back(placed(id, 1.3 * std::sin(0.7 * id + 0.1 * step), 0.05 * id));
      }
      ServiceCounters one;
      ServiceCounters eight;
      std::vector<BodyWrench> a;
      std::vector<BodyWrench> b;
      alone.evaluate_all(make_request(bodies), a, one);
      together.evaluate_all(make_request(bodies), b, eight);
      for (std::size_t i = 0; i < a.size(); ++i)
        ASSERT_TRUE(equal_wrenches(a[i], b[i])) << method << ", body " << i;
      EXPECT_EQ(one.bodies_crossing, eight.bodies_crossing);
      EXPECT_EQ(one.largest_dropped_force, eight.largest_dropped_force);
    }
  }
}

TEST(BodyEvaluator, CountsPiercingDryAndUnchangedBodies) {
  const Scene scene = rocks(1000, 4, "hierarchical");
  BodyEvaluator evaluator(scene, 0);
  std::vector<BodyState> bodies;
  for (int id = 1; id <= 1000; ++id) bodies.push_back(placed(id, id <= 10 ? 0.1 * id - 0.5 : 5.0));
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  evaluator.evaluate_all(make_request(bodies), wrenches, counters);
  EXPECT_EQ(counters.bodies_crossing, 10);
  EXPECT_EQ(counters.bodies_dry, 990);
  evaluator.evaluate_all(make_request(bodies), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1000);
}

}  // namespace
}  // namespace buoyancy
