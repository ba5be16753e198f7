// The stress catalogue, "Cases": bodies that are far away, huge, tiny or far from the origin of their own
// mesh.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "geometry/shapes.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

double waterplane_area(const StressedBody& body, const Pose& pose, const Water& water) {
  const auto found = hydrostatics(body.mesh, pose, water, body.mesh.center_B, std::nullopt);
  return found ? found->waterplane_area : kNaN;
}

// Checks the results of two poses that would be equivalent without rounding: they may differ by the change of
// volume that the last digit of p causes, the waterplane's area times eps |p|.
void check_moved(StressCase& stress, const StressedBody& body, const Pose& near, const Water& near_water,
                 const Pose& far, const Water& far_water, double distance) {
  const double area =
      std::max(waterplane_area(body, near, near_water), waterplane_area(body, far, far_water));
  const double volume_tolerance = area * kEpsilon * distance + body.volume_tolerance();  // [m^3]
  const double torque_tolerance = volume_tolerance * body.mesh.max_lever_arm(body.mesh.center_B);
  visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
    const BuoyancyResult one = buoyancy(solver, near, near_water, body.mesh.center_B);
    const BuoyancyResult other = buoyancy(solver, far, far_water, body.mesh.center_B);
    const double factor = depth_factor(solver, near, near_water);
    const std::string where = body.name + ", " + method;
    stress.check(std::abs(other.volume - one.volume), factor * volume_tolerance, "volume, " + where);
    stress.check((other.torque_W - one.torque_W).norm(), factor * torque_tolerance, "torque, " + where);
  });
}

TEST(StressPlacement, IsBitIdenticalFarAwayWhenUpIsAxis) {
  StressCase stress("body 1e6 m, 1e9 m away horizontally, up an axis", "the same body near", "same bits");
  for_each_turn(201, tries(60), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    const int axis = i % 3;
    water.up_W = (i % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(axis);
    Pose near;
    near.q_WB = random.rotation();
    const double height = water.level + 0.55 * body.mesh.diagonal * random.uniform(-1, 1) -
                          water.up_W.dot(near.q_WB * body.box.center());
    near.p_WB = height * water.up_W;
    for (const double distance : {1e6, 1e9}) {
      Pose far = near;
      far.p_WB[(axis + 1) % 3] = distance * random.uniform(-1, 1);
      far.p_WB[(axis + 2) % 3] = distance;
      visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
        stress.require(same_bits(buoyancy(solver, near, water, Vec3::Zero()),
                                 buoyancy(solver, far, water, Vec3::Zero())),
                       body.name + ", " + method);
      });
    }
  });
}

TEST(StressPlacement, ChangesOnlyByPositionRoundingFarAway) {
  StressCase stress("body 1e6 m, 1e9 m away horizontally, up tilted", "the same body near",
                    "A_wp dh, dh = eps |p| (beside G_V)");
  for_each_turn(202, tries(40), [&](RandomPoses& random, const StressedBody& body, int) {
    Water water = kStressWater;
    const double tilt = random.uniform(0.1, 1.4);
    water.up_W = Vec3(std::sin(tilt), 0.0, std::cos(tilt));
    const Pose near = random.crossing(body.box, water);
    for (const double distance : {1e6, 1e9}) {
      Pose far = near;
      far.p_WB += distance * Vec3(water.up_W.z(), random.uniform(-1, 1), -water.up_W.x());
      check_moved(stress, body, near, water, far, water, far.p_WB.norm() + near.p_WB.norm());
    }
  });
}

TEST(StressPlacement, IsExactForDistantPose) {
  StressCase stress("body 1e6 m, 1e9 m away horizontally, up tilted",
                    "rational arithmetic at the pose as requested", "G_V, G_V L_r");
  for_each_turn(203, tries(8), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    water.up_W = random.direction();
    Pose pose = random.crossing(body.box, water);
    const Vec3 sideways = random.direction();
    pose.p_WB += (i % 2 == 0 ? 1e6 : 1e9) * (sideways - water.up_W.dot(sideways) * water.up_W);
    // Moves the level to compensate, approximately, for the rounding of p.
    const Vec3 center_W = pose.p_WB + pose.q_WB * body.box.center();
    water.level = water.up_W.dot(center_W) + 0.3 * body.mesh.diagonal * random.uniform(-1, 1);
    check_exactly(stress, body, pose, water, reference_near(random, body));
  });
}

TEST(StressPlacement, IsAsExactAsPoseForVerticalOffset) {
  StressCase stress("vertical offset 1e6 m (level and position)", "without the offset",
                    "A_wp dh, dh = eps |p_z| (beside G_V)");
  for_each_turn(204, tries(40), [&](RandomPoses& random, const StressedBody& body, int) {
    const Pose near = random.crossing(body.box, kStressWater);
    for (const double offset : {1e6, -1e6, 1234567.89}) {
      Water far_water = kStressWater;
      far_water.level += offset;
      Pose far = near;
      far.p_WB.z() += offset;
      check_moved(stress, body, near, kStressWater, far, far_water,
                  std::abs(far.p_WB.z()) + std::abs(far_water.level));
    }
  });
}

TEST(StressPlacement, IsExactForVerticalOffset) {
  StressCase stress("vertical offset 1e6 m (level and position)",
                    "rational arithmetic at the pose as requested", "G_V, G_V L_r");
  for_each_turn(205, tries(8), [&](RandomPoses& random, const StressedBody& body, int) {
    const double offset = random.uniform(-1e6, 1e6);
    Pose pose = random.crossing(body.box, kStressWater);
    pose.p_WB.z() += offset;
    Water water = kStressWater;
    water.level += offset;
    check_exactly(stress, body, pose, water, reference_near(random, body));
  });
}

TEST(StressPlacement, IsExactForMeshFarFromItsOrigin) {
  StressCase stress("mesh 1e3 m, 1e6 m from its own body origin", "rational arithmetic", "G_V, G_V L_r");
  const TriangleMesh rock = make_shape(RockShape{.frequency = 4, .roughness = 0.4, .seed = 7});
  const TriangleMesh box = make_shape(BoxShape{.size = {1, 2, 3}, .segments = {2, 2, 2}});
  for (const double distance : {1e3, 1e6}) {
    for (const TriangleMesh* mesh : {&rock, &box}) {
      const Vec3 offset = distance * Vec3(0.6, -0.77, 0.3);
      const StressedBody body((mesh == &rock ? "rock, " : "box, ") + format_shortest(distance) + " m away",
                              moved_and_scaled(*mesh, offset));
      RandomPoses random(206);
      for (int i = 0; i < tries(60); ++i) {
        Water water = kStressWater;
        const Pose pose = stressed_pose(random, body, i, water);
        // The torque is about the far origin or about a point near the body.
        check_exactly(stress, body, pose, water, i % 2 == 0 ? Vec3::Zero() : reference_near(random, body));
      }
    }
  }
}

TEST(StressPlacement, IsBitIdenticalWhenScaledByPowerOfTwo) {
  StressCase stress("body of 1e-6 m, of 1e6 m (scaled by 2^-20, 2^20)", "the body of 1 m, all six methods",
                    "same bits");
  for (const StressedBody& body : stressed_bodies()) {
    for (const double scale : {0x1p-20, 0x1p20}) {
      const StressedBody scaled(body.name, moved_and_scaled(body.source, Vec3::Zero(), scale));
      RandomPoses random(207);
      for (int i = 0; i < tries(60); ++i) {
        Water water = kStressWater;
        const Pose pose = stressed_pose(random, body, i, water);
        Pose scaled_pose = pose;
        scaled_pose.p_WB *= scale;
        Water scaled_water = water;
        scaled_water.level *= scale;
        const Vec3 reference_B = reference_near(random, body);
        const auto check = [&](const Solver& solver, const Solver& scaled_solver) {
          const BuoyancyResult one = buoyancy(solver, pose, water, reference_B);
          BuoyancyResult other = buoyancy(scaled_solver, scaled_pose, scaled_water, scale * reference_B);
          const double volume = scale * scale * scale;
          other.volume /= volume;
          other.force_W /= volume;
          other.torque_W /= volume * scale;
          other.center_of_buoyancy_W /= scale;
          const bool same = other.volume == one.volume && other.force_W == one.force_W &&
                            other.torque_W == one.torque_W &&
                            other.center_of_buoyancy_W == one.center_of_buoyancy_W;
          stress.require(same, body.name + ", " + std::string(to_string(solver.method())));
        };
        for (const Method method : kAllMethods) check(Solver(body.mesh, method), Solver(scaled.mesh, method));
        for (const std::string& target : simd_targets()) {
          ASSERT_TRUE(force_simd_target(target));
          check(Solver(body.mesh, Method::kHierarchical), Solver(scaled.mesh, Method::kHierarchical));
        }
        force_simd_target("");
      }
    }
  }
}

}  // namespace
}  // namespace buoyancy
