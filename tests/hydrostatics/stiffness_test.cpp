// The stiffness against derivatives of force and torque: exact ones by dual numbers, and finite differences
// of the results of buoyancy().
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/stiffness_autodiff.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

TEST(Stiffness, MatchesAutomaticDifferentiation) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const BoundingBox box = bounding_box(named.mesh);
    RandomPoses random(31);
    int crossing = 0;
    for (int i = 0; i < 100; ++i) {
      Water water{.level = 0.25, .density = 1025.0, .gravity = 9.8};
      if (i % 4 == 3) water.up_W = random.direction();
      const Pose pose = random.crossing(box, water);
      const Vec3 reference_B = box.center() + box.diagonal() * random.uniform(0, 1) * random.direction();
      const auto found = hydrostatics(mesh, pose, water, reference_B, std::nullopt);
      ASSERT_TRUE(found);
      const Mat6 expected = stiffness_autodiff(mesh, pose, water, reference_B);
      const double area = found->waterplane_area;
      EXPECT_LE(max_difference(found->stiffness, expected, area > 0.0), stiffness_tolerance(mesh, area))
          << named.name << ", pose " << i;
      crossing += static_cast<int>(area > 0.0 && stiffness_tolerance(mesh, area) == 1e-9);
    }
    EXPECT_GT(crossing, 40) << named.name;
  }
}

TEST(Stiffness, HoldsAboutDistantReferencePoint) {
  const TriangleMesh rock = moved_and_scaled(make_shape(RockShape{.frequency = 8}), {6e5, -8e5, 1e5});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  RandomPoses random(32);
  int crossing = 0;

  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(rock), {});
    const auto found = hydrostatics(mesh, pose, {}, Vec3::Zero(), std::nullopt);
    ASSERT_TRUE(found);
    const Mat6 expected = stiffness_autodiff(mesh, pose, {}, Vec3::Zero());
    const double area = found->waterplane_area;
    // Without a waterplane, the rounding error of its area in the reference counts with the distance squared.
    if (!(area > 0.0)) continue;
    EXPECT_LE(max_difference(found->stiffness, expected, true), stiffness_tolerance(mesh, area)) << i;
    crossing += static_cast<int>(stiffness_tolerance(mesh, area) == 1e-9);
  }
  EXPECT_GT(crossing, 15);
}

// The pose after translation by p and rotation by theta about W's axes through the reference point.
Pose displaced(const Pose& pose, const Vec3& reference_B, const Vec3& p, const Vec3& theta) {
  const Vec3 reference_W = pose.p_WB + pose.q_WB * reference_B;
  Pose moved;
  const double angle = theta.norm();
  moved.q_WB =
      angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, theta / angle)) * pose.q_WB : pose.q_WB;
  moved.p_WB = reference_W + p - moved.q_WB * reference_B;
  return moved;
}

TEST(Stiffness, MatchesFiniteDifferencesOfBuoyancy) {
  const Water water{.level = -0.5, .density = 1000.0, .gravity = 10.0};
  for (const NamedMesh& named : closed_test_meshes()) {
    if (named.name != "cylinder" && named.name != "rock" && named.name != "Wigley hull") continue;
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const Solver solver(mesh, Method::kHierarchical);
    const BoundingBox box = bounding_box(named.mesh);
    const double step = 1e-6 * box.diagonal();
    RandomPoses random(33);
    for (int i = 0; i < 20; ++i) {
      const Pose pose = random.crossing(box, water);
      const Vec3 reference_B = box.center() + 0.3 * box.diagonal() * random.direction();
      Mat6 differences;
      for (int column = 0; column < 6; ++column) {
        const Vec3 along = Vec3::Unit(column % 3);
        const double h = column < 3 ? step : 1e-6;
        const auto wrench = [&](double sign) {
          const Vec3 change = sign * h * along;
          const Pose moved = column < 3 ? displaced(pose, reference_B, change, Vec3::Zero())
                                        : displaced(pose, reference_B, Vec3::Zero(), change);
          const BuoyancyResult result = buoyancy(solver, moved, water, reference_B);
          Eigen::Matrix<double, 6, 1> both;
          both << result.force_W, result.torque_W;
          return both;
        };
        differences.col(column) = (wrench(-1.0) - wrench(1.0)) / (2.0 * h);
      }
      const auto found = hydrostatics(mesh, pose, water, reference_B, std::nullopt);
      ASSERT_TRUE(found);
      // The tolerance for rounding and curvature is relative to the stiffness of the whole body.
      const double weight = water.density * water.gravity * box.diagonal() * box.diagonal();
      Mat6 difference = found->stiffness - differences;
      difference.block<3, 3>(0, 3) /= box.diagonal();
      difference.block<3, 3>(3, 0) /= box.diagonal();
      difference.block<3, 3>(3, 3) /= box.diagonal() * box.diagonal();
      EXPECT_LE(difference.norm(), 1e-7 * weight) << named.name << ", pose " << i;
    }
  }
}

}  // namespace
}  // namespace buoyancy
