// The stiffness against derivatives of force and torque: exact ones by dual numbers, and differences of what
// buoyancy() answers.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "hydrostatics/floating_moments.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/hydrostatics/dual.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/hydrostatics/wet_moments_by_hand.h"

namespace buoyancy {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// -d(F, tau)/d(p, theta) where p moves the body and theta turns it about W's axes through the reference
// point.
Mat6 stiffness_by_dual_numbers(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                               const Vec3& reference_B) {
  using DualVec = Vec3T<Dual>;
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  const Mat3T<Dual> R_WB = pose.q_WB.toRotationMatrix().cast<Dual>();
  const DualVec up_W = water.up_W.cast<Dual>();
  const DualVec c_from_r = (mesh.center_B - reference_B).cast<Dual>();
  DualVec p;
  DualVec theta;
  for (std::size_t i = 0; i < 3; ++i) {
    p(static_cast<Eigen::Index>(i)) = Dual::parameter(i);
    theta(static_cast<Eigen::Index>(i)) = Dual::parameter(3 + i);
  }
  // The body turned by theta has R = (1 + [theta] + ..) R_WB; a point y about c is at
  // p_r + p + R (y + c - r), so k = R^T up and h_c = level - up . (p_r + p) - k . (c - r).
  Mat3T<Dual> turn = Mat3T<Dual>::Constant(Dual(0.0));
  turn.diagonal().setConstant(Dual(1.0));
  const Mat3T<Dual> R = (turn + cross_matrix(theta)) * R_WB;
  DualVec k = R.transpose() * up_W;
  for (int i = 0; i < 3; ++i) k(i).value = plane.up_B(i);
  Dual h = -(up_W.dot(p) + k.dot(c_from_r));
  h.value = plane.h_c;  // what cancels in the sum above

  const auto floating = read_out<Dual>(wet_moments_by_hand<Dual>(mesh.surface, k, h), -h, k);
  const DualVec force_B = floating.volume * k;
  const DualVec torque_B = floating.moment.cross(k) + c_from_r.cross(force_B);
  const Dual weight(water.density * water.gravity);
  const DualVec force_W = weight * (R * force_B);
  const DualVec torque_W = weight * (R * torque_B);
  Mat6 result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 6; ++column) {
      result(row, column) = -force_W(row).slope[static_cast<std::size_t>(column)];
      result(row + 3, column) = -torque_W(row).slope[static_cast<std::size_t>(column)];
    }
  }
  return result;
}

// The largest difference of a 3 x 3 block (they have different units), relative to the block. Without a
// waterplane only the last one is not zero.
double largest_difference(const Mat6& found, const Mat6& expected, bool waterplane) {
  double largest = 0.0;
  for (const int row : {0, 3}) {
    for (const int column : {0, 3}) {
      if (!waterplane && row + column < 6) continue;
      const Mat3 truth = expected.block<3, 3>(row, column);
      const double difference = (found.block<3, 3>(row, column) - truth).norm();
      if (difference > 0.0) largest = std::max(largest, difference / truth.norm());
    }
  }
  return largest;
}

// 1e-9, but where the waterplane is so small that its area is not known so well, on either side: eps A_s of
// it.
double tolerance(const HydrostaticMesh& mesh, double waterplane_area) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  return waterplane_area > 0.0 ? std::max(1e-9, 32.0 * kEpsilon * mesh.area / waterplane_area) : 1e-9;
}

TEST(Stiffness, AgreesWithDualNumbersThroughClipMomentsAndReadOut) {
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
      const Mat6 expected = stiffness_by_dual_numbers(mesh, pose, water, reference_B);
      const double area = found->waterplane_area;
      EXPECT_LE(largest_difference(found->stiffness, expected, area > 0.0), tolerance(mesh, area))
          << named.name << ", pose " << i;
      crossing += static_cast<int>(area > 0.0 && tolerance(mesh, area) == 1e-9);
    }
    EXPECT_GT(crossing, 40) << named.name;
  }
}

TEST(Stiffness, IsAboutTheReferencePointHoweverFarItLies) {
  const TriangleMesh rock = moved_and_scaled(make_shape(RockShape{.frequency = 8}), {6e5, -8e5, 1e5});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  RandomPoses random(32);
  int crossing = 0;

  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(rock), {});
    const auto found = hydrostatics(mesh, pose, {}, Vec3::Zero(), std::nullopt);
    ASSERT_TRUE(found);
    const Mat6 expected = stiffness_by_dual_numbers(mesh, pose, {}, Vec3::Zero());
    const double area = found->waterplane_area;
    // Without one, what the other side's sums leave of it counts with the square of the distance.
    if (!(area > 0.0)) continue;
    EXPECT_LE(largest_difference(found->stiffness, expected, true), tolerance(mesh, area)) << i;
    crossing += static_cast<int>(tolerance(mesh, area) == 1e-9);
  }
  EXPECT_GT(crossing, 15);
}

// The pose after moving by p and turning by theta about W's axes through the reference point.
Pose displaced(const Pose& pose, const Vec3& reference_B, const Vec3& p, const Vec3& theta) {
  const Vec3 reference_W = pose.p_WB + pose.q_WB * reference_B;
  Pose moved;
  const double angle = theta.norm();
  moved.q_WB =
      angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, theta / angle)) * pose.q_WB : pose.q_WB;
  moved.p_WB = reference_W + p - moved.q_WB * reference_B;
  return moved;
}

TEST(Stiffness, IsWhatForceAndTorqueOfBuoyancyChangeBy) {
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
          const BuoyancyAnswer answer = buoyancy(solver, moved, water, reference_B);
          Eigen::Matrix<double, 6, 1> both;
          both << answer.force_W, answer.torque_W;
          return both;
        };
        differences.col(column) = (wrench(-1.0) - wrench(1.0)) / (2.0 * h);
      }
      const auto found = hydrostatics(mesh, pose, water, reference_B, std::nullopt);
      ASSERT_TRUE(found);
      // Differences of the size of the whole body's are what rounding and curvature leave.
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
