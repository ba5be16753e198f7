#include "engine/body_evaluation.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/box_scene.h"
#include "tests/engine/evaluate.h"
#include "tests/engine/invalid_states.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
constexpr double kLargest = std::numeric_limits<double>::max();

BodyWrench evaluate(const BodyState& state, double lead_time = 0.0) {
  ServiceCounters counters;
  return evaluate_alone(shared_box_scene(), state, lead_time, counters);
}

void expect_zeros(const BodyWrench& wrench) {
  const std::array<double, 3> zeros{};
  EXPECT_EQ(wrench.force, zeros);
  EXPECT_EQ(wrench.torque, zeros);
  EXPECT_EQ(wrench.submerged_volume, 0.0);
  EXPECT_EQ(wrench.center_of_buoyancy, zeros);
  EXPECT_EQ(wrench.force_error_bound, 0.0);
  EXPECT_EQ(wrench.torque_error_bound, 0.0);
}

std::int64_t count(const ServiceCounters& counters, BodyStatus status) {
  return counters.bodies[static_cast<std::size_t>(status)];
}

std::int64_t total(const ServiceCounters& counters) {
  std::int64_t sum = 0;
  for (const std::int64_t bodies : counters.bodies) sum += bodies;
  return sum;
}

class BodyEvaluationByMethod : public testing::TestWithParam<std::int32_t> {};
INSTANTIATE_TEST_SUITE_P(ExactAndDefault, BodyEvaluationByMethod, testing::Values(kBox, kHierarchicalBox));

TEST_P(BodyEvaluationByMethod, MatchesClosedFormForHalfSubmergedBox) {
  const BodyWrench wrench = evaluate(upright(GetParam(), 0.0));
  EXPECT_EQ(wrench.body_id, GetParam());
  EXPECT_EQ(wrench.status, BodyStatus::kOk);
  EXPECT_GT(wrench.force_error_bound, 0.0);
  EXPECT_LT(wrench.force_error_bound, 1e-9);
  EXPECT_NEAR(wrench.force[2], 0.5 * kWeight, wrench.force_error_bound);
  EXPECT_EQ(wrench.force[0], 0.0);
  EXPECT_EQ(wrench.force[1], 0.0);
  for (const double component : wrench.torque) EXPECT_NEAR(component, 0.0, wrench.torque_error_bound);
  EXPECT_NEAR(wrench.submerged_volume, 0.5, 1e-13);
  EXPECT_NEAR(wrench.center_of_buoyancy[0], 0.0, 1e-13);
  EXPECT_NEAR(wrench.center_of_buoyancy[1], 0.0, 1e-13);
  EXPECT_NEAR(wrench.center_of_buoyancy[2], -0.25, 1e-13);
}

TEST(BodyEvaluation, ComputesTorqueAboutReferencePoint) {
  // Rotated by 90 degrees about z, the reference point (0.5, 0.5, -0.5) in B is (-0.5, 0.5, -0.5) in W axes:
  // the lever arm to the centre of buoyancy is (0.5, -0.5, 0.25), and torque = lever arm x (0, 0, F).
  BodyState state = upright(kOffsetBox, 0.0);
  state.quaternion_wxyz = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};
  const BodyWrench wrench = evaluate(state);
  const double force = 0.5 * kWeight;
  EXPECT_EQ(wrench.status, BodyStatus::kOk);
  EXPECT_NEAR(wrench.torque[0], -0.5 * force, 1e-9);
  EXPECT_NEAR(wrench.torque[1], -0.5 * force, 1e-9);
  EXPECT_NEAR(wrench.torque[2], 0.0, 1e-9);
}

TEST(BodyEvaluation, BoundsErrorOfApproximateMethod) {
  const BodyWrench wrench = evaluate(upright(kFastBox, 0.0));
  EXPECT_EQ(wrench.status, BodyStatus::kOk);
  const double error = std::abs(wrench.force[2] - 0.5 * kWeight);
  EXPECT_GT(error, 0.0);
  EXPECT_LE(error, wrench.force_error_bound);
  EXPECT_LT(wrench.force_error_bound, kWeight);
  EXPECT_GT(wrench.torque_error_bound, 0.0);
}

TEST(BodyEvaluation, CountsBodiesByImmersion) {
  ServiceCounters counters;
  EXPECT_EQ(evaluate_alone(shared_box_scene(), upright(kBox, 10.0), 0.0, counters).force[2], 0.0);
  for (int i = 0; i < 2; ++i) evaluate_alone(shared_box_scene(), upright(kBox, -10.0), 0.0, counters);
  for (int i = 0; i < 3; ++i) evaluate_alone(shared_box_scene(), upright(kBox, 0.2), 0.0, counters);
  EXPECT_EQ(counters.bodies_dry, 1);
  EXPECT_EQ(counters.bodies_wet, 2);
  EXPECT_EQ(counters.bodies_crossing, 3);
  EXPECT_EQ(count(counters, BodyStatus::kOk), 6);
  EXPECT_EQ(total(counters), 6);
}

TEST(BodyEvaluation, RecordsLargestDroppedComponents) {
  ServiceCounters counters;
  BodyState tilted = upright(kBox, 0.1);
  tilted.quaternion_wxyz = {0.9, 0.3, 0.3, 0.1};
  for (int i = 0; i < 20; ++i) {
    tilted.position[2] = -0.5 + 0.05 * i;
    evaluate_alone(shared_box_scene(), tilted, 0.0, counters);
  }
  EXPECT_EQ(count(counters, BodyStatus::kOk), 20);
  EXPECT_GT(counters.largest_dropped_force + counters.largest_dropped_torque, 0.0);
  EXPECT_LT(counters.largest_dropped_force, 1e-13);
  EXPECT_LT(counters.largest_dropped_torque, 1e-13);
  const ServiceCounters before = counters;
  evaluate_alone(shared_box_scene(), upright(kBox, 10.0), 0.0, counters);
  EXPECT_EQ(counters.largest_dropped_force, before.largest_dropped_force);
  EXPECT_EQ(counters.largest_dropped_torque, before.largest_dropped_torque);
}

TEST(BodyEvaluation, ReturnsStatusAndZerosForEveryInvalidState) {
  for (const InvalidState& invalid : invalid_states()) {
    SCOPED_TRACE(invalid.name);
    ServiceCounters counters;
    const BodyWrench wrench = evaluate_alone(shared_box_scene(), invalid.state, invalid.lead_time, counters);
    EXPECT_EQ(wrench.body_id, invalid.state.body_id);
    EXPECT_STREQ(to_string(wrench.status), to_string(invalid.status));
    expect_zeros(wrench);
    EXPECT_EQ(count(counters, invalid.status), 1);
    EXPECT_EQ(total(counters), 1);
    EXPECT_EQ(counters.bodies_dry + counters.bodies_wet + counters.bodies_crossing, 0);
    EXPECT_EQ(counters.quaternions_normalised, 0);
  }
}

TEST(BodyEvaluation, ReportsFirstOfSeveralErrors) {
  BodyState state = upright(kNoBody, kNaN);
  state.quaternion_wxyz = {0, 0, 0, 0};
  state.linear_velocity[0] = kNaN;
  EXPECT_EQ(evaluate(state, kNaN).status, BodyStatus::kUnknownBody);
  state.body_id = kBox;
  EXPECT_EQ(evaluate(state, kNaN).status, BodyStatus::kNonFinitePose);
  state.position[2] = 0.0;
  EXPECT_EQ(evaluate(state, kNaN).status, BodyStatus::kBadQuaternion);
  state.quaternion_wxyz[0] = 1.0;
  EXPECT_EQ(evaluate(state, kNaN).status, BodyStatus::kBadLeadTime);
  EXPECT_EQ(evaluate(state, 1.0).status, BodyStatus::kNonFiniteTwist);
  state.linear_velocity[0] = 0.0;
  EXPECT_EQ(evaluate(state, 1.0).status, BodyStatus::kOk);
}

TEST(BodyEvaluation, ChecksTwistConditionSeaAndLeadTimeInThisOrder) {
  BodyState state = upright(kBox, 0.1);
  const double far = 2.0 * kMaxLeadTimeInWaves;
  const WaterState unknown;
  const Water at_rest;
  const auto* const waves = reinterpret_cast<const SeaAtTime*>(&at_rest);  // is not read
  const WaterState still{&at_rest, nullptr};
  const WaterState moving{&at_rest, waves};
  EXPECT_EQ(check_state(state, far, moving, true, true), BodyStatus::kOutOfRange);
  EXPECT_EQ(check_state(state, -far, moving, true, true), BodyStatus::kOutOfRange);
  EXPECT_EQ(check_state(state, kMaxLeadTimeInWaves, moving, true, true), BodyStatus::kOk);
  EXPECT_EQ(check_state(state, far, still, true, true), BodyStatus::kOk);
  EXPECT_EQ(check_state(state, far, unknown, true, true), BodyStatus::kNoSea);
  EXPECT_EQ(check_state(state, far, unknown, true, false), BodyStatus::kBadCondition);
  state.angular_velocity[2] = kInfinity;
  EXPECT_EQ(check_state(state, far, unknown, true, false), BodyStatus::kNonFiniteTwist);
  EXPECT_EQ(check_state(state, far, unknown, false, false), BodyStatus::kBadCondition);
}

TEST(BodyEvaluation, IgnoresVelocitiesWithoutLeadTime) {
  BodyState state = upright(kBox, 0.1);
  const BodyWrench at_rest = evaluate(state);
  state.linear_velocity = {kNaN, kInfinity, -kInfinity};
  state.angular_velocity = {kNaN, kNaN, 1e300};
  for (const double lead_time : {0.0, -0.0}) {
    const BodyWrench wrench = evaluate(state, lead_time);
    EXPECT_EQ(wrench.status, BodyStatus::kOk);
    EXPECT_EQ(wrench.force, at_rest.force);
    EXPECT_EQ(wrench.torque, at_rest.torque);
  }
}

TEST(BodyEvaluation, AcceptsDenormalsInPose) {
  BodyState state = upright(kBox, 0.0);
  const BodyWrench plain = evaluate(state);
  state.position = {kDenormal, -kDenormal, kDenormal};
  state.quaternion_wxyz = {1.0, kDenormal, -kDenormal, kDenormal};
  const BodyWrench wrench = evaluate(state);
  EXPECT_EQ(wrench.status, BodyStatus::kOk);
  EXPECT_NEAR(wrench.force[2], plain.force[2], 2.0 * plain.force_error_bound);
}

TEST(BodyEvaluation, NormalisesQuaternionsWithinTolerance) {
  struct Case {
    double norm;
    BodyStatus expected;
    std::int64_t normalised;
  };
  for (const Case& c : {Case{1.0 + 9e-7, BodyStatus::kOk, 0}, Case{1.0 - 9e-7, BodyStatus::kOk, 0},
                        Case{1.0 + 1.1e-6, BodyStatus::kOk, 1}, Case{1.0 - 1.1e-6, BodyStatus::kOk, 1},
                        Case{1.0 + 0.99e-3, BodyStatus::kOk, 1}, Case{1.0 - 0.99e-3, BodyStatus::kOk, 1},
                        Case{1.0 + 1.01e-3, BodyStatus::kBadQuaternion, 0},
                        Case{1.0 - 1.01e-3, BodyStatus::kBadQuaternion, 0}}) {
    SCOPED_TRACE(c.norm);
    BodyState state = upright(kBox, 0.1);
    state.quaternion_wxyz = {0.8, 0.0, 0.6, 0.0};
    const BodyWrench unit = evaluate(state);
    for (double& component : state.quaternion_wxyz) component *= c.norm;
    ServiceCounters counters;
    const BodyWrench wrench = evaluate_alone(shared_box_scene(), state, 0.0, counters);
    EXPECT_EQ(wrench.status, c.expected);
    EXPECT_EQ(counters.quaternions_normalised, c.normalised);
    if (c.expected != BodyStatus::kOk) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(wrench.force[i], unit.force[i], 2.0 * unit.force_error_bound);
      EXPECT_NEAR(wrench.torque[i], unit.torque[i], 2.0 * unit.torque_error_bound);
    }
  }
}

TEST(BodyEvaluation, ReturnsFiniteValuesIfOk) {
  for (const double far : {1e10, -1e10, 1e100, -1e100, 1e200, -1e200, 1e300, -1e300, kLargest, -kLargest}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::int32_t id : {kBox, kOffsetBox, kFastBox, kHierarchicalBox}) {
        BodyState state = upright(id, 0.0);
        state.position[axis] = far;
        const BodyWrench wrench = evaluate(state);
        if (wrench.status == BodyStatus::kOk) {
          for (const auto* vector : {&wrench.force, &wrench.torque, &wrench.center_of_buoyancy})
            for (const double value : *vector) EXPECT_TRUE(std::isfinite(value));
          EXPECT_TRUE(std::isfinite(wrench.submerged_volume));
          EXPECT_FALSE(std::isinf(wrench.force_error_bound));
          EXPECT_FALSE(std::isinf(wrench.torque_error_bound));
        } else {
          EXPECT_EQ(wrench.status, BodyStatus::kOutOfRange);
          expect_zeros(wrench);
        }
      }
    }
  }
}

TEST(BodyEvaluation, EvaluatesOpenHullOnlyWhileItsEdgeIsDry) {
  const std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "open_hull";
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "tub.off")
      << "OFF\n8 10 0\n"
         "-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n"
         "3 0 2 1\n3 0 3 2\n"
         "3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n"
         "3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  const Scene tub = scene_of(R"(
    [[body]]
    id = 1
    mesh = "tub.off"
    method = "exact"
    open = "dry_boundary"
  )",
                             directory);
  ServiceCounters counters;
  const BodyWrench afloat = evaluate_alone(tub, upright(1, 0.5), 0.0, counters);
  EXPECT_EQ(afloat.status, BodyStatus::kOk);
  EXPECT_NEAR(afloat.submerged_volume, 2.0, 1e-12);
  const BodyWrench sunk = evaluate_alone(tub, upright(1, -1.5), 0.0, counters);
  EXPECT_EQ(sunk.status, BodyStatus::kOpenEdgeWet);
  expect_zeros(sunk);
  EXPECT_EQ(count(counters, BodyStatus::kOpenEdgeWet), 1);
}

TEST(BodyEvaluation, UsesExtrapolatedPoseWithLeadTime) {
  BodyState moving = upright(kBox, 0.3);
  moving.quaternion_wxyz = {0.8, 0.6, 0.0, 0.0};
  moving.linear_velocity = {1.0, 2.0, -3.0};
  moving.angular_velocity = {0.4, -0.5, 0.6};
  const double lead_time = 0.1;
  const Pose later = extrapolate({.p_WB = {3.0, -2.0, 0.3}, .q_WB = {0.8, 0.6, 0.0, 0.0}}, {1.0, 2.0, -3.0},
                                 {0.4, -0.5, 0.6}, lead_time);
  BodyState there = upright(kBox, 0.0);
  there.position = {later.p_WB.x(), later.p_WB.y(), later.p_WB.z()};
  there.quaternion_wxyz = {later.q_WB.w(), later.q_WB.x(), later.q_WB.y(), later.q_WB.z()};
  const BodyWrench led = evaluate(moving, lead_time);
  const BodyWrench sent = evaluate(there);
  EXPECT_EQ(led.status, BodyStatus::kOk);
  EXPECT_EQ(led.force, sent.force);
  EXPECT_EQ(led.torque, sent.torque);
  EXPECT_NE(led.force, evaluate(moving).force);
}

TEST(Extrapolate, MovesByVelocityOfOrigin) {
  const Pose later = extrapolate({.p_WB = {1, 2, 3}}, {0.5, -1.0, 2.0}, {0, 0, 0}, 2.0);
  EXPECT_EQ(later.p_WB, Vec3(2.0, 0.0, 7.0));
  EXPECT_EQ(later.q_WB.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(Extrapolate, RotatesAboutWorldAxes) {
  // The body lies on its side (B's z points along -y of W). After a quarter turn about W's z, B's z points
  // along x of W.
  const double half = std::sqrt(0.5);
  const Pose later = extrapolate({.p_WB = Vec3::Zero(), .q_WB = {half, half, 0.0, 0.0}}, Vec3::Zero(),
                                 {0.0, 0.0, std::numbers::pi / 4.0}, 2.0);
  const Vec3 z_of_B_W = later.q_WB * Vec3::UnitZ();
  EXPECT_NEAR((z_of_B_W - Vec3::UnitX()).norm(), 0.0, 1e-15);
}

TEST(Extrapolate, IsAccurateForTinyRotations) {
  for (const double rate : {kDenormal, 1e-310, 1e-200, 1e-160, 1e-20, 1e-9}) {
    SCOPED_TRACE(rate);
    const Pose later = extrapolate({}, Vec3::Zero(), {0.0, rate, 0.0}, 1.0);
    EXPECT_EQ(later.q_WB.w(), 1.0);
    EXPECT_NEAR(later.q_WB.y(), 0.5 * rate, 1e-15 * rate + kDenormal);
    EXPECT_EQ(later.q_WB.x(), 0.0);
  }
}

RC_GTEST_PROP(Extrapolate, ComposesStepsOfConstantTwist, ()) {
  const auto number = [] { return *rc::gen::inRange(-1000, 1001) * 1e-3; };
  const Pose start{.p_WB = {number(), number(), number()},
                   .q_WB = Eigen::Quaterniond{1.5, number(), number(), number()}.normalized()};
  const Vec3 v{number(), number(), number()};
  const Vec3 w = 5.0 * Vec3{number(), number(), number()};
  const double first = number();
  const double second = number();
  const Pose twice = extrapolate(extrapolate(start, v, w, first), v, w, second);
  const Pose once = extrapolate(start, v, w, first + second);
  RC_ASSERT((twice.p_WB - once.p_WB).norm() < 1e-14);
  RC_ASSERT((twice.q_WB.coeffs() - once.q_WB.coeffs()).norm() < 1e-14);
  RC_ASSERT(std::abs(once.q_WB.norm() - 1.0) < 1e-15);
}

}  // namespace
}  // namespace buoyancy
