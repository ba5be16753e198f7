// The stress catalogue, "Cases": quaternions and positions as clients send them, through the solvers and
// through the request handler.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "geometry/shapes.h"
#include "messages/conversions.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/invalid_states.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

Eigen::Quaterniond scaled(const Eigen::Quaterniond& q, double factor) {
  return Eigen::Quaterniond(factor * q.w(), factor * q.x(), factor * q.y(), factor * q.z());
}

TEST(StressQuaternions, IsBitIdenticalForNegatedQuaternion) {
  StressCase stress("q and -q", "each other, all six methods", "same bits");
  for_each_turn(601, tries(100), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    Pose pose = stressed_pose(random, body, i, water);
    if (i % 3 == 0) pose.q_WB = scaled(pose.q_WB, random.uniform(0.999, 1.001));
    Pose opposite = pose;
    opposite.q_WB = scaled(pose.q_WB, -1.0);
    const auto check = [&](const Solver& solver) {
      const BuoyancyResult one = buoyancy(solver, pose, water, body.mesh.center_B);
      const BuoyancyResult other = buoyancy(solver, opposite, water, body.mesh.center_B);
      stress.require(one.volume == other.volume && one.force_W == other.force_W &&
                         one.torque_W == other.torque_W &&
                         one.center_of_buoyancy_W == other.center_of_buoyancy_W,
                     body.name + ", " + std::string(to_string(solver.method())));
    };
    for (const Method method : kAllMethods) check(Solver(body.mesh, method));
    visit_exact_solvers(body.mesh, [&](const std::string&, const Solver& solver) { check(solver); });
  });
}

BodyState state_of(std::int32_t id, const Pose& pose) {
  BodyState state;
  state.body_id = id;
  state.position = {pose.p_WB.x(), pose.p_WB.y(), pose.p_WB.z()};
  state.quaternion_wxyz = {pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()};
  return state;
}

WrenchResponse response_of(RequestHandler& handler, const std::vector<BodyState>& bodies,
                           double lead_time = 0.0) {
  static std::int64_t seq = 0;
  return decoded<WrenchResponse>(handler.handle(request_bytes({.seq = ++seq}, bodies, lead_time)));
}

TEST(StressQuaternions, NormalisesNormsWithinThousandthOfOne) {
  StressCase stress("| |q| - 1 | <= 1e-3", "rational arithmetic at q/|q|", "G_V, G_V L_r");
  const std::vector<double> norms{1.0 - 9.99e-4, 1.0 - 1e-4, 1.0 - 1e-6,
                                  1.0 + 1e-9,    1.0 + 1e-5, 1.0 + 9.99e-4};
  for_each_turn(602, tries(6), [&](RandomPoses& random, const StressedBody& body, int i) {
    Pose pose = random.crossing(body.box, kStressWater);
    pose.q_WB = scaled(pose.q_WB, norms[static_cast<std::size_t>(i)]);
    check_exactly(stress, body, pose, kStressWater, reference_near(random, body));
  });

  const Scene scene = box_scene();
  const StressedBody box("box, by the handler", make_shape(BoxShape{.segments = {2, 2, 2}}));
  const Water water{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};
  RequestHandler handler(scene);
  RandomPoses random(603);
  for (int i = 0; i < tries(60); ++i) {
    Pose pose = random.crossing(box.box, water);
    pose.q_WB = scaled(pose.q_WB, norms[static_cast<std::size_t>(i) % norms.size()]);
    const Truth truth({&box.source}, pose, water, Vec3::Zero());
    const std::int64_t before = handler.counters().quaternions_normalised;
    const WrenchResponse response =
        response_of(handler, {state_of(kBox, pose), state_of(kHierarchicalBox, pose)});
    for (const BodyWrench& wrench : response.bodies) {
      const std::string where = box.name + ", body " + std::to_string(wrench.body_id);
      stress.require(wrench.status == BodyStatus::kOk, "the status of " + where);
      stress.check(truth.volume_error(wrench.submerged_volume), box.volume_tolerance(), "volume, " + where);
      stress.check(truth.force_error(to_vec3(wrench.force) / kWeight), box.volume_tolerance(),
                   "force, " + where);
      stress.check(truth.torque_error(to_vec3(wrench.torque) / kWeight), box.torque_tolerance(Vec3::Zero()),
                   "torque, " + where);
    }
    const bool counted = std::abs(pose.q_WB.norm() - 1.0) > 1.1e-6;
    if (counted) stress.require(handler.counters().quaternions_normalised == before + 2, "counted");
  }
}

TEST(StressQuaternions, RejectsInvalidPosesAndKeepsOtherBodies) {
  StressCase stress("q further off, NaN, Inf, overflow to Inf",
                    "its status, counted; zeros for it, the others' wrenches unchanged", "status");
  const Scene scene = box_scene();
  for (const InvalidState& invalid : invalid_states()) {
    RequestHandler handler(scene);
    const BodyState good = upright(kHierarchicalBox, 0.2);
    const WrenchResponse alone = response_of(handler, {good}, 0.0);
    const ServiceCounters before = handler.counters();
    const WrenchResponse response = response_of(handler, {invalid.state, good}, invalid.lead_time);
    ASSERT_EQ(response.bodies.size(), 2U);
    const BodyWrench& bad = response.bodies[0];
    const std::array<double, 3> zeros{};
    stress.require(bad.status == invalid.status, "the status of " + invalid.name);
    stress.require(bad.force == zeros && bad.torque == zeros && bad.submerged_volume == 0.0 &&
                       bad.center_of_buoyancy == zeros && bad.force_error_bound == 0.0 &&
                       bad.torque_error_bound == 0.0,
                   "zeros for " + invalid.name);
    const auto index = static_cast<std::size_t>(invalid.status);
    const bool affects_all = invalid.status == BodyStatus::kBadLeadTime;
    stress.require(handler.counters().bodies[index] == before.bodies[index] + (affects_all ? 2 : 1),
                   "counted, " + invalid.name);
    if (!affects_all) {
      stress.require(response.bodies[1].status == BodyStatus::kOk &&
                         response.bodies[1].force == alone.bodies[0].force &&
                         response.bodies[1].torque == alone.bodies[0].torque,
                     "the other body beside " + invalid.name);
    }
    // The body is evaluated again with the next valid pose.
    stress.require(response_of(handler, {upright(kBox, 0.1)}).bodies[0].status == BodyStatus::kOk,
                   "afterwards, " + invalid.name);
  }
}

}  // namespace
}  // namespace buoyancy
