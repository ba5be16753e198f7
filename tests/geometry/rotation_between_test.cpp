#include "geometry/rotation_between.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

TEST(RotationBetween, TurnsLeastFromOneDirectionToOther) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
  for (int exponent = 0; exponent <= 17; ++exponent) {
    for (int i = 0; i < 100; ++i) {
      const Vec3 from = vector();
      const Vec3 other = vector();
      const Vec3 to = -std::exp(normal(random)) * from + std::pow(10.0, -exponent) * other;
      const Eigen::Quaterniond rotation = rotation_between(from, to);
      EXPECT_NEAR(rotation.norm(), 1.0, 1e-9);
      EXPECT_LE((rotation * from.normalized() - to.normalized()).norm(), 2e-9);
      EXPECT_GE(rotation.w(), 0.0);
      EXPECT_LE(std::abs(rotation.vec().dot(from.normalized())), 1e-9) << "a larger rotation than necessary";
    }
  }
}

TEST(RotationBetween, TurnsByHalfBetweenOppositeDirections) {
  for (const Vec3& from : {Vec3(3, 0, 0), Vec3(0, -3, 0), Vec3(0, 0, 3), Vec3(1, -2, 3)}) {
    const Eigen::Quaterniond rotation = rotation_between(from, -0.5 * from);
    EXPECT_EQ(rotation.w(), 0.0) << from.transpose();
    EXPECT_LE((rotation * from + from).norm(), 1e-15 * from.norm()) << from.transpose();
  }
}

TEST(RotationBetween, IsIdentityBetweenEqualDirections) {
  EXPECT_EQ(rotation_between(Vec3(0, 2, 0), Vec3(0, 5, 0)).coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

}  // namespace
}  // namespace buoyancy
