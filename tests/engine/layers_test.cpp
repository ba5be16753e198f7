// Scenes whose water has layers.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "engine/subdivision_load.h"
#include "engine/water_at_time.h"
#include "messages/conversions.h"
#include "tests/engine/evaluate.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026

const std::string kLayers =
    "[[water.layer]]\nbelow = -0.3\ndensity = 1000\n[[water.layer]]\nbelow = -0.6\ndensity = 1030\n";
const std::string kWaves = "[[water.waves]]\ntype = \"regular\"\nheight = 0.3\nperiod = 3\ndirection = 20\n";
const std::string kFuel = "[water]\ndensity = 850\n";

std::string box(const std::string& size, const std::string& position = "[0, 0, 0]") {
  return "shape = { type = \"box\", size = " + size + ", segments = [3, 3, 3] }\nposition = " + position +
         "\n";
}

std::string body(int id, const std::string& size, const std::string& more = "") {
  return "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = " + size +
         ", segments = [3, 3, 3] }\n" + more;
}

BodyOutcome evaluated(const Scene& scene, std::int32_t id, const Pose& pose) {
  WaterAtTime water(scene);
  BodyOutcome outcome;
  evaluate(*scene.find(id), water.move_to(kNow, 0.0).water, {.status = BodyStatus::kOk, .pose = pose},
           outcome);
  return outcome;
}

void expect_near(const BuoyancyResult& a, const BuoyancyResult& b, double relative,
                 const std::string& where) {
  const double force = 1030.0 * kStandardGravity * 12.0;
  EXPECT_EQ(a.status, b.status) << where;
  EXPECT_LE((a.force_W - b.force_W).norm(), relative * force) << where;
  EXPECT_LE((a.torque_W - b.torque_W).norm(), relative * force * 2.0) << where;
  EXPECT_NEAR(a.volume, b.volume, relative * 12.0) << where;
  EXPECT_LE((a.center_of_buoyancy_W - b.center_of_buoyancy_W).norm(), 10.0 * relative) << where;
}

// A hull whose last metre is open to the sea displaces what the rest of it does.
TEST(LayeredScene, FloodedCompartmentsDisplaceNoLayer) {
  const Scene scene = scene_of(
      kFuel + kLayers + body(1, "[4, 2, 1.5]", "[[body.compartment]]\n" + box("[1, 2, 1.5]", "[1.5, 0, 0]")) +
      body(2, "[3, 2, 1.5]"));
  const BoundingBox hull{Vec3(-2.0, -1.0, -0.75), Vec3(2.0, 1.0, 0.75)};
  RandomPoses random(51);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = random.crossing(hull, scene.water());
    const std::string where = "pose " + std::to_string(i);
    Pose of_rest = pose;
    of_rest.p_WB += pose.q_WB * Vec3(-0.5, 0, 0);
    const BodyOutcome flooded = evaluated(scene, 1, pose);
    BodyOutcome rest = evaluated(scene, 2, of_rest);
    const Vec3 to_rest = pose.q_WB * Vec3(-0.5, 0, 0);
    rest.result.torque_W += to_rest.cross(rest.result.force_W);
    if (!rest.result.center_of_buoyancy_W.isZero(0.0)) rest.result.center_of_buoyancy_W += to_rest;
    expect_near(flooded.result, rest.result, 1e-11, where);

    ServiceCounters counters;
    const BodyHydrostatics of_flooded =
        evaluate_hydrostatics(*scene.find(1), scene.water(), pose, BodyStatus::kOk, counters);
    const auto expected =
        hydrostatics(scene.find(2)->solver.mesh(), of_rest, scene.water(), Vec3(0.5, 0, 0), std::nullopt);
    ASSERT_TRUE(expected) << where;
    EXPECT_NEAR(of_flooded.waterplane_area, expected->waterplane_area, 1e-10) << where;
    for (std::size_t row = 0; row < 6; ++row) {
      for (std::size_t column = 0; column < 6; ++column) {
        EXPECT_NEAR(of_flooded.stiffness[row][column],
                    expected->stiffness(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)),
                    1e-9 * (expected->stiffness.cwiseAbs().maxCoeff() + 1.0))
            << where;
      }
    }
  }
}

// The liquid of a tank is its own, and weighs what it weighs in water of one density.
TEST(LayeredScene, TanksHoldTheirOwnLiquid) {
  const std::string tank = "[[body.tank]]\n" + box("[1, 1, 1]") + "fill = 0.4\ndensity = 700\n";
  const std::string bodies = body(1, "[4, 2, 1.5]") + body(2, "[4, 2, 1.5]", tank);
  const Scene layered = scene_of(kFuel + kLayers + bodies);
  const Scene plain = scene_of(kFuel + bodies);
  const Pose pose{Vec3(1, 2, -0.2), Eigen::Quaterniond(0.95, 0.2, 0.1, 0.0).normalized()};
  const Vec3 in_layers =
      evaluated(layered, 2, pose).result.torque_W - evaluated(layered, 1, pose).result.torque_W;
  const Vec3 in_one = evaluated(plain, 2, pose).result.torque_W - evaluated(plain, 1, pose).result.torque_W;
  EXPECT_LE((in_layers - in_one).norm(), 1e-9);
  EXPECT_GT(in_one.norm(), 10.0);
}

// The surface moves, and the tops of the layers do not: they add what they add to water at rest.
TEST(LayeredScene, WavesMoveTheSurfaceAlone) {
  const std::string bodies = body(1, "[4, 2, 1.5]") + body(2, "[4, 2, 1.5]", "method = \"exact_surface\"\n") +
                             body(3, "[4, 2, 1.5]", "method = \"fast_surface\"\n");
  const Scene layered = scene_of(kFuel + kLayers + kWaves + bodies);
  const Scene waves = scene_of(kFuel + kWaves + bodies);
  RandomPoses random(52);
  for (int i = 0; i < 10; ++i) {
    Pose pose{Vec3(i, 2, random.uniform(-1.5, 0.5)), random.rotation()};
    if (i == 0) pose.p_WB.z() = -400.0;  // bounds decide
    for (std::int32_t id = 1; id <= 3; ++id) {
      const Body& of = *layered.find(id);
      BuoyancyResult expected = evaluated(waves, id, pose).result;
      for (std::size_t n = 0; n < 2; ++n) {
        const BuoyancyResult step =
            buoyancy(of.solver, pose, water_of_step(layered.water(), n), of.reference_B);
        expected.force_W += step.force_W;
        expected.torque_W += step.torque_W;
        expected.force_error_bound += step.force_error_bound;
      }
      const BodyOutcome found = evaluated(layered, id, pose);
      const std::string where = "body " + std::to_string(id) + ", pose " + std::to_string(i);
      ASSERT_EQ(found.status, BodyStatus::kOk) << where;
      EXPECT_LE((found.result.force_W - expected.force_W).norm(), 1e-10 * 1.2e5) << where;
      EXPECT_LE((found.result.torque_W - expected.torque_W).norm(), 1e-10 * 2.4e5) << where;
      EXPECT_EQ(found.result.volume, evaluated(waves, id, pose).result.volume) << where;
      if (id == 1) {
        EXPECT_NEAR(found.result.force_error_bound, expected.force_error_bound,
                    1e-12 * expected.force_error_bound);
      }
    }
  }
}

// Requests take bounds, groups and single queries; all agree with one another, and the cache with them.
TEST(LayeredScene, RequestsHaveTheBitsOfSingleQueries) {
  std::string bodies;
  for (int i = 1; i <= 12; ++i) bodies += body(i, "[1, 1, 1]");
  const Scene scene = scene_of(kFuel + kLayers + bodies);
  WrenchRequest request;
  for (std::int32_t i = 1; i <= 12; ++i) {
    BodyState state;
    state.body_id = i;
    state.position = {1.0 * i, 0.0, 1.5 - 0.3 * i};
    state.quaternion_wxyz = {0.8, 0.0, 0.6, 0.0};
    request.bodies.push_back(state);
  }
  BodyEvaluator evaluator(scene, 1);
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<BodyWrench> wrenches;
    ServiceCounters counters;
    evaluate_all(evaluator, request, wrenches, counters);
    for (std::size_t i = 0; i < wrenches.size(); ++i) {
      const Body& of = scene.bodies()[i];
      const BuoyancyResult alone =
          buoyancy(of.solver, validate_pose(request.bodies[i], 0.0).pose, scene.water(), of.reference_B);
      EXPECT_EQ(to_vec3(wrenches[i].force), alone.force_W) << i;
      EXPECT_EQ(to_vec3(wrenches[i].torque), alone.torque_W) << i;
      EXPECT_EQ(wrenches[i].force_error_bound, alone.force_error_bound) << i;
    }
    EXPECT_GT(counters.bodies_dry, 0);
    EXPECT_GT(counters.bodies_wet, 0);
    EXPECT_GT(counters.bodies_crossing, 0);
  }
}

}  // namespace
}  // namespace buoyancy
