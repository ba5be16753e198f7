// Requests about bodies whose compartments and tanks change during the run.
#include <array>
#include <limits>
#include <new>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/reply.h"
#include "tests/support/allocation_count.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

BodyState tilted(std::int32_t id) {
  BodyState state = upright(id, 0.2);
  state.quaternion_wxyz = {0.96, 0.28, 0.0, 0.0};
  return state;
}

ByteVector request(std::int64_t utime, std::int64_t seq, const std::vector<std::int32_t>& ids = {1, 2, 3}) {
  std::vector<BodyState> states;
  for (const std::int32_t id : ids) states.push_back(tilted(id));
  return request_bytes({.utime = utime, .session_id = 1, .seq = seq}, states);
}

Expected<void> receive(RequestHandler& handler, const ConditionChange& change) {
  return handler.receive_condition(encoded(change));
}

TEST(RequestHandlerWithConditions, RespondsAsForTheSceneWithThisCondition) {
  const Scene scene = scene_of(damaged_boxes());
  const Scene damaged =
      scene_of(damaged_boxes({.bow_flooded = "1", .stern_flooded = "0.25", .ballast = "fill = 0.75"}));
  RequestHandler handler(scene);
  RequestHandler undamaged(scene);
  RequestHandler expected(damaged);
  const Reply before = reply_to(handler, request(99, 1));
  ASSERT_TRUE(receive(handler, flooded(100, 0, 1.0)));
  ASSERT_TRUE(receive(handler, filled(100, 0, 0.75)));
  EXPECT_EQ(reply_to(handler, request(100, 2)), reply_to(expected, request(100, 2)));
  EXPECT_EQ(reply_to(handler, request(99, 3)), reply_to(undamaged, request(99, 3)));
  EXPECT_NE(response_of(reply_to(handler, request(100, 4))).bodies[0].force,
            response_of(before).bodies[0].force);
  EXPECT_EQ(response_of(reply_to(handler, request(100, 5))).bodies[1].force,
            response_of(before).bodies[1].force)
      << "of a body without compartments";
  EXPECT_EQ(handler.counters().conditions_received, 2);
}

TEST(RequestHandlerWithConditions, MovesThePistonOfATank) {
  const std::string piston = "surface = \"none\"\nfill_axis = \"x\"\nfill = ";
  const Scene scene = scene_of(damaged_boxes({.ballast = piston + "0.25"}));
  const Scene pumped = scene_of(damaged_boxes({.ballast = piston + "0.75"}));
  RequestHandler handler(scene);
  RequestHandler expected(pumped);
  ASSERT_TRUE(receive(handler, filled(100, 0, 0.75)));
  EXPECT_EQ(reply_to(handler, request(100, 1)), reply_to(expected, request(100, 1)));
}

TEST(RequestHandlerWithConditions, EvaluatesAnewOnlyTheBodiesThatChange) {
  const Scene scene = scene_of(damaged_boxes());
  RequestHandler handler(scene);
  reply_to(handler, request(0, 1));
  ASSERT_TRUE(receive(handler, flooded(100, 0, 1.0)));
  reply_to(handler, request(1, 2));
  EXPECT_EQ(handler.counters().bodies_unchanged, 3) << "before it holds";
  reply_to(handler, request(100, 3));
  EXPECT_EQ(handler.counters().bodies_unchanged, 5) << "body 1 is computed";
  EXPECT_EQ(handler.counters().hydrostatics, 2) << "and so are its hydrostatics";
  ASSERT_TRUE(receive(handler, flooded(200, 0, 1.0)));
  reply_to(handler, request(200, 4));
  EXPECT_EQ(handler.counters().bodies_unchanged, 8) << "it is the condition that held";
}

TEST(RequestHandlerWithConditions, GivesABodyNoWrenchWhereItsConditionIsUnknown) {
  const Scene scene = scene_of(damaged_boxes());
  for (const bool named : {true, false}) {
    RequestHandler handler(scene);
    const Reply before = reply_to(handler, request(50, 1));
    ASSERT_FALSE(receive(handler, named ? flooded(100, 1, kNaN) : flooded(100, 7, 0.5)));
    EXPECT_EQ(response_of(reply_to(handler, request(99, 2))).bodies[0].status, BodyStatus::kOk);
    const Reply unknown = reply_to(handler, request(100, 3, {1, 2, 3, 1}));
    for (const std::size_t i : {0U, 3U}) {
      const BodyWrench wrench = response_of(unknown).bodies[i];
      EXPECT_EQ(wrench.status, BodyStatus::kBadCondition);
      EXPECT_EQ(wrench.force, (std::array<double, 3>{}));
      EXPECT_EQ(wrench.force_error_bound, 0.0);
    }
    for (const std::size_t i : {1U, 2U}) {
      EXPECT_EQ(response_of(unknown).bodies[i].force, response_of(before).bodies[i].force);
    }
    const auto hydrostatics = decoded<BodiesHydrostatics>(unknown.hydrostatics);
    EXPECT_EQ(hydrostatics.bodies.at(0).status, BodyStatus::kBadCondition);
    EXPECT_EQ(hydrostatics.bodies.at(0).submerged_volume, 0.0);
    EXPECT_EQ(decoded<BodiesLoads>(unknown.loads).bodies.at(0).status, BodyStatus::kBadCondition);
    EXPECT_EQ(handler.counters().bodies[static_cast<std::size_t>(BodyStatus::kBadCondition)], 2);
    EXPECT_EQ(handler.counters().conditions_rejected, 1);

    ASSERT_TRUE(receive(handler, flooded(200, 1, 0.25)));
    EXPECT_EQ(response_of(reply_to(handler, request(199, 4))).bodies[0].status, BodyStatus::kBadCondition);
    EXPECT_EQ(response_of(reply_to(handler, request(200, 5))).bodies[0].force,
              response_of(before).bodies[0].force);
    EXPECT_EQ(handler.counters().conditions_received, 1);
  }
}

TEST(RequestHandlerWithConditions, AnswersARetryWithTheSameBytes) {
  const Scene scene = scene_of(damaged_boxes());
  RequestHandler handler(scene);
  const Reply first = reply_to(handler, request(100, 1));
  ASSERT_TRUE(receive(handler, flooded(0, 0, 1.0)));
  EXPECT_EQ(reply_to(handler, request(100, 1)), first);
  EXPECT_NE(reply_to(handler, request(100, 2)).response, first.response);
}

TEST(RequestHandlerWithConditions, KeepsConditionsWithTheSceneWhereItemsRemain) {
  const Scene scene = scene_of(damaged_boxes());
  const Scene reloaded = scene_of(damaged_boxes({.bow_flooded = "0.5", .stern_flooded = "0.75"}));
  const Scene as_received = scene_of(damaged_boxes({.bow_flooded = "1", .stern_flooded = "0.75"}));
  const Scene plain = scene_of("[[body]]\nid = 1\nshape = { type = \"box\" }\n");
  RequestHandler handler(scene);
  RequestHandler expected(as_received);
  ASSERT_TRUE(receive(handler, flooded(100, 0, 1.0)));
  reply_to(handler, request(100, 1));
  handler.set_scene(reloaded);
  EXPECT_EQ(reply_to(handler, request(100, 2)), reply_to(expected, request(100, 2)));
  handler.set_scene(plain);
  EXPECT_EQ(response_of(reply_to(handler, request(100, 3, {1}))).bodies[0].status, BodyStatus::kOk);
  EXPECT_FALSE(receive(handler, flooded(0, 0, 1.0)));
  handler.set_scene(scene);
  RequestHandler fresh(scene);
  EXPECT_EQ(reply_to(handler, request(100, 4)), reply_to(fresh, request(100, 4))) << "begins anew";
}

TEST(RequestHandlerWithConditions, KeepsSceneAndConditionsWhereMemoryEnds) {
  const Scene scene = scene_of(damaged_boxes());
  const Scene larger = scene_of(damaged_boxes() + "[[body]]\nid = 9\nshape = { type = \"box\" }\n");
  const auto flooded_handler = [](const Scene& of) {
    RequestHandler handler(of, {.threads = 1});
    EXPECT_TRUE(receive(handler, flooded(100, 0, 1.0)));
    return handler;
  };
  RequestHandler expected = flooded_handler(scene);
  RequestHandler expected_in_larger = flooded_handler(larger);
  const ByteVector asked = request(100, 1, {1, 2, 3, 9});
  bool has_failed = true;
  std::int64_t n = 1;
  for (; has_failed; ++n) {
    RequestHandler handler = flooded_handler(scene);
    {
      const FailingAllocation failing(n);
      try {
        handler.set_scene(larger);
      } catch (const std::bad_alloc&) {
      }
      has_failed = failing.has_failed();
    }
    ASSERT_EQ(reply_to(handler, asked), reply_to(has_failed ? expected : expected_in_larger, asked)) << n;
  }
  EXPECT_GT(n, 5);
}

TEST(RequestHandlerWithConditions, FollowsConditionsThatAreReplaced) {
  const Scene scene = scene_of(damaged_boxes());
  RequestHandler handler(scene);
  RequestHandler fresh(scene);
  ASSERT_TRUE(receive(handler, flooded(0, 0, 1.0)));
  ASSERT_FALSE(receive(handler, filled(0, 0, -1.0, 3)));
  reply_to(handler, request(1, 1));
  handler.set_conditions(ConditionTimeline(scene));
  EXPECT_EQ(reply_to(handler, request(1, 2)), reply_to(fresh, request(1, 2)));
}

TEST(RequestHandlerWithConditions, DoesNotAllocateAfterWarmUp) {
  const Scene scene = scene_of(damaged_boxes());
  RequestHandler handler(scene, {.threads = 1});
  constexpr std::int64_t kSteps = 3 * ConditionHistory::kMaxChanges;
  std::vector<ByteVector> requests;
  std::vector<ByteVector> conditions;
  for (std::int64_t i = 0; i < kSteps; ++i) {
    const double share = 0.5 + 0.25 * static_cast<double>(i % 2);
    requests.push_back(request(i, i));
    conditions.push_back(encoded(i % 3 == 0 ? filled(i, 0, share) : flooded(i, 0, share)));
  }
  const auto run = [&] {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      ASSERT_TRUE(handler.receive_condition(conditions[i]));
      ASSERT_FALSE(handler.handle(requests[i]).empty());
      ASSERT_FALSE(handler.last_hydrostatics().empty());
    }
  };
  run();
  const AllocationCount allocations;
  run();
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_GT(handler.counters().hydrostatics, kSteps);
}

}  // namespace
}  // namespace buoyancy
