// Requests about bodies with drag and added mass, and the loads output.

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "engine/load_evaluation.h"
#include "engine/request_handler.h"
#include "messages/conversions.h"
#include "tests/engine/box_scene.h"
#include "tests/hydrodynamics/random_matrices.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026

// Bodies 1 to 4 of a box: without tables, with drag, with drag and loads about a corner, with loads alone.
std::string boxes(const std::string& water) {
  const std::string box = "shape = { type = \"box\", size = [1, 1, 1], segments = [2, 2, 2] }\n";
  const std::string drag =
      "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\nquadratic = [18, 22, 37, 1.5, 1.5, 1.5]\n";
  return water + "[[body]]\nid = 1\n" + box +  //
         "[[body]]\nid = 2\n" + box + drag +   //
         "[[body]]\nid = 3\n" + box +
         "reference_point = [0.5, 0.5, -0.5]\noutputs = [\"wrench\", \"loads\"]\n" + drag +
         "center = [0.1, 0, -0.2]\n[body.added_mass]\nmatrix = [5, 126, 126, 0.1, 33, 33]\n"  //
         "[[body]]\nid = 4\n" +
         box + "outputs = [\"wrench\", \"loads\"]\n";
}

const std::string kSea =
    "[water]\ndepth = 30\nwaves = { type = \"jonswap\", significant_wave_height = 0.5, peak_period = 4.0, "
    "seed = 3 "
    "}\n[water.current]\nvelocity = [0.3, -0.2, 0.1]\n";

BodyState moving(std::int32_t id, double height) {
  BodyState state = upright(id, height);
  state.quaternion_wxyz = {0.8, 0.0, 0.6, 0.0};
  state.linear_velocity = {1.5, -0.5, 0.25};
  state.angular_velocity = {0.1, 0.2, -0.3};
  return state;
}

struct Answer {
  WrenchResponse response;
  BodiesLoads loads;
};

Answer ask(RequestHandler& handler, std::vector<BodyState> bodies, std::int64_t utime = kNow,
           double lead_time = 0.0) {
  static std::int64_t seq = 0;
  Answer answer;
  const ByteVector bytes = request_bytes({utime, 1, ++seq}, std::move(bodies), lead_time);
  EXPECT_FALSE(decode(handler.handle(bytes), answer.response));
  if (!handler.last_loads().empty()) {
    EXPECT_FALSE(decode(handler.last_loads(), answer.loads));
  }
  return answer;
}

Vec6 wrench_of(const BodyWrench& wrench) {
  Vec6 vector;
  vector << to_vec3(wrench.force), to_vec3(wrench.torque);
  return vector;
}

TEST(RequestHandlerWithLoads, AddsDragAndAddedMassToBuoyancy) {
  for (const std::string& water : {std::string(), kSea}) {
    const Scene scene = scene_of(boxes(water));
    RequestHandler handler(scene);
    for (const double height : {0.2, -4.0, 9.0}) {
      const Answer answer = ask(handler, {moving(1, height), moving(2, height), moving(3, height)});
      for (const BodyWrench& wrench : answer.response.bodies) ASSERT_EQ(wrench.status, BodyStatus::kOk);
      ASSERT_EQ(answer.loads.bodies.size(), 1U);
      const BodyLoads& loads = answer.loads.bodies[0];
      EXPECT_EQ(loads.body_id, 3);
      const Vec3 sum =
          to_vec3(loads.buoyancy_force) + to_vec3(loads.drag_force) + to_vec3(loads.added_mass_force);
      const Vec3 torque =
          to_vec3(loads.buoyancy_torque) + to_vec3(loads.drag_torque) + to_vec3(loads.added_mass_torque);
      const BodyWrench& wrench = answer.response.bodies[2];
      EXPECT_LE((sum - to_vec3(wrench.force)).norm(), 1e-14 * sum.norm());
      EXPECT_LE((torque - to_vec3(wrench.torque)).norm(), 1e-14 * (1.0 + torque.norm()));
      EXPECT_LE((to_vec3(loads.buoyancy_force) - to_vec3(answer.response.bodies[0].force)).norm(),
                2.0 * answer.response.bodies[0].force_error_bound);
      const bool dry = height > 5.0;
      EXPECT_EQ(loads.immersion > 0.0, !dry);
      EXPECT_EQ(to_vec3(loads.drag_force).norm() > 0.0, !dry);
      EXPECT_EQ(to_vec3(loads.added_mass_force).norm() > 0.0, !dry);
      EXPECT_EQ(wrench_of(answer.response.bodies[1]) == wrench_of(answer.response.bodies[0]), dry);
      EXPECT_GE(wrench.force_error_bound, answer.response.bodies[0].force_error_bound);
    }
  }
}

TEST(RequestHandlerWithLoads, HalfSubmergedBodyGetsHalfOfItsDrag) {
  const Scene scene = scene_of(
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 1] }\n[body.drag]\nlinear = [20, 60, 60, 5, "
      "5, 8]\n"
      "[[body]]\nid = 2\nshape = { type = \"box\", size = [1, 1, 1] }\n[body.drag]\nlinear = [20, 60, 60, 5, "
      "5, 8]\n"
      "immersion = \"none\"\n"
      "[[body]]\nid = 3\nshape = { type = \"box\", size = [1, 1, 1] }\n[body.drag]\nlinear = [20, 60, 60, 5, "
      "5, 8]\n"
      "immersion = \"wetted_area\"\n");
  RequestHandler handler(scene);
  // Of the drag at 2 m/s along x, at draughts from none to more than the body's height.
  for (const auto& [height, volume, area] : {std::tuple{0.75, 0.0, 0.0},
                                             {0.5, 0.0, 0.0},
                                             {0.25, 0.25, 2.0 / 6.0},
                                             {0.0, 0.5, 3.0 / 6.0},
                                             {-0.4, 0.9, 4.6 / 6.0},
                                             {-0.75, 1.0, 1.0}}) {
    std::vector<BodyState> states{upright(1, height), upright(2, height), upright(3, height)};
    for (BodyState& state : states) state.linear_velocity = {2.0, 0.0, 0.0};
    const Answer answer = ask(handler, states);
    EXPECT_NEAR(answer.response.bodies[0].force[0], -40.0 * volume, 1e-12) << height;
    EXPECT_NEAR(answer.response.bodies[1].force[0], volume > 0.0 ? -40.0 : 0.0, 1e-12) << height;
    EXPECT_NEAR(answer.response.bodies[2].force[0], -40.0 * area, 1e-12) << height;
    EXPECT_TRUE(answer.loads.bodies.empty());
  }
}

TEST(RequestHandlerWithLoads, IsNotUnchangedWhenOnlyTheVelocityChanged) {
  const Scene scene = scene_of(boxes(""));
  RequestHandler handler(scene);
  std::vector<BodyState> states{moving(1, 0.2), moving(2, 0.2), moving(3, -5.0)};
  const Answer first = ask(handler, states);
  EXPECT_EQ(handler.counters().bodies_unchanged, 0);
  const Answer same = ask(handler, states);
  EXPECT_EQ(handler.counters().bodies_unchanged, 3);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(wrench_of(first.response.bodies[i]), wrench_of(same.response.bodies[i]));
    states[i].linear_velocity[0] += 1.0;
  }
  const Answer faster = ask(handler, states);
  EXPECT_EQ(handler.counters().bodies_unchanged, 4) << "only body 1 does not depend on its velocity";
  EXPECT_EQ(wrench_of(first.response.bodies[0]), wrench_of(faster.response.bodies[0]));
  EXPECT_LT(faster.response.bodies[1].force[0], first.response.bodies[1].force[0]);
  EXPECT_NE(faster.response.bodies[2].force[0], first.response.bodies[2].force[0]);
}

TEST(RequestHandlerWithLoads, RejectsANonFiniteTwistOfABodyThatNeedsIt) {
  const Scene scene = scene_of(boxes(""));
  RequestHandler handler(scene);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (const bool angular : {false, true}) {
      std::vector<BodyState> states{moving(1, 0.2), moving(2, 0.2), moving(3, 0.2), moving(4, 0.2)};
      for (BodyState& state : states) (angular ? state.angular_velocity : state.linear_velocity)[1] = bad;
      const Answer answer = ask(handler, states);
      EXPECT_EQ(answer.response.bodies[0].status, BodyStatus::kOk);
      EXPECT_EQ(answer.response.bodies[1].status, BodyStatus::kNonFiniteTwist);
      EXPECT_EQ(answer.response.bodies[2].status, BodyStatus::kNonFiniteTwist);
      EXPECT_EQ(wrench_of(answer.response.bodies[2]), Vec6(Vec6::Zero()));
      EXPECT_EQ(answer.response.bodies[3].status, BodyStatus::kOk);
      ASSERT_EQ(answer.loads.bodies.size(), 2U);
      EXPECT_EQ(answer.loads.bodies[0].status, BodyStatus::kNonFiniteTwist);
      EXPECT_EQ(answer.loads.bodies[0].added_mass[1][1], 0.0);
      EXPECT_EQ(answer.loads.bodies[1].status, BodyStatus::kOk);
    }
  }
  BodyState fast = moving(2, -3.0);
  fast.linear_velocity = {1e200, 0.0, 0.0};
  const BodyWrench beyond = ask(handler, {fast}).response.bodies[0];
  EXPECT_EQ(beyond.status, BodyStatus::kOutOfRange);
  EXPECT_EQ(wrench_of(beyond), Vec6(Vec6::Zero()));
  EXPECT_EQ(ask(handler, {moving(2, -3.0)}).response.bodies[0].status, BodyStatus::kOk);
}

TEST(RequestHandlerWithLoads, PublishesLoadsOfTheBodiesThatRequestThem) {
  const Scene scene = scene_of(boxes("[water.current]\nvelocity = [1, 2, 3]\n"));
  RequestHandler handler(scene);
  EXPECT_TRUE(handler.last_loads().empty());
  ask(handler, {moving(1, 0.1), moving(2, 0.1)});
  EXPECT_TRUE(handler.last_loads().empty());
  BodyState lost = moving(3, 0.1);
  lost.position[0] = std::nan("");
  const Answer answer = ask(handler, {moving(4, 0.0), moving(kNoBody + 50, 0.0), lost, moving(2, 0.0)});
  ASSERT_EQ(answer.loads.bodies.size(), 2U);
  EXPECT_EQ(answer.loads.id.seq, answer.response.id.seq);
  EXPECT_EQ(answer.loads.bodies[0].body_id, 4);
  EXPECT_NEAR(answer.loads.bodies[0].immersion, 0.5, 1e-12);
  EXPECT_EQ(answer.loads.bodies[0].water_velocity, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(answer.loads.bodies[1].body_id, 3);
  EXPECT_EQ(answer.loads.bodies[1].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(answer.loads.bodies[1].immersion, 0.0);
}

TEST(RequestHandlerWithLoads, RetryGetsTheSameLoads) {
  const Scene scene = scene_of(boxes(""));
  RequestHandler handler(scene);
  const ByteVector first = request_bytes({kNow, 5, 1}, {moving(3, 0.1)});
  handler.handle(first);
  const Bytes loads = handler.last_loads();
  const ByteVector kept(loads.begin(), loads.end());
  handler.handle(request_bytes({kNow, 6, 1}, {moving(2, 0.1)}));
  EXPECT_TRUE(handler.last_loads().empty());
  handler.handle(first);
  EXPECT_EQ(handler.counters().retries, 1);
  EXPECT_EQ(kept, ByteVector(handler.last_loads().begin(), handler.last_loads().end()));
}

// By requests alone: the derivative with respect to the velocity of the reference point.
TEST(RequestHandlerWithLoads, DampingIsTheDerivativeOfTheWrench) {
  for (const std::string& water : {std::string(), kSea}) {
    const Scene scene = scene_of(boxes(water));
    RequestHandler handler(scene);
    const BodyState state = moving(3, 0.1);
    const BodyLoads loads = ask(handler, {state}).loads.bodies[0];
    const Eigen::Quaterniond q(0.8, 0.0, 0.6, 0.0);
    const Vec3 to_reference_W = q * Vec3(0.5, 0.5, -0.5);
    for (std::size_t column = 0; column < 6; ++column) {
      const auto wrench_at = [&](double change) {
        Vec6 twist = Vec6::Zero();
        twist[static_cast<Eigen::Index>(column)] = change;
        const Vec6 of_origin = twist_at(twist, -to_reference_W);
        BodyState moved = state;
        moved.linear_velocity = to_array(to_vec3(state.linear_velocity) + of_origin.head<3>());
        moved.angular_velocity = to_array(to_vec3(state.angular_velocity) + of_origin.tail<3>());
        return wrench_of(ask(handler, {moved}).response.bodies[0]);
      };
      constexpr double kChange = 1e-4;
      const Vec6 difference = -(wrench_at(kChange) - wrench_at(-kChange)) / (2.0 * kChange);
      for (std::size_t row = 0; row < 6; ++row) {
        EXPECT_NEAR(loads.damping[row][column], difference[static_cast<Eigen::Index>(row)], 1e-6 * 100.0)
            << row << ", " << column;
      }
    }
  }
}

TEST(RequestHandlerWithLoads, WaterMovesWithCurrentAndWaves) {
  const Scene scene = scene_of(boxes(kSea));
  RequestHandler handler(scene);
  SeaSnapshot snapshot(*scene.sea());
  const BodyState state = moving(3, -0.3);
  const Eigen::Quaterniond q(0.8, 0.0, 0.6, 0.0);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t utime = kNow + 700'000 * i;
    const BodyLoads loads = ask(handler, {state}, utime).loads.bodies[0];
    snapshot.set_time(utime);
    const WaterAtPoint point = snapshot.at(to_vec3(state.position) + q * Vec3(0.1, 0.0, -0.2));
    const Vec3 expected = Vec3(0.3, -0.2, 0.1) + point.velocity_W;
    EXPECT_LE((to_vec3(loads.water_velocity) - expected).norm(), 1e-12);
    EXPECT_GT(point.velocity_W.norm(), 0.0);
  }
}

// A body that moves as the water does feels no drag, and of added mass s A times the water's acceleration.
TEST(RequestHandlerWithLoads, BodyThatDriftsWithTheWaterFeelsItsAcceleration) {
  const Scene scene = scene_of(
      kSea +
      "[[body]]\nid = 1\nshape = { type = \"sphere\", radius = 0.1, segments = 24 }\noutputs = [\"wrench\", "
      "\"loads\"]\n[body.drag]\nquadratic = [9, 9, 9, 1, 1, 1]\n[body.added_mass]\nmatrix = [2, 2, 2, 0, 0, "
      "0]\n");
  RequestHandler handler(scene);
  BodyState state = upright(1, -1.5);
  state.linear_velocity = ask(handler, {state}).loads.bodies[0].water_velocity;
  const BodyLoads loads = ask(handler, {state}).loads.bodies[0];
  SeaSnapshot snapshot(*scene.sea());
  snapshot.set_time(kNow);
  const Vec3 acceleration_W = snapshot.at(to_vec3(state.position)).acceleration_W;
  EXPECT_GT(acceleration_W.norm(), 0.01);
  EXPECT_LE(to_vec3(loads.drag_force).norm(), 1e-20);
  EXPECT_LE((to_vec3(loads.added_mass_force) - 2.0 * acceleration_W).norm(), 1e-11);
}

// The boxes in a sea on a current, and where they are in its frame; nothing there tells the current apart
// from water at rest, but the time at which the added mass takes part in the motion of the reference point.
TEST(RequestHandlerWithLoads, LoadsAreTheSameInTheFrameOfTheCurrent) {
  const std::string sea =
      "[water]\ndepth = 30\ntime_origin = 1789999900000000\nwaves = { type = \"jonswap\", "
      "significant_wave_height = 0.5, peak_period = 4.0, spreading = 8, seed = 3 }\n";
  constexpr double kTime = 100.0;  // [s], of kNow
  const Scene still = scene_of(boxes(sea));
  RequestHandler in_still_water(still);
  const auto in_waves = [](const Answer& answer) {  // of body 3, with what its engine adds
    const BodyLoads& loads = answer.loads.bodies[0];
    Mat6 added_mass;
    for (std::size_t i = 0; i < 36; ++i) {
      added_mass(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6)) =
          loads.added_mass[i / 6][i % 6];
    }
    return std::pair{wrench_of(answer.response.bodies[1]), added_mass};
  };
  for (const Vec3& current_W : {Vec3(1.5, 0.0, 0.0), Vec3(-0.9, 2.2, 0.0)}) {
    const Scene scene =
        scene_of(boxes(sea + "[water.current]\nvelocity = [" + format_vector(current_W) + "]\n"));
    RequestHandler on_current(scene);
    for (const double height : {0.3, 0.0, -2.0}) {
      std::vector<BodyState> bodies{moving(1, height), moving(3, height)};
      const Answer at_rest = ask(in_still_water, bodies);
      for (BodyState& body : bodies) {
        for (std::size_t i = 0; i < 3; ++i) {
          body.position[i] += kTime * current_W[static_cast<Eigen::Index>(i)];
          body.linear_velocity[i] += current_W[static_cast<Eigen::Index>(i)];
        }
      }
      const Answer carried = ask(on_current, bodies);
      for (std::size_t i = 0; i < 2; ++i) {
        const BodyWrench& a = at_rest.response.bodies[i];
        const BodyWrench& b = carried.response.bodies[i];
        ASSERT_EQ(b.status, BodyStatus::kOk);
        Vec6 difference = wrench_of(b) - wrench_of(a);
        if (i == 1) {
          Vec6 turning = Vec6::Zero();
          turning.head<3>() = to_vec3(bodies[i].angular_velocity).cross(current_W);
          difference += in_waves(carried).second * turning;
        }
        EXPECT_LE(difference.head<3>().norm(), a.force_error_bound + b.force_error_bound) << height;
        EXPECT_LE(difference.tail<3>().norm(), a.torque_error_bound + b.torque_error_bound) << height;
      }
    }
  }
}

TEST(RequestHandlerWithLoads, SameBytesOnAnyNumberOfThreads) {
  for (const std::string& water : {std::string(), kSea}) {
    std::string text = water;
    std::vector<BodyState> states;
    std::mt19937 random(3);
    for (int id = 1; id <= 600; ++id) {
      text += "[[body]]\nid = " + std::to_string(id) +
              "\nshape = { type = \"rock\", radius = 0.6, frequency = 6, seed = 2 }\n";
      if (id % 2 == 0) text += "outputs = [\"wrench\", \"loads\"]\n";
      if (id % 3 > 0) text += "[body.drag]\nquadratic = [18, 22, 37, 1.5, 1.5, 1.5]\n";
      if (id % 3 > 1) text += "[body.added_mass]\nmatrix = [18, 22, 37, 1.5, 1.5, 1.5]\n";
      states.push_back(moving(id % 100 == 0 ? 1 : id, 2.0 * random_number(random)));
    }
    const Scene scene = scene_of(text);
    const ByteVector request = request_bytes({kNow, 1, 1}, states);
    ByteVector expected;
    for (const unsigned threads : {1U, 2U, 8U}) {
      RequestHandler handler(scene, {.threads = threads});
      const Bytes response = handler.handle(request);
      ByteVector bytes(response.begin(), response.end());
      bytes.insert(bytes.end(), handler.last_loads().begin(), handler.last_loads().end());
      if (threads == 1) expected = bytes;
      EXPECT_EQ(bytes, expected) << threads;
    }
  }
}

TEST(RequestHandlerWithLoads, DoesNotAllocateAfterWarmUp) {
  const Scene scene = scene_of(boxes("[water.current]\nvelocity = [1, 0, 0]\n"));
  RequestHandler handler(scene);
  std::vector<ByteVector> requests;
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    const double height = -1.5 + 0.15 * static_cast<double>(seq);
    requests.push_back(request_bytes(
        {kNow, 1, seq}, {moving(1, height), moving(2, height), moving(3, height), moving(4, height)}));
  }
  handler.handle(requests[0]);
  const AllocationCount allocations;
  for (const ByteVector& request : requests) ASSERT_FALSE(handler.handle(request).empty());
  EXPECT_EQ(allocations.count(), 0);
}

// Between the truth of a body and its published load lies the error of its volume.
TEST(RequestHandlerWithLoads, BoundContainsTheErrorOfTheImmersion) {
  const std::string rock =
      "shape = { type = \"rock\", radius = 1, frequency = 12, seed = 4 }\n[body.drag]\nquadratic = [1e6, "
      "1e6, 1e6, 1e5, "
      "1e5, 1e5]\n[body.added_mass]\nmatrix = [1e5, 1e5, 1e5, 1e5, 1e5, 1e5]\n";
  for (const std::string& water : {std::string(), kSea}) {
    const std::string tight = water.empty() ? "0" : "1e-6";
    const Scene scene = scene_of(water + "[[body]]\nid = 1\ntolerance = 1e-2\n" + rock +
                                 "[[body]]\nid = 2\ntolerance = " + tight + "\n" + rock);
    RequestHandler handler(scene);
    std::mt19937 random(8);
    for (int i = 0; i < 40; ++i) {
      BodyState state = moving(1, 1.2 * random_number(random));
      const Vec3 velocity = 3.0 * random_vec3(random);
      state.linear_velocity = to_array(velocity);
      BodyState exact = state;
      exact.body_id = 2;
      const Answer answer = ask(handler, {state, exact}, kNow + 100'000 * i);
      const BodyWrench& rough = answer.response.bodies[0];
      const BodyWrench& fine = answer.response.bodies[1];
      const Vec6 error = wrench_of(rough) - wrench_of(fine);
      EXPECT_LE(error.head<3>().norm(), rough.force_error_bound + fine.force_error_bound);
      EXPECT_LE(error.tail<3>().norm(), rough.torque_error_bound + fine.torque_error_bound);
    }
  }
}

}  // namespace
}  // namespace buoyancy
