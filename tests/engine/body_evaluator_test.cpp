#include "engine/body_evaluator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#ifdef BUOYANCY_WITH_TBB
#include <tbb/global_control.h>
#endif

#include "tests/engine/box_scene.h"
#include "tests/engine/evaluate.h"
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
  evaluate_all(evaluator, make_request(bodies), wrenches, counters);
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
  evaluate_all(evaluator, make_request({placed(kBox, 0.1, 0.2), placed(kFastBox, 0.3)}), first, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0);
  evaluate_all(evaluator, make_request({placed(kFastBox, 0.2), placed(kBox, 0.1, 0.2)}), second, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1);
  EXPECT_TRUE(equal_wrenches(first[0], second[1]));
  EXPECT_EQ(counters.bodies_crossing, 4) << "an unchanged body is counted by its immersion, too";

  // The next representable height is another pose.
  evaluate_all(evaluator, make_request({placed(kBox, std::nextafter(0.1, 1.0), 0.2)}), second, counters);
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
  evaluate_all(evaluator, make_request({rising}, 0.5), wrenches, counters);
  evaluate_all(evaluator, make_request({rising}, 0.25), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0) << "another lead time is another pose";
  evaluate_all(evaluator, make_request({placed(kBox, 0.125)}), wrenches, counters);
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
  evaluate_all(evaluator, make_request({placed(1, 0.1)}), wrenches, counters);
  evaluate_all(evaluator, make_request({placed(1, std::nan(""))}), wrenches, counters);
  EXPECT_EQ(wrenches[0].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(wrenches[0].force, (std::array<double, 3>{}));
  evaluate_all(evaluator, make_request({placed(1, 0.1)}), wrenches, counters);
  EXPECT_EQ(wrenches[0].status, BodyStatus::kOk);
  EXPECT_GT(wrenches[0].force[2], 0.0);
}

TEST(BodyEvaluator, ComputesRepeatedBodyForEachPose) {
  const Scene scene = box_scene();
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  evaluate_all(evaluator, make_request({placed(kBox, 0.1), placed(kBox, 0.2)}), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 0);
  EXPECT_GT(wrenches[0].submerged_volume, wrenches[1].submerged_volume);
  evaluate_all(evaluator, make_request({placed(kBox, 0.2)}), wrenches, counters);
  EXPECT_EQ(counters.bodies_unchanged, 1);
}

// Enough bodies that several threads share all parts of the work, in another order than the scene's, with
// unknown bodies, invalid poses and bodies that occur more than once.
std::vector<BodyState> many_states(int bodies, int step) {
  std::vector<BodyState> states;
  for (int i = 0; i < bodies; ++i) {
    const int id = 1 + static_cast<int>(std::int64_t{i} * 1'237 % bodies);  // a permutation
    states.push_back(placed(id, 3.0 * std::sin(0.7 * id + 0.1 * step), 0.05 * id));
    if (i % 97 == 0) states.push_back(placed(bodies + id, 0.0));
    if (i % 89 == 0) states.push_back(placed(id, std::nan("")));
    if (i % 83 == 0) states.push_back(placed(1 + i / 2, 0.2 * std::sin(0.3 * i), 0.1 * step));
  }
  return states;
}

TEST(BodyEvaluator, GivesManyBodiesSameBitsOnAnyNumberOfThreads) {
#ifdef BUOYANCY_WITH_TBB
  const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 8);
#endif
  for (const auto& [method, bodies, frequency] :
       {std::tuple{"hierarchical", 3'000, 3}, {"exact", 200, 8}, {"exact_surface", 200, 8}}) {
    const Scene scene = rocks(bodies, frequency, method);
    std::vector<std::unique_ptr<BodyEvaluator>> evaluators;
    for (const unsigned threads : {1U, 2U, 8U}) {
      evaluators.push_back(std::make_unique<BodyEvaluator>(scene, threads));
    }
    for (int step = 0; step < 4; ++step) {
      // Two requests in turn, so that the evaluators' buffers hold older and longer requests.
      const WrenchRequest request = make_request(many_states(step % 2 == 0 ? bodies : bodies / 2, step / 2));
      std::vector<BodyWrench> expected;
      ServiceCounters expected_counters;
      for (const BodyState& state : request.bodies) {
        expected.push_back(evaluate_alone(scene, state, 0.0, expected_counters));
      }
      for (const auto& evaluator : evaluators) {
        ServiceCounters counters;
        std::vector<BodyWrench> wrenches;
        evaluate_all(*evaluator, request, wrenches, counters);
        ASSERT_TRUE(std::ranges::equal(wrenches, expected, equal_wrenches))
            << method << " on " << evaluator->thread_count() << " threads";
        EXPECT_EQ(counters.bodies, expected_counters.bodies);
        EXPECT_EQ(counters.bodies_dry, expected_counters.bodies_dry);
        EXPECT_EQ(counters.bodies_wet, expected_counters.bodies_wet);
        EXPECT_EQ(counters.bodies_crossing, expected_counters.bodies_crossing);
        EXPECT_EQ(counters.largest_dropped_force, expected_counters.largest_dropped_force);
        EXPECT_EQ(counters.largest_dropped_torque, expected_counters.largest_dropped_torque);
      }
    }
  }
}

TEST(BodyEvaluator, ReusesResultsOfManyUnmovedBodies) {
  constexpr int kBodies = 3'000;
  const Scene scene = rocks(kBodies, 3, "hierarchical");
  BodyEvaluator evaluator(scene, 0);
  std::vector<BodyState> states;
  for (int id = 1; id <= kBodies; ++id) states.push_back(placed(id, 3.0 * std::sin(0.7 * id), 0.05 * id));
  ServiceCounters first;
  ServiceCounters second;
  std::vector<BodyWrench> wrenches;
  std::vector<BodyWrench> again;
  evaluate_all(evaluator, make_request(states), wrenches, first);
  EXPECT_EQ(first.bodies_unchanged, 0);
  std::ranges::reverse(states);
  states[5].position[2] += 1.0;
  evaluate_all(evaluator, make_request(states), again, second);
  EXPECT_EQ(second.bodies_unchanged, kBodies - 1);
  std::ranges::reverse(again);
  again[kBodies - 6] = wrenches[kBodies - 6];
  EXPECT_TRUE(std::ranges::equal(wrenches, again, equal_wrenches));
}

}  // namespace
}  // namespace buoyancy
