#include "base/current.h"

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

TEST(Current, IsLinearBetweenHeightsAndConstantBeyondThem) {
  const Current current{.velocity_W = Vec3(9, 9, 9),
                        .profile = {{1.0, {0.8, 0, 0}}, {-1.0, {0.4, 0.2, 0}}, {-5.0, {0, 0, -0.1}}}};
  const Water water{.up_W = Vec3(0, 0.6, 0.8), .level = 2.0};
  struct Case {
    double height;
    Vec3 velocity_W;
  };
  for (const auto& [height, velocity_W] :
       {Case{7.0, {0.8, 0, 0}}, Case{1.0, {0.8, 0, 0}}, Case{0.5, {0.7, 0.05, 0}}, Case{-1.0, {0.4, 0.2, 0}},
        Case{-4.0, {0.1, 0.05, -0.075}}, Case{-5.0, {0, 0, -0.1}}, Case{-99.0, {0, 0, -0.1}}}) {
    const Vec3 p_W = (2.0 + height) * water.up_W + Vec3(3, 0, 0);
    EXPECT_LE((current.at(water, p_W) - velocity_W).norm(), 1e-14) << height;
  }
  EXPECT_EQ(velocity_at({{0.0, {1, 2, 3}}}, 4.0), Vec3(1, 2, 3));
  EXPECT_EQ((Current{.velocity_W = Vec3(1, 2, 3)}.at(water, Vec3(4, 5, 6))), Vec3(1, 2, 3));
}

TEST(Current, HasTheLargestSpeedOfItsHeights) {
  EXPECT_EQ((Current{.velocity_W = Vec3(3, 4, 0)}.max_speed()), 5.0);
  EXPECT_EQ(
      (Current{.velocity_W = Vec3(1, 0, 0), .profile = {{1.0, {1, 0, 0}}, {0.0, {0, 0, -2}}}}.max_speed()),
      2.0);
}

TEST(LayeredWater, IsASumOfTermsWithTheirOwnSurfaces) {
  const Water water{.level = 1.0, .density = 850.0, .layers = {{0.0, 1000.0}, {-3.0, 1025.0}}};
  EXPECT_EQ(water_of_step(water, 0).level, 0.0);
  EXPECT_EQ(water_of_step(water, 0).density, 150.0);
  EXPECT_EQ(water_of_step(water, 1).level, -3.0);
  EXPECT_EQ(water_of_step(water, 1).density, 25.0);
  EXPECT_TRUE(water_of_step(water, 1).layers.empty());
  EXPECT_EQ(deepest_density(water), 1025.0);
  EXPECT_EQ(deepest_density(Water{}), kSeawaterDensity);
  const Water low{.level = -1.0, .density = 850.0, .layers = {{0.0, 1000.0}}};
  EXPECT_EQ(water_of_step(low, 0).level, -1.0);
}

}  // namespace
}  // namespace buoyancy
