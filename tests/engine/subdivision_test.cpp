// Bodies of several parts, with compartments that are open to the sea and with tanks.
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "engine/subdivision_load.h"
#include "engine/water_at_time.h"
#include "messages/conversions.h"
#include "tests/engine/evaluate.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

const std::string kWater = "[water]\ndensity = 1000.0\n";
const std::string kSwell =
    "[water]\nwaves = [{ type = \"regular\", height = 0.5, period = 3.0, direction = 20.0 }, { type = "
    "\"regular\", height = 0.2, period = 1.9, direction = -70.0 }]\n";

std::string box(const std::string& sizes, const std::string& position = "[0, 0, 0]") {
  return "shape = { type = \"box\", size = " + sizes + " }\nposition = " + position + "\n";
}

std::string body(int id, const std::string& sizes) {
  return "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = " + sizes + " }\n";
}

const BoundingBox kHullBox{Vec3(-2.0, -1.0, -0.75), Vec3(2.0, 1.0, 0.75)};

struct Evaluated {
  BodyOutcome outcome;
  BodyWrench wrench;
};

Evaluated evaluated(const Scene& scene, std::int32_t id, const Pose& pose,
                    const BodyCondition* condition = nullptr) {
  const Body& body = *scene.find(id);
  WaterAtTime water(scene);
  const WaterState now = water.move_to(1'790'000'000'000'000, 0.0).water;
  Evaluated result;
  evaluate(body, now, {.status = BodyStatus::kOk, .pose = pose}, result.outcome, condition);
  result.wrench = to_wrench(id, result.outcome);
  return result;
}

void expect_equal(const BuoyancyResult& a, const BuoyancyResult& b, double relative,
                  const std::string& where) {
  const double force = 1000.0 * 9.80665 * 12.0;
  EXPECT_LE((a.force_W - b.force_W).norm(), relative * force) << where;
  EXPECT_LE((a.torque_W - b.torque_W).norm(), relative * force * 2.0) << where;
  EXPECT_LE(std::abs(a.volume - b.volume), relative * 12.0) << where;
  EXPECT_LE((a.center_of_buoyancy_W - b.center_of_buoyancy_W).norm() * std::abs(a.volume), relative * 24.0)
      << where;
}

void expect_within_bounds(const BuoyancyResult& a, const BuoyancyResult& b, const std::string& where) {
  EXPECT_LE((a.force_W - b.force_W).norm(), a.force_error_bound + b.force_error_bound) << where;
  EXPECT_LE((a.torque_W - b.torque_W).norm(), a.torque_error_bound + b.torque_error_bound) << where;
}

// 4 x 2 x 1.5 m, with its last metre flooded, and with what is left of it as meshes.
std::string flooded_hulls() {
  return body(1, "[4, 2, 1.5]") + "[[body.compartment]]\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]") +  //
         body(2, "[4, 2, 1.5]") + "[[body.compartment]]\n" + box("[1, 2, 1.5]", "[0.5, 0, 0]") +  //
         "[[body]]\nid = 3\n[[body.part]]\n" + box("[3, 2, 1.5]", "[-0.5, 0, 0]") +               //
         "[[body]]\nid = 4\n[[body.part]]\n" + box("[2, 2, 1.5]", "[-1, 0, 0]") +                 //
         "[[body.part]]\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]");
}

TEST(Compartment, TakesWhatItWouldDisplace) {
  const Scene scene = scene_of(kWater + flooded_hulls());
  RandomPoses random(81);
  for (int i = 0; i < 300; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    for (const auto& [flooded, cut] : {std::pair{1, 3}, std::pair{2, 4}}) {
      const BuoyancyResult a = evaluated(scene, flooded, pose).outcome.result;
      const BuoyancyResult b = evaluated(scene, cut, pose).outcome.result;
      const std::string where = "body " + std::to_string(flooded) + ", pose " + std::to_string(i);
      expect_equal(a, b, 1e-14, where);
      expect_within_bounds(a, b, where);
    }
  }
}

TEST(Compartment, TakesWhatItWouldDisplaceInWaves) {
  const Scene scene = scene_of(kSwell + flooded_hulls());
  RandomPoses random(82);
  for (int i = 0; i < 60; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    for (const auto& [flooded, cut] : {std::pair{1, 3}, std::pair{2, 4}}) {
      const Evaluated a = evaluated(scene, flooded, pose);
      const Evaluated b = evaluated(scene, cut, pose);
      const std::string where = "body " + std::to_string(flooded) + ", pose " + std::to_string(i);
      expect_within_bounds(a.outcome.result, b.outcome.result, where);
      EXPECT_LE(std::abs(a.outcome.result.volume - b.outcome.result.volume),
                a.outcome.in_waves.volume_error_bound + b.outcome.in_waves.volume_error_bound)
          << where;
    }
  }
}

TEST(Compartment, CountsByPermeabilityAndFloodedShare) {
  const Scene scene =
      scene_of(kWater + body(1, "[4, 2, 1.5]") + body(2, "[4, 2, 1.5]") +
               "[[body.compartment]]\npermeability = 0.6\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]") +
               body(3, "[4, 2, 1.5]") + "[[body.compartment]]\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]"));
  RandomPoses random(83);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    const Vec3 intact = evaluated(scene, 1, pose).outcome.result.force_W;
    const Vec3 flooded = evaluated(scene, 3, pose).outcome.result.force_W;
    const BodyCondition half{.flooded = {0.5}, .liquid_volumes = {}};
    const BodyCondition none{.flooded = {0.0}, .liquid_volumes = {}};
    const double scale = 1e-12 * 12.0e4;
    EXPECT_LE((evaluated(scene, 2, pose).outcome.result.force_W - (0.4 * intact + 0.6 * flooded)).norm(),
              scale);
    EXPECT_LE(
        (evaluated(scene, 2, pose, &half).outcome.result.force_W - (0.7 * intact + 0.3 * flooded)).norm(),
        scale);
    EXPECT_EQ(evaluated(scene, 3, pose, &none).outcome.result.force_W, intact);
  }
}

// What a compartment would displace has an error of its own, which flooding adds, whatever its sign.
TEST(Compartment, AddsItsBoundsAsFarAsItIsFlooded) {
  const std::string room = box("[1, 1.4, 1.1]", "[1.3, 0.2, -0.1]");
  for (const std::string& water : {kWater, kSwell}) {
    const Scene scene =
        scene_of(water + body(1, "[4, 2, 1.5]") +
                 "reference_point = [-0.5, 0.3, 0.2]\n[[body.compartment]]\npermeability = "
                 "0.7\nflooded = 0\n" +
                 room + "[[body]]\nid = 2\nreference_point = [-0.5, 0.3, 0.2]\n" + "[[body.part]]\n" + room);
    RandomPoses random(89);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose pose = random.crossing(kHullBox, scene.water());
      const BodyOutcome hull = evaluated(scene, 1, pose).outcome;
      const BodyOutcome lost = evaluated(scene, 2, pose).outcome;
      if (lost.result.volume == 0.0) continue;
      ++compared;
      for (const double flooded : {0.25, 1.0}) {
        const BodyCondition condition{.flooded = {flooded}, .liquid_volumes = {}};
        const BodyOutcome both = evaluated(scene, 1, pose, &condition).outcome;
        const double share = 0.7 * flooded;
        EXPECT_NEAR(both.result.force_error_bound,
                    hull.result.force_error_bound + share * lost.result.force_error_bound,
                    1e-9 * both.result.force_error_bound);
        EXPECT_NEAR(both.result.torque_error_bound,
                    hull.result.torque_error_bound + share * lost.result.torque_error_bound,
                    1e-9 * both.result.torque_error_bound);
        EXPECT_NEAR(both.in_waves.volume_error_bound,
                    hull.in_waves.volume_error_bound + share * lost.in_waves.volume_error_bound,
                    1e-9 * both.in_waves.volume_error_bound);
      }
    }
    EXPECT_GT(compared, 30);
  }
}

// Lost buoyancy and added weight are two views of the same water.
TEST(Compartment, PullsAsTheWaterInIt) {
  const Scene scene =
      scene_of(kWater + body(1, "[4, 2, 1.5]") + "[[body.compartment]]\n" +
               box("[1, 1.2, 1.5]", "[0.5, 0.4, 0]") + body(2, "[4, 2, 1.5]") +
               "[[body.tank]]\ndensity = 1000.0\nfill = 0\n" + box("[1, 1.2, 1.5]", "[0.5, 0.4, 0]"));
  RandomPoses random(84);
  for (int i = 0; i < 200; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    const Evaluated lost = evaluated(scene, 1, pose);
    const BodyCondition up_to_sea{.flooded = {},
                                  .liquid_volumes = {std::min(lost.outcome.flooded_volume, 1.8)}};
    const BuoyancyResult added = evaluated(scene, 2, pose, &up_to_sea).outcome.result;
    const double scale = 1000.0 * 9.80665 * 12.0;
    EXPECT_LE((lost.outcome.result.force_W - added.force_W).norm(), 1e-14 * scale) << i;
    EXPECT_LE((lost.outcome.result.torque_W - added.torque_W).norm(), 1e-13 * scale) << i;
  }
}

TEST(Tank, PullsWithItsWeightAlsoInTheAir) {
  const Scene scene = scene_of(kWater + body(1, "[4, 2, 1.5]") +
                               "reference_point = [1, 0, 0]\n[[body.tank]]\ndensity = 800.0\nfill = 1.0\n" +
                               box("[1, 1, 0.5]", "[-1, 0.5, 0]"));
  const Pose high{.p_WB = {5.0, 6.0, 50.0}, .q_WB = Eigen::Quaterniond::Identity()};
  const BuoyancyResult result = evaluated(scene, 1, high).outcome.result;
  const double weight = 800.0 * 0.5 * 9.80665;
  EXPECT_EQ(result.volume, 0.0);
  EXPECT_LE((result.force_W - Vec3(0, 0, -weight)).norm(), 1e-12 * weight);
  EXPECT_LE((result.torque_W - Vec3(-2.0, 0.5, 0.0).cross(Vec3(0, 0, -weight))).norm(), 1e-12 * weight);
  EXPECT_GT(result.force_error_bound, 0.0);
  EXPECT_LT(result.torque_error_bound, 1e-11 * weight);
}

// Rounding of the weight and of its lever, of the tank's volume, of which the liquid is a share, and of the
// volume under the surface that was found. Each is far below the others in one of the cases.
TEST(Tank, AddsTheBoundsOfItsWeight) {
  constexpr double kEpsilon = 2.220446049250313e-16;
  for (const std::string& shape :
       {box("[1, 1.2, 0.8]", "[-1, 0.5, 0]"), box("[1, 1, 0.00001]", "[-1, 0.5, 0.3]"),
        box("[0.9, 1.1, 0.7]", "[-1, 0.5, 0.3]") + "orientation = [0.9, 0.3, 0.1, 0.2]\n"}) {
    for (const double fill : {0.3, 1.0}) {
      const Scene scene = scene_of(kWater + body(1, "[4, 2, 1.5]") +
                                   "reference_point = [30, -40, 7]\n[[body.tank]]\ndensity = 800.0\nfill = " +
                                   format_shortest(fill) + "\n" + shape);
      const Pose high{.p_WB = {5.0, 6.0, 500.0}, .q_WB = {0.8, 0.3, -0.4, 0.2}};
      const BuoyancyResult result = evaluated(scene, 1, high).outcome.result;
      const BodyTank& given = scene.find(1)->subdivision->tanks[0];
      const Tank tank = with_liquid(given, given.liquid_volume);
      const Vec3 up_B = high.q_WB.normalized().conjugate() * Vec3::UnitZ();
      const double weight = 800.0 * 9.80665 * tank.liquid_volume;
      const double of_mesh = 800.0 * 9.80665 * tank.mesh->rounding_bound();
      const double of_level = 800.0 * 9.80665 * tank_liquid(tank, up_B).volume_error;
      const double lever = tank.mesh->max_lever_arm(Vec3(30, -40, 7));
      EXPECT_NEAR(result.force_error_bound / (4.0 * kEpsilon * weight + of_mesh), 1.0, 1e-9);
      EXPECT_NEAR(result.torque_error_bound / ((16.0 * kEpsilon * weight + of_mesh + of_level) * lever), 1.0,
                  1e-9);
    }
  }
}

// The share is of the tank as it is, whose volume rounding makes a little wrong.
TEST(Tank, BoundsTheErrorOfAVolumeGivenAsAShare) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  double reached = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double thickness = std::pow(10.0, 3.0 * uniform(random));
    const Vec3 position{9.0 * uniform(random), 9.0 * uniform(random), 9.0 * uniform(random)};
    const Scene scene =
        scene_of(kWater + body(1, "[40, 40, 40]") + "[[body.tank]]\ndensity = 1000.0\nfill = 0.5\n" +
                 box("[1, 1, " + format_shortest(thickness) + "]", "[" + format_vector(position) + "]") +
                 "orientation = [0.9, " + format_shortest(uniform(random)) + ", 0.1, 0.2]\n");
    const Pose high{.p_WB = {0.0, 0.0, 1e5}, .q_WB = Eigen::Quaterniond::Identity()};
    const BuoyancyResult result = evaluated(scene, 1, high).outcome.result;
    const double weight = 500.0 * kStandardGravity * thickness;
    reached = std::max(reached, std::abs(result.force_W.z() + weight) / result.force_error_bound);
    EXPECT_LE(result.force_error_bound, 1e-9 * (1.0 + weight));
  }
  EXPECT_LE(reached, 1.0);
  EXPECT_GT(reached, 0.08) << "the bound is of the size of the errors";
  RecordProperty("reached", std::to_string(reached));
}

// In the air all bounds are those of the tanks: those of a larger body grow with its volume and lever, those
// of a distant reference point with the lever, and those of several tanks add up.
TEST(Tank, BoundsFollowSizeDensityLeverAndNumber) {
  const auto bounds_of = [](double scale, double density, const Vec3& reference_B, int tanks) {
    const auto vector = [&](const Vec3& v) { return "[" + format_vector(scale * v, 17) + "]"; };
    std::string text =
        kWater + body(1, vector({8, 6, 4})) + "reference_point = " + vector(reference_B) + "\n";
    for (int i = 0; i < tanks; ++i) {
      text += "[[body.tank]]\ndensity = " + format_shortest(density) + "\nfill = 0.4\n" +
              box(vector({1, 2, 0.5}), vector({1, -0.5, 0.25})) + "orientation = [0.9, 0.3, 0.1, 0.2]\n";
    }
    const Pose high{.p_WB = {0, 0, 100.0 * scale}, .q_WB = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5)};
    const BuoyancyResult result = evaluated(scene_of(text), 1, high).outcome.result;
    return std::pair{result.force_error_bound, result.torque_error_bound};
  };
  const auto expect_ratios = [](const auto& larger, const auto& smaller, double of_force, double of_torque) {
    EXPECT_NEAR(larger.first / smaller.first, of_force, 1e-6 * of_force);
    EXPECT_NEAR(larger.second / smaller.second, of_torque, 1e-6 * of_torque);
  };
  const Vec3 reference_B(0.5, 0.25, -1.0);
  const auto one = bounds_of(1.0, 800.0, reference_B, 1);
  for (const double scale : {1.0 / 1024.0, 1024.0}) {
    expect_ratios(bounds_of(scale, 800.0, reference_B, 1), one, std::pow(scale, 3), std::pow(scale, 4));
  }
  expect_ratios(bounds_of(1.0, 2400.0, reference_B, 1), one, 3.0, 3.0);
  expect_ratios(bounds_of(1.0, 800.0, reference_B, 2), one, 2.0, 2.0);
  for (const Vec3& far_B : {Vec3(5000, 0, 0), Vec3(0, -5000, 0), Vec3(0, 0, 5000)}) {
    const auto far = bounds_of(1.0, 800.0, far_B, 1);
    EXPECT_EQ(far.first, one.first);
    EXPECT_NEAR(far.second / bounds_of(1.0, 800.0, 2.0 * far_B, 1).second, 0.5, 1e-3);
    // Half of an error of the volume turns as much as an error of the weight.
    EXPECT_GE(far.second, 4990.0 * far.first);
  }
}

// A flooded body has the bounds of its hull, and of what each compartment would displace times its share.
TEST(Compartment, BoundsAddUp) {
  const std::string keys = "tolerance = 1e-3\nreference_point = [0.7, -0.4, 0.2]\n";
  const std::string bow = box("[1, 1.5, 1.2]", "[1.2, 0.2, 0.1]"),
                    stern = box("[1.4, 1, 0.8]", "[-1.1, -0.3, 0]");
  const auto alone = [&](int id, const std::string& part) {
    return "[[body]]\nid = " + std::to_string(id) + "\n" + keys + "[[body.part]]\n" + part;
  };
  const std::string bodies =
      body(1, "[4, 2, 1.5]") + keys + "[[body.compartment]]\npermeability = 0.6\nflooded = 0.5\n" + bow +
      "[[body.compartment]]\n" + stern + body(2, "[4, 2, 1.5]") + keys + alone(3, bow) + alone(4, stern);
  for (const std::string& water : {kWater, kSwell}) {
    const Scene scene = scene_of(water + bodies);
    RandomPoses random(89);
    for (int i = 0; i < (water == kWater ? 200 : 20); ++i) {
      const Pose pose = random.crossing(kHullBox, scene.water());
      std::vector<BodyOutcome> of;
      for (std::int32_t id = 1; id <= 4; ++id) of.push_back(evaluated(scene, id, pose).outcome);
      const auto expect_sum = [&](const auto& bound) {
        const double sum = bound(of[1]) + 0.3 * bound(of[2]) + bound(of[3]);
        EXPECT_NEAR(bound(of[0]), sum, 1e-12 * sum) << i;
      };
      expect_sum([](const BodyOutcome& o) { return o.result.force_error_bound; });
      expect_sum([](const BodyOutcome& o) { return o.result.torque_error_bound; });
      expect_sum([](const BodyOutcome& o) { return o.in_waves.volume_error_bound; });
      EXPECT_NEAR(of[0].flooded_volume, 0.3 * of[2].result.volume + of[3].result.volume, 1e-12);
    }
  }
}

// The torque about a horizontal axis is minus the derivative of the energies of displaced water and liquid.
TEST(Tank, HasTheWrenchOfAnEnergy) {
  const Scene scene =
      scene_of(kWater + body(1, "[4, 2, 1.5]") + "[[body.tank]]\ndensity = 1300.0\nfill = 0.45\n" +
               box("[1.5, 1.6, 1]", "[0.3, -0.1, 0.1]") + "orientation = [0.9, 0.3, 0.1, 0.2]\n");
  RandomPoses random(85);
  for (int i = 0; i < 40; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    const Vec3 axis = random.direction();
    const BuoyancyResult at = evaluated(scene, 1, pose).outcome.result;
    // Work along a small turn there and back differs by the curvature alone.
    const auto turned = [&](double angle) {
      Pose moved = pose;
      moved.q_WB = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * pose.q_WB.normalized();
      return moved;
    };
    const auto energy = [&](double angle) {
      const Pose moved = turned(angle);
      const Body& body = *scene.find(1);
      const Tank tank = with_liquid(body.subdivision->tanks[0], body.subdivision->tanks[0].liquid_volume);
      const Vec3 up_B = moved.q_WB.conjugate() * Vec3::UnitZ();
      const double liquid =
          tank.liquid_mass() * up_B.dot(tank.mesh->center_B + tank_liquid(tank, up_B).centroid);
      const BuoyancyResult hull = buoyancy(body.solver, moved, scene.water(), Vec3::Zero());
      const double height = moved.p_WB.z() + hull.center_of_buoyancy_W.z();
      return 9.80665 * (liquid - 1000.0 * hull.volume * height);
    };
    const double step = 1e-4;
    EXPECT_NEAR(-(energy(step) - energy(-step)) / (2.0 * step), axis.dot(at.torque_W), 1e-2) << i;
  }
}

std::string hydrostatic(const std::string& text) {
  return text + "outputs = [\"wrench\", \"hydrostatics\"]\n";
}

BodyHydrostatics hydrostatics_at(const Scene& scene, std::int32_t id, const Pose& pose) {
  ServiceCounters counters;
  return evaluate_hydrostatics(*scene.find(id), scene.water(), pose, BodyStatus::kOk, counters);
}

TEST(Subdivision, HasTheStiffnessOfItsWrench) {
  const Scene scene = scene_of(kWater + hydrostatic(body(1, "[4, 2, 1.5]")) +
                               "reference_point = [0.2, 0.1, -0.3]\n[[body.compartment]]\n" +
                               box("[1, 2, 1.5]", "[1.5, 0, 0]") +
                               "permeability = 0.7\n[[body.tank]]\ndensity = 1300.0\nfill = 0.45\n" +
                               box("[1.5, 1.6, 1]", "[0.3, -0.1, 0.1]"));
  const Vec3 reference_B(0.2, 0.1, -0.3);
  RandomPoses random(86);
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    const BodyHydrostatics found = hydrostatics_at(scene, 1, pose);
    if (!(found.waterplane_area > 0.5)) continue;
    ++compared;
    for (int column = 0; column < 6; ++column) {
      const auto moved = [&](double step) {
        Vec3 p = Vec3::Zero();
        Vec3 theta = Vec3::Zero();
        (column < 3 ? p : theta)[column % 3] = step;
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(theta.norm(), theta.normalized()));
        const Eigen::Quaterniond q = pose.q_WB.normalized();
        const Vec3 reference_W = pose.p_WB + q * reference_B + p;
        Pose result;
        result.q_WB = theta.norm() > 0.0 ? turn * q : q;
        result.p_WB = reference_W - result.q_WB * reference_B;
        return evaluated(scene, 1, result).outcome.result;
      };
      constexpr double kStep = 1e-6;
      const BuoyancyResult after = moved(kStep);
      const BuoyancyResult before = moved(-kStep);
      const Vec3 force = -(after.force_W - before.force_W) / (2.0 * kStep);
      const Vec3 torque = -(after.torque_W - before.torque_W) / (2.0 * kStep);
      for (std::size_t row = 0; row < 3; ++row) {
        const auto n = static_cast<std::size_t>(column);
        const auto r = static_cast<Eigen::Index>(row);
        EXPECT_NEAR(found.stiffness[row][n], force[r], 0.5) << i << ", column " << column;
        EXPECT_NEAR(found.stiffness[row + 3][n], torque[r], 1.0) << i << ", column " << column;
      }
    }
  }
  EXPECT_GT(compared, 30);
}

// GG' = rho_f i / (rho V), and n equal partitions take n^2 times less.
TEST(Tank, LowersTheMetacentricHeightByItsFreeSurface) {
  const std::string client = "[body.client]\nmass = 4000.0\ncenter_of_mass = [0, 0, 0]\n";
  const auto tank = [](double width, double y) {
    return "[[body.tank]]\ndensity = 900.0\nfill = 0.5\n" +
           box("[3, " + format_shortest(width) + ", 1]", "[0, " + format_shortest(y) + ", 0]");
  };
  const auto solid = [](double width, double y) {
    return "[[body.tank]]\ndensity = 900.0\nfill = 1.0\n" +
           box("[3, " + format_shortest(width) + ", 0.5]", "[0, " + format_shortest(y) + ", -0.25]");
  };
  const Scene scene = scene_of(kWater + hydrostatic(body(1, "[4, 2, 1.5]")) + client + solid(1.8, 0.0) +
                               hydrostatic(body(2, "[4, 2, 1.5]")) + client + tank(1.8, 0.0) +
                               hydrostatic(body(3, "[4, 2, 1.5]")) + client + tank(0.6, -0.6) +
                               tank(0.6, 0.0) + tank(0.6, 0.6));
  const Pose afloat{.p_WB = {0, 0, -0.05}, .q_WB = Eigen::Quaterniond::Identity()};
  const BodyHydrostatics frozen = hydrostatics_at(scene, 1, afloat);
  const BodyHydrostatics liquid = hydrostatics_at(scene, 2, afloat);
  const BodyHydrostatics divided = hydrostatics_at(scene, 3, afloat);
  const double rise = 900.0 * (3.0 * 1.8 * 1.8 * 1.8 / 12.0) / (1000.0 * frozen.submerged_volume);
  EXPECT_NEAR(frozen.metacentric_heights[0] - liquid.metacentric_heights[0], rise, 1e-12);
  EXPECT_NEAR(frozen.metacentric_heights[0] - divided.metacentric_heights[0], rise / 9.0, 1e-12);
  const double expected_kg = (2.7 * 900.0 * -0.25) / (4000.0 + 2.7 * 900.0);
  EXPECT_NEAR(frozen.metacentric_heights[0],
              frozen.center_of_buoyancy[2] + frozen.metacentric_radii[0] - expected_kg, 1e-12);
}

TEST(Part, MakesTheSameBodyAsOneWeldedMesh) {
  for (const std::string& water : {kWater, kSwell}) {
    const Scene scene = scene_of(water + body(1, "[4, 2, 1.5]") + body(2, "[1, 2, 1.5]") + "[[body.part]]\n" +
                                 box("[1.5, 2, 1.5]", "[1.25, 0, 0]") + "[[body.part]]\n" +
                                 box("[2, 1.5, 1.5]", "[-1.25, 0, 0]") +
                                 "orientation = [0.70710678118654752, 0, 0, 0.70710678118654752]\n");
    EXPECT_NEAR(scene.find(2)->solver.mesh().volume, 12.0, 1e-12);
    RandomPoses random(87);
    for (int i = 0; i < 60; ++i) {
      const Pose pose = random.crossing(kHullBox, scene.water());
      const BuoyancyResult one = evaluated(scene, 1, pose).outcome.result;
      const BuoyancyResult parts = evaluated(scene, 2, pose).outcome.result;
      expect_within_bounds(one, parts, "pose " + std::to_string(i));
      if (water == kWater) expect_equal(one, parts, 1e-14, "pose " + std::to_string(i));
    }
  }
}

TEST(BodyEvaluator, EvaluatesSubdividedBodiesLikeOthersAlone) {
  std::string text = kWater;
  for (int id = 1; id <= 12; ++id) {
    text += body(id, "[4, 2, 1.5]");
    if (id % 3 == 0) text += "[[body.compartment]]\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]");
    if (id % 4 == 0) text += "[[body.tank]]\nfill = 0.3\n" + box("[1, 1, 1]");
  }
  const Scene scene = scene_of(text);
  RandomPoses random(88);
  WrenchRequest request;
  for (int id = 1; id <= 12; ++id) {
    const Pose pose = random.crossing(kHullBox, scene.water());
    BodyState state;
    state.body_id = id;
    state.position = to_array(pose.p_WB);
    state.quaternion_wxyz = {pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()};
    request.bodies.push_back(state);
  }
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  for (int round = 0; round < 2; ++round) {
    evaluate_all(evaluator, request, wrenches, counters);
    for (std::size_t i = 0; i < request.bodies.size(); ++i) {
      const Pose pose = validate_pose(request.bodies[i], 0.0).pose;
      const Evaluated alone = evaluated(scene, request.bodies[i].body_id, pose);
      EXPECT_EQ(wrenches[i].force, alone.wrench.force) << i;
      EXPECT_EQ(wrenches[i].torque, alone.wrench.torque) << i;
    }
  }
  EXPECT_EQ(counters.bodies_unchanged, 12);
}

TEST(BodyEvaluator, EvaluatesAnewUnderAnotherCondition) {
  const Scene scene = scene_of(kWater + body(7, "[4, 2, 1.5]") + "[[body.compartment]]\nflooded = 0.0\n" +
                               box("[1, 2, 1.5]", "[1.5, 0, 0]"));
  WrenchRequest request;
  request.bodies.push_back({.body_id = 7, .position = {0, 0, 0}, .quaternion_wxyz = {1, 0, 0, 0}});
  BodyEvaluator evaluator(scene, 1);
  ServiceCounters counters;
  std::vector<BodyWrench> wrenches;
  const auto volume = [&] {
    evaluate_all(evaluator, request, wrenches, counters);
    return wrenches.at(0).submerged_volume;
  };
  EXPECT_NEAR(volume(), 6.0, 1e-12);
  evaluator.set_condition(0, {.flooded = {1.0}, .liquid_volumes = {}});
  EXPECT_NEAR(volume(), 4.5, 1e-12);
  EXPECT_NEAR(volume(), 4.5, 1e-12);
  evaluator.set_condition(0, {.flooded = {0.0}, .liquid_volumes = {}});
  EXPECT_NEAR(volume(), 6.0, 1e-12);
}

}  // namespace
}  // namespace buoyancy
