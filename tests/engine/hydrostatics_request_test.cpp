// Tests the hydrostatics output: its values for one body, and its selection by the request handler.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "engine/body_evaluation.h"
#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/reply.h"

namespace buoyancy {
namespace {

BodyHydrostatics hydrostatics_of(const BodyState& state, double lead_time, BodyStatus status,
                                 ServiceCounters& counters) {
  const Body* body = shared_box_scene().find(state.body_id);
  return evaluate_hydrostatics(*body, shared_box_scene().water(), validate_pose(state, lead_time).pose,
                               status, counters);
}

TEST(EvaluateHydrostatics, MatchesClosedFormForHalfSubmergedBox) {
  ServiceCounters counters;
  const BodyHydrostatics found =
      hydrostatics_of(upright(kHydrostaticBox, 0.0), 0.0, BodyStatus::kOk, counters);
  EXPECT_EQ(found.body_id, kHydrostaticBox);
  EXPECT_EQ(found.status, BodyStatus::kOk);
  EXPECT_EQ(counters.hydrostatics, 1);
  EXPECT_NEAR(found.submerged_volume, 0.5, 1e-14);
  EXPECT_NEAR(found.wetted_area, 3.0, 1e-14);
  EXPECT_NEAR(found.waterplane_area, 1.0, 1e-14);
  const double radius = 1.0 / 12.0 / 0.5;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool up = i == 2;
    EXPECT_NEAR(found.center_of_buoyancy[i], up ? -0.25 : 0.0, 1e-14);
    EXPECT_NEAR(found.waterplane_centroid[i], 0.0, 1e-14);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(found.metacenters[axis][i], up ? radius - 0.25 : 0.0, 1e-13);
    }
  }
  // The principal axes of a square are arbitrary: any pair that is right-handed with up is valid.
  const auto& [first, second] = found.waterplane_axes;
  EXPECT_NEAR(first[0] * second[1] - first[1] * second[0], 1.0, 1e-14);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    EXPECT_EQ(found.waterplane_axes[axis][2], 0.0);
    EXPECT_NEAR(found.waterplane_second_moments[axis], 1.0 / 12.0, 1e-14);
    EXPECT_NEAR(found.metacentric_radii[axis], radius, 1e-13);
    EXPECT_NEAR(found.metacentric_heights[axis], radius - 0.25, 1e-13)
        << "centre of mass: the volume's centroid";
  }
  // About the corner (0.5, 0.5, -0.5): a = (-0.5, -0.5), M = (-0.25, -0.25, 0.125).
  const std::array<std::array<double, 6>, 6> stiffness{{{0, 0, 0, 0, 0, 0},
                                                        {0, 0, 0, 0, 0, 0},
                                                        {0, 0, 1, -0.5, 0.5, 0},
                                                        {0, 0, -0.5, 1.0 / 3.0 + 0.125, -0.25, 0.25},
                                                        {0, 0, 0.5, -0.25, 1.0 / 3.0 + 0.125, 0.25},
                                                        {0, 0, 0, 0, 0, 0}}};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      EXPECT_NEAR(found.stiffness[row][column], kWeight * stiffness[row][column], 1e-13 * kWeight)
          << row << ", " << column;
    }
  }
}

TEST(EvaluateHydrostatics, UsesExtrapolatedPose) {
  ServiceCounters counters;
  BodyState rising = upright(kHydrostaticBox, -0.3);
  rising.linear_velocity = {0.0, 0.0, 0.5};
  const BodyHydrostatics found = hydrostatics_of(rising, 0.2, BodyStatus::kOk, counters);
  EXPECT_NEAR(found.submerged_volume, 0.7, 1e-14);
}

TEST(EvaluateHydrostatics, ReturnsStatusAndZerosForFailedBody) {
  ServiceCounters counters;
  const BodyHydrostatics found =
      hydrostatics_of(upright(kHydrostaticBox, 0.0), 0.0, BodyStatus::kBadQuaternion, counters);
  EXPECT_EQ(found.body_id, kHydrostaticBox);
  EXPECT_EQ(found.status, BodyStatus::kBadQuaternion);
  EXPECT_EQ(found.submerged_volume, 0.0);
  EXPECT_EQ(found.metacenters, BodyHydrostatics{}.metacenters);
  EXPECT_EQ(found.stiffness, BodyHydrostatics{}.stiffness);
  EXPECT_EQ(counters.hydrostatics, 0);
}

ByteVector request_without_hydrostatics(std::int64_t seq) {
  return request_bytes({.session_id = 1, .seq = seq}, {upright(kBox, 0.0)});
}

TEST(RequestHandler, ReturnsHydrostaticsInRequestedOrder) {
  RequestHandler handler(shared_box_scene());
  std::vector<BodyState> bodies{upright(kBox, 0.0), upright(kHydrostaticBox, 0.25), upright(kNoBody, 0.0),
                                upright(kHydrostaticBox, -0.25), upright(kHydrostaticBox, 0.0)};
  bodies.back().position[0] = std::numeric_limits<double>::quiet_NaN();
  handler.handle(request_bytes({.utime = 5, .session_id = 6, .seq = 7}, bodies));
  const BodiesHydrostatics found = decoded<BodiesHydrostatics>(handler.last_hydrostatics());
  EXPECT_EQ(found.id.utime, 5);
  EXPECT_EQ(found.id.session_id, 6);
  EXPECT_EQ(found.id.seq, 7);
  ASSERT_EQ(found.bodies.size(), 3U);
  for (const BodyHydrostatics& body : found.bodies) EXPECT_EQ(body.body_id, kHydrostaticBox);
  EXPECT_NEAR(found.bodies[0].submerged_volume, 0.25, 1e-14);
  EXPECT_NEAR(found.bodies[1].submerged_volume, 0.75, 1e-14);
  EXPECT_EQ(found.bodies[2].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(found.bodies[2].submerged_volume, 0.0);
  EXPECT_EQ(handler.counters().hydrostatics, 2);
}

TEST(RequestHandler, ReturnsNoHydrostaticsIfNoBodyHasThisOutput) {
  RequestHandler handler(shared_box_scene());
  EXPECT_TRUE(handler.last_hydrostatics().empty());
  const ByteVector with_hydrostatics =
      request_bytes({.session_id = 1, .seq = 1}, {upright(kHydrostaticBox, 0.0)});
  handler.handle(with_hydrostatics);
  EXPECT_FALSE(handler.last_hydrostatics().empty());
  handler.handle(request_without_hydrostatics(2));
  EXPECT_TRUE(handler.last_hydrostatics().empty());
  handler.handle(with_hydrostatics);
  handler.handle(request_without_hydrostatics(2));
  handler.handle(request_without_hydrostatics(2));
  EXPECT_EQ(handler.counters().retries, 1);
  EXPECT_TRUE(handler.last_hydrostatics().empty()) << "a retry";
  handler.handle(with_hydrostatics);
  handler.handle(ByteVector{1, 2, 3});
  EXPECT_TRUE(handler.last_hydrostatics().empty()) << "a rejected request";
  EXPECT_EQ(handler.counters().hydrostatics, 1) << "computed once for an unmoved body";
}

TEST(RequestHandler, ReturnsSameHydrostaticsForRetry) {
  RequestHandler handler(shared_box_scene());
  const auto make_request = [](std::int64_t session_id, double height) {
    return request_bytes({.session_id = session_id, .seq = 1}, {upright(kHydrostaticBox, height)});
  };
  handler.handle(make_request(1, 0.1));
  const ByteVector first = copy_of(handler.last_hydrostatics());
  for (std::int64_t other = 2; other < 20; ++other) handler.handle(make_request(other, 0.2));
  const std::int64_t computed = handler.counters().hydrostatics;
  handler.handle(make_request(1, 0.1));
  EXPECT_EQ(copy_of(handler.last_hydrostatics()), first);
  EXPECT_EQ(handler.counters().retries, 1);
  EXPECT_EQ(handler.counters().hydrostatics, computed);
}

TEST(RequestHandler, ReusesHydrostaticsOfUnmovedBody) {
  RequestHandler handler(shared_box_scene());
  const auto send_request = [&](std::int64_t seq, const std::vector<BodyState>& bodies) {
    handler.handle(request_bytes({.session_id = 1, .seq = seq}, bodies, 0.0));
    return decoded<BodiesHydrostatics>(handler.last_hydrostatics()).bodies;
  };
  const BodyState low = upright(kHydrostaticBox, 0.0);
  const BodyState high = upright(kHydrostaticBox, 0.2);
  const auto first = send_request(0, {low});
  const auto again = send_request(1, {upright(kBox, 0.1), low});
  EXPECT_EQ(handler.counters().hydrostatics, 1);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again[0].stiffness, first[0].stiffness);
  EXPECT_EQ(again[0].wetted_area, first[0].wetted_area);

  // Each state of a body that occurs twice gets its own hydrostatics.
  const auto both = send_request(2, {high, low});
  ASSERT_EQ(both.size(), 2U);
  EXPECT_NEAR(both[0].submerged_volume, 0.3, 1e-14);
  EXPECT_EQ(both[1].submerged_volume, first[0].submerged_volume);
}

}  // namespace
}  // namespace buoyancy
