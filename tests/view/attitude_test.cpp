#include "view/report/attitude.h"

#include <numbers>

#include <gtest/gtest.h>

#include "geometry/rotation_between.h"

namespace buoyancy::view {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kRounding = 1e-12;

Eigen::Quaterniond rotation(double degrees, const Vec3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis));
}

void expect_attitude(const Attitude& found, double heave, double roll, double pitch) {
  EXPECT_NEAR(found.heave, heave, kRounding);
  EXPECT_NEAR(found.roll, roll, 1e-9);
  EXPECT_NEAR(found.pitch, pitch, 1e-9);
}

TEST(Attitude, HasHeaveAndNoAnglesForUprightBody) {
  Water water;
  water.level = 2.0;
  expect_attitude(attitude({.p_WB = {7.0, 8.0, 2.5}}, water, MeshUp::kZ), 0.5, 0.0, 0.0);
}

TEST(Attitude, AppliesRollThenPitchThenYaw) {
  const Eigen::Quaterniond q =
      rotation(70.0, Vec3::UnitZ()) * rotation(-20.0, Vec3::UnitY()) * rotation(130.0, Vec3::UnitX());
  expect_attitude(attitude({.q_WB = q}, {}, MeshUp::kZ), 0.0, 130.0, -20.0);
}

TEST(Attitude, RemovesRotationThatStandsMeshUpright) {
  const Eigen::Quaterniond listing = rotation(40.0, Vec3::UnitZ()) * rotation(10.0, Vec3::UnitX());
  expect_attitude(attitude({.q_WB = listing * rotation(90.0, Vec3::UnitX())}, {}, MeshUp::kY), 0.0, 10.0,
                  0.0);
  expect_attitude(attitude({.q_WB = listing * rotation(-90.0, Vec3::UnitY())}, {}, MeshUp::kX), 0.0, 10.0,
                  0.0);
}

TEST(Attitude, IsIndependentOfUpAxisOfWorld) {
  Water water;
  water.up_W = Vec3::UnitY();
  water.level = -1.0;
  const Eigen::Quaterniond z_to_y = rotation_between(Vec3::UnitZ(), Vec3::UnitY());
  const Eigen::Quaterniond q = rotation(-15.0, Vec3::UnitY()) * rotation(25.0, Vec3::UnitX());
  expect_attitude(attitude({.p_WB = {0.0, 3.0, 0.0}, .q_WB = z_to_y * q}, water, MeshUp::kZ), 4.0, 25.0,
                  -15.0);
}

}  // namespace
}  // namespace buoyancy::view
