// Requests about bodies with drag and added mass, and the loads output.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "engine/load_evaluation.h"
#include "engine/request_handler.h"
#include "engine/water_at_time.h"
#include "messages/conversions.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/reply.h"
#include "tests/hydrodynamics/random_matrices.h"
#include "tests/support/allocation_count.h"
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

Answer ask(RequestHandler& handler, std::vector<BodyState> bodies, std::int64_t utime = kNow) {
  static std::int64_t seq = 0;
  const Reply reply = reply_to(handler, request_bytes({utime, 1, ++seq}, std::move(bodies)));
  return {response_of(reply), reply.loads.empty() ? BodiesLoads{} : decoded<BodiesLoads>(reply.loads)};
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

// Every scaling of the drag beside every one of the added mass, and each alone.
TEST(RequestHandlerWithLoads, ScaleDragAndAddedMassByTheirOwnImmersions) {
  const std::vector<std::string> scalings{"volume", "wetted_area", "none", ""};
  std::string text;
  int id = 0;
  for (const std::string& of_drag : scalings) {
    for (const std::string& of_mass : scalings) {
      text += "[[body]]\nid = " + std::to_string(++id) +
              "\nshape = { type = \"box\", size = [1, 1, 1] }\noutputs = [\"wrench\", \"loads\"]\n";
      if (!of_drag.empty()) {
        text += "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\nimmersion = \"" + of_drag + "\"\n";
      }
      if (!of_mass.empty()) {
        text += "[body.added_mass]\nmatrix = [7, 126, 126, 0.1, 33, 33]\nimmersion = \"" + of_mass + "\"\n";
      }
    }
  }
  const Scene scene = scene_of(text);
  RequestHandler handler(scene);
  // At 2 m/s along x, at draughts from none to more than the body's height.
  for (const auto& [height, volume, area] : {std::tuple{0.75, 0.0, 0.0},
                                             {0.5, 0.0, 0.0},
                                             {0.25, 0.25, 2.0 / 6.0},
                                             {0.0, 0.5, 3.0 / 6.0},
                                             {-0.4, 0.9, 4.6 / 6.0},
                                             {-0.75, 1.0, 1.0}}) {
    const std::vector<double> factors{volume, area, volume > 0.0 ? 1.0 : 0.0, 0.0};
    std::vector<BodyState> states;
    for (int body = 1; body <= id; ++body) {
      states.push_back(upright(body, height));
      states.back().linear_velocity = {2.0, 0.0, 0.0};
    }
    const Answer answer = ask(handler, states);
    ASSERT_EQ(answer.loads.bodies.size(), states.size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      const std::size_t of_drag = i / scalings.size(), of_mass = i % scalings.size();
      const std::string where =
          scalings[of_drag] + ", " + scalings[of_mass] + " at " + std::to_string(height);
      const BodyLoads& loads = answer.loads.bodies[i];
      EXPECT_NEAR(answer.response.bodies[i].force[0], -40.0 * factors[of_drag], 1e-12) << where;
      EXPECT_NEAR(loads.drag_force[0], -40.0 * factors[of_drag], 1e-12) << where;
      EXPECT_NEAR(loads.damping[0][0], 20.0 * factors[of_drag], 1e-12) << where;
      EXPECT_NEAR(loads.added_mass[0][0], 7.0 * factors[of_mass], 1e-12) << where;
      // That of the drag, else that of the added mass, else that of the volume.
      const std::size_t shown = of_drag < 3 ? of_drag : of_mass < 3 ? of_mass : 0;
      EXPECT_NEAR(loads.immersion, factors[shown], 1e-12) << where;
    }
  }
}

TEST(RequestHandlerWithLoads, IsNotUnchangedWhenOnlyTheVelocityChanged) {
  const Scene scene = scene_of(boxes(""));
  RequestHandler handler(scene);
  const std::vector<BodyState> states{moving(1, 0.2), moving(2, 0.2), moving(3, -5.0)};
  const Answer first = ask(handler, states);
  EXPECT_EQ(handler.counters().bodies_unchanged, 0);
  std::int64_t unchanged = 0;
  for (std::size_t component = 0; component < 6; ++component) {
    const Answer same = ask(handler, states);
    unchanged += component == 0 ? 3 : 1;  // later ones follow another velocity
    EXPECT_EQ(handler.counters().bodies_unchanged, unchanged) << component;
    std::vector<BodyState> faster = states;
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_EQ(wrench_of(first.response.bodies[i]), wrench_of(same.response.bodies[i]));
      (component < 3 ? faster[i].linear_velocity : faster[i].angular_velocity)[component % 3] += 1.0;
    }
    const Answer other = ask(handler, faster);
    EXPECT_EQ(handler.counters().bodies_unchanged, ++unchanged)
        << "only body 1 does not depend on its velocity";
    EXPECT_EQ(wrench_of(first.response.bodies[0]), wrench_of(other.response.bodies[0]));
    for (const std::size_t i : {1U, 2U}) {
      EXPECT_NE(wrench_of(first.response.bodies[i]), wrench_of(other.response.bodies[i])) << component;
    }
  }
}

TEST(RequestHandlerWithLoads, RejectsANonFiniteTwistOfABodyThatNeedsIt) {
  const Scene scene = scene_of(boxes(""));
  RequestHandler handler(scene);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (std::size_t component = 0; component < 6; ++component) {
      std::vector<BodyState> states{moving(1, 0.2), moving(2, 0.2), moving(3, 0.2), moving(4, 0.2)};
      for (BodyState& state : states) {
        (component < 3 ? state.linear_velocity : state.angular_velocity)[component % 3] = bad;
      }
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
  const ByteVector request = request_bytes({kNow, 5, 1}, {moving(3, 0.1)});
  const Reply first = reply_to(handler, request);
  EXPECT_TRUE(reply_to(handler, request_bytes({kNow, 6, 1}, {moving(2, 0.1)})).loads.empty());
  EXPECT_EQ(reply_to(handler, request), first);
  EXPECT_EQ(handler.counters().retries, 1);
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

// At the centre of the drag, else of the added mass, else at the origin of the body.
TEST(RequestHandlerWithLoads, WaterMovesWithCurrentAndWaves) {
  const std::string head = "[[body]]\noutputs = [\"wrench\", \"loads\"]\nshape = { type = \"box\" }\nid = ";
  const std::string drag = "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\ncenter = [0.1, 0, -0.2]\n";
  const std::string mass = "[body.added_mass]\nmatrix = [5, 6, 7, 8, 9, 10]\ncenter = [-0.3, 0.2, 0]\n";
  const Scene scene =
      scene_of(kSea + head + "1\n" + drag + head + "2\n" + mass + head + "3\n" + drag + mass + head + "4\n");
  RequestHandler handler(scene);
  SeaSnapshot snapshot(*scene.sea());
  const Vec3 current_W(0.3, -0.2, 0.1);
  const Vec3 of_drag(0.1, 0.0, -0.2), of_mass(-0.3, 0.2, 0.0);
  const std::vector<Vec3> centers{of_drag, of_mass, of_drag, Vec3::Zero()};
  const Eigen::Quaterniond q(0.8, 0.0, 0.6, 0.0);
  for (int i = 0; i < 5; ++i) {
    const std::int64_t utime = kNow + 700'000 * i;
    const std::vector<BodyState> states{moving(1, -2), moving(2, -2), moving(3, -2), moving(4, -2)};
    const Answer answer = ask(handler, states, utime);
    snapshot.set_time(utime);
    const auto at = [&](const Vec3& center) { return snapshot.at(to_vec3(states[0].position) + q * center); };
    for (std::size_t body = 0; body < 4; ++body) {
      const Vec3 expected = current_W + at(centers[body]).velocity_W;
      EXPECT_LE((to_vec3(answer.loads.bodies[body].water_velocity) - expected).norm(), 1e-12) << body;
      EXPECT_GT((expected - current_W).norm(), 0.0);
    }
    // The drag of body 3 is that of body 1, and its added mass that of body 2: each in the water of its
    // place.
    const BodyLoads& both = answer.loads.bodies[2];
    EXPECT_LE((to_vec3(both.drag_force) - to_vec3(answer.loads.bodies[0].drag_force)).norm(), 1e-12);
    EXPECT_LE((to_vec3(both.added_mass_force) - to_vec3(answer.loads.bodies[1].added_mass_force)).norm(),
              1e-12);
    EXPECT_LE((to_vec3(both.added_mass_torque) - to_vec3(answer.loads.bodies[1].added_mass_torque)).norm(),
              1e-12);
  }
}

// At the centre of the drag, else of the added mass, else at the origin of the body, at rest and in waves.
TEST(RequestHandlerWithLoads, CurrentIsThatAtTheHeightOfTheLoad) {
  const std::string profile =
      "[[water.current.profile]]\nheight = 0\nvelocity = [0.8, 0, 0]\n"
      "[[water.current.profile]]\nheight = -4\nvelocity = [0, 0.4, 0]\n";
  const auto box = [](int id, const std::string& more) {
    return "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\" }\noutputs = [\"wrench\", " +
           "\"loads\"]\n" + more;
  };
  const std::string drag = "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\ncenter = [0, 0, -0.2]\n";
  const std::string mass = "[body.added_mass]\nmatrix = [5, 6, 7, 8, 9, 10]\ncenter = [0, 0, 0.3]\n";
  const std::vector<double> offsets{-0.2, 0.3, -0.2, 0.0};
  const std::string swell = "[[water.waves]]\ntype = \"regular\"\nheight = 0.3\nperiod = 3\ndirection = 20\n";
  for (const std::string& waves : {std::string(), swell}) {
    const Scene scene = scene_of("[water]\nlevel = 10\n" + profile + waves + box(1, drag) + box(2, mass) +
                                 box(3, drag + mass) + box(4, ""));
    WaterAtTime times(scene);
    const WaterState water = times.move_to(kNow, 0.0).water;
    for (const double height : {0.1, -1.0, -3.0, -9.0}) {
      const Pose pose{.p_WB = Vec3(1, 2, 10.0 + height)};
      for (std::size_t i = 0; i < 4; ++i) {
        const Body& of = scene.bodies()[i];
        BodyOutcome outcome;
        evaluate(of, water, {.status = BodyStatus::kOk, .pose = pose}, outcome);
        BodyWrench wrench = to_wrench(of.id, outcome);
        BodyLoads loads;
        add_loads(of, water, scene.current(), pose, {}, outcome, wrench, &loads);
        const double share = std::clamp((height + offsets[i]) / -4.0, 0.0, 1.0);
        Vec3 expected = (1.0 - share) * Vec3(0.8, 0, 0) + share * Vec3(0, 0.4, 0);
        if (water.waves != nullptr) {
          expected += water.waves->at(pose.p_WB + Vec3(0, 0, offsets[i])).velocity_W;
        }
        EXPECT_LE((to_vec3(loads.water_velocity) - expected).norm(), 1e-13) << height << ", body " << of.id;
      }
    }
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
    Reply expected;
    for (const unsigned threads : {1U, 2U, 8U}) {
      RequestHandler handler(scene, {.threads = threads});
      const Reply reply = reply_to(handler, request);
      if (threads == 1) expected = reply;
      EXPECT_EQ(reply, expected) << threads;
    }
  }
}

TEST(RequestHandlerWithLoads, DoesNotAllocateAfterWarmUp) {
  for (const std::string& water : {std::string("[water.current]\nvelocity = [1, 0, 0]\n"), kSea}) {
    const Scene scene = scene_of(boxes(water) +
                                 "[[body]]\nid = 5\nmethod = \"exact_surface\"\n"
                                 "shape = { type = \"rock\", radius = 0.6, frequency = 6, seed = 2 }\n");
    RequestHandler handler(scene, {.threads = 1});
    std::vector<ByteVector> requests;
    for (std::int64_t seq = 0; seq < 40; ++seq) {
      const double height = -1.5 + 0.075 * static_cast<double>(seq);
      std::vector<BodyState> states;
      for (std::int32_t id = 1; id <= 5; ++id) states.push_back(moving(id, height));
      requests.push_back(request_bytes({kNow + 50'000 * seq, 1, seq}, states));
    }
    for (const ByteVector& request : requests) handler.handle(request);
    const AllocationCount allocations;
    for (const ByteVector& request : requests) ASSERT_FALSE(handler.handle(request).empty());
    EXPECT_EQ(allocations.count(), 0);
  }
}

// Hill climbing over heights and attitudes: the largest share(state), from random starts.
template <typename Share>
double largest_share(int starts, const Share& share) {
  std::mt19937 random(8);
  double largest = 0.0;
  for (int start = 0; start < starts; ++start) {
    BodyState state = moving(1, 0.9 * random_number(random));
    double best = 0.0;
    for (double step = 1.0; step > 1e-4; step *= 0.97) {
      BodyState moved = state;
      moved.position[2] += 0.3 * step * random_number(random);
      double norm = 0.0;
      for (double& q : moved.quaternion_wxyz) q += step * random_number(random), norm += q * q;
      for (double& q : moved.quaternion_wxyz) q /= std::sqrt(norm);
      const double found = share(moved);
      if (found > best) best = found, state = moved;
    }
    largest = std::max(largest, best);
  }
  return largest;
}

// Between the truth of a body and its published load lies the error of its volume. Loads along one axis,
// which the body moves along, reach what that error allows.
TEST(RequestHandlerWithLoads, BoundContainsTheErrorOfTheImmersion) {
  const std::string rock = "shape = { type = \"rock\", radius = 1, frequency = 12, seed = 4 }\n";
  const std::string drag = "[body.drag]\nlinear = [1e6, 0, 0, 0, 0, 0]\ncenter = [0, 0, 0]\n";
  const std::string mass = "[body.added_mass]\nmatrix = [1e6, 0, 0, 0, 0, 0]\ncenter = [0, 0, 0]\n";
  for (const auto& [name, water, tight, starts, least] :
       {std::tuple{"at rest", std::string(), "0", 12, 0.3}, {"in waves", kSea, "1e-5", 2, 0.2}}) {
    for (const std::string& table : {drag, mass}) {
      const Scene scene = scene_of(water + "[[body]]\nid = 1\ntolerance = 1e-2\n" + rock + table +
                                   "[[body]]\nid = 2\ntolerance = " + tight + "\n" + rock + table);
      RequestHandler handler(scene);
      const double reached = largest_share(starts, [&](BodyState state) {
        const auto& [w, x, y, z] = state.quaternion_wxyz;
        const Eigen::Quaterniond q(w, x, y, z);
        state.linear_velocity = to_array(Vec3(q * Vec3(3.0, 0.0, 0.0)));
        state.angular_velocity = to_array(Vec3(q * Vec3(0.0, 0.0, 2.0)));
        BodyState exact = state;
        exact.body_id = 2;
        const Answer answer = ask(handler, {state, exact});
        const BodyWrench& rough = answer.response.bodies[0];
        const BodyWrench& fine = answer.response.bodies[1];
        const Vec6 error = wrench_of(rough) - wrench_of(fine);
        EXPECT_LE(error.head<3>().norm(), rough.force_error_bound + fine.force_error_bound);
        EXPECT_LE(error.tail<3>().norm(), rough.torque_error_bound + fine.torque_error_bound);
        return error.head<3>().norm() / rough.force_error_bound;
      });
      EXPECT_GT(reached, least) << table << name;
      RecordProperty((table == drag ? "drag " : "added mass ") + std::string(name), std::to_string(reached));
    }
  }
}

// A box of which the drag at half its draught is 20 N: what is not known of its immersion is in the bound.
TEST(RequestHandlerWithLoads, BoundHasWhatIsNotKnownOfTheImmersion) {
  const auto bound_of = [](const std::string& head, const std::string& keys, double height) {
    const Scene scene = scene_of(head + "[[body]]\nid = 1\nshape = { type = \"box\" }\n" + keys);
    RequestHandler handler(scene);
    BodyState state = upright(1, height);
    state.linear_velocity = {2.0, 0.0, 0.0};
    return ask(handler, {state}).response.bodies[0].force_error_bound;
  };
  const std::string drag = "[body.drag]\nlinear = [20, 0, 0, 0, 0, 0]\n";
  EXPECT_LT(bound_of("", drag, 0.2), 1e-8);
  EXPECT_NEAR(bound_of("[world]\ngravity = 0\n", drag, 0.2), 0.7 * 40.0, 1e-9)
      << "without gravity the force says nothing of the volume, which is from 0 to all of it";
  EXPECT_NEAR(bound_of("[world]\ngravity = 0\n", drag, -0.2), 0.7 * 40.0, 1e-9);
}

// Where it is not known whether a body touches the water, drag that nothing scales is all or nothing.
TEST(RequestHandlerWithLoads, BoundHasAllOfTheDragWhereContactIsUndecided) {
  const std::string rock = "tolerance = 0.1\nshape = { type = \"rock\", frequency = 12, seed = 4 }\n";
  const Scene scene =
      scene_of("[[body]]\nid = 1\n" + rock +
               "[body.drag]\nlinear = [20, 0, 0, 0, 0, 0]\nimmersion = \"none\"\n[[body]]\nid = 2\n" + rock);
  RequestHandler handler(scene);
  int undecided = 0;
  int decided = 0;
  for (double height = 1.2; height > 0.2; height -= 0.005) {
    std::vector<BodyState> states{upright(1, height), upright(2, height)};
    states[0].linear_velocity = {2.0, 0.0, 0.0};
    const auto bodies = ask(handler, states).response.bodies;
    const double of_drag = bodies[0].force_error_bound - bodies[1].force_error_bound;
    const double volume_error = bodies[1].force_error_bound / (kSeawaterDensity * kStandardGravity);
    if (bodies[1].submerged_volume == 0.0 && volume_error == 0.0) continue;
    const bool is_open = std::abs(bodies[1].submerged_volume) <= volume_error;
    ++(is_open ? undecided : decided);
    EXPECT_NEAR(of_drag, is_open ? 40.0 : 0.0, 1e-6) << height;
  }
  EXPECT_GT(undecided, 0);
  EXPECT_GT(decided, 20);
}

TEST(FlowAtBody, BoundsGrowWithDistanceSteepnessAndComponents) {
  struct Errors {
    double velocity, acceleration;
  };
  const auto errors_at = [](const std::string& waves, const Vec3& p_W, double level = 0.0) {
    const Scene scene = scene_of("[water]\nlevel = " + format_shortest(level) + "\nwaves = [" + waves +
                                 "]\n[[body]]\nid = 1\nshape = { type = \"box\" }\n");
    WaterAtTime water(scene);
    const FlowAtBody motion = flow_at_body(water.move_to(kNow, 0.0).water, Current{}, p_W);
    return Errors{motion.velocity_error, motion.acceleration_error};
  };
  const std::string wave = "{ type = \"regular\", height = 0.2, period = 3.0 }";
  const double w = 2.0 * std::numbers::pi / 3.0;
  const double k = w * w / kStandardGravity;
  const double steepness = 0.1 * k;
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const Errors near = errors_at(wave, Vec3::Zero());
  EXPECT_NEAR(near.acceleration / (kStandardGravity * steepness * (1e-14 + kEpsilon)), 1.0, 1e-9);
  // Position and level are rounded: every metre along any axis, in either direction, adds as much.
  const double per_metre = kStandardGravity * steepness * 8.0 * kEpsilon * k * (1.0 + steepness);
  for (const Vec3& p_W : {Vec3(1e6, 0, 0), Vec3(0, -2e6, 0), Vec3(3e5, 4e5, -7.0)}) {
    const Errors far = errors_at(wave, p_W);
    EXPECT_NEAR((far.acceleration - near.acceleration) / (per_metre * p_W.lpNorm<1>()), 1.0, 1e-6);
    EXPECT_NEAR(far.velocity * w / far.acceleration, 1.0, 1e-9);
  }
  for (const double level : {-3e6, 3e6}) {
    const Errors high = errors_at(wave, Vec3::Zero(), level);
    EXPECT_NEAR((high.acceleration - near.acceleration) / (per_metre * 3e6), 1.0, 1e-6);
  }
  // A second, slower wave adds its steepness and a component; the slowest bounds the velocity.
  const Errors two = errors_at(wave + ", { type = \"regular\", height = 0.1, period = 9.0 }", Vec3::Zero());
  const double of_both = steepness + 0.05 * k / 9.0;
  EXPECT_NEAR(two.acceleration / (kStandardGravity * of_both * (1e-14 + 2.0 * kEpsilon)), 1.0, 1e-9);
  EXPECT_NEAR(two.velocity * (w / 3.0) / two.acceleration, 1.0, 1e-9);
}

}  // namespace
}  // namespace buoyancy
