#include "flotation/point_immersion.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

TEST(PointImmersion, OfABoxHasItsClosedForm) {
  const BoxShip ship;
  // A wall-sided body turns about the middle of its waterplane until the deck edge is at the surface.
  const std::array points{Vec3(10, -10, 6), Vec3(-30, 10, 6), Vec3(0, -4, 2.5), Vec3(0, 10, 4)};
  const FirstImmersions edges = first_immersions(ship.body, kWater, {points.data(), 2});
  ASSERT_TRUE(edges.starboard && edges.port);
  EXPECT_NEAR(edges.starboard->heel, std::atan(0.6), 1e-11);
  EXPECT_EQ(edges.starboard->point, 0U);
  EXPECT_NEAR(edges.port->heel, -std::atan(0.6), 1e-11);
  EXPECT_EQ(edges.port->point, 1U);
  const FirstImmersions all = first_immersions(ship.body, kWater, points);
  ASSERT_TRUE(all.starboard && all.port);
  EXPECT_NEAR(all.starboard->heel, std::atan(0.6), 1e-11);
  EXPECT_NEAR(all.port->heel, -std::atan(0.4), 1e-11);
  EXPECT_EQ(all.port->point, 3U);
}

TEST(PointImmersion, TakesTheTrimOfTheHeel) {
  const BoxShip ship;
  // With the bow down by 2 degrees, a point 30 m ahead is 30 tan(2 degrees) lower.
  RightingArmOptions options;
  options.fixed_trim = -2.0 * kDegree;
  const std::array points{Vec3(30, -10, 6)};
  const FirstImmersions found = first_immersions(ship.body, kWater, points, options);
  ASSERT_TRUE(found.starboard && found.port);
  const double freeboard = 6.0 - 30.0 * std::tan(2.0 * kDegree) / std::cos(found.starboard->heel);
  EXPECT_NEAR(std::tan(found.starboard->heel), freeboard / 10.0, 1e-9);
  EXPECT_GT(found.port->heel, -180.0 * kDegree);
  EXPECT_LT(found.port->heel, -90.0 * kDegree) << "only when it is nearly upside down";
}

TEST(PointImmersion, PutsAPointOfAFreelyTrimmingHullAtTheSurface) {
  const HydrostaticMesh mesh = mesh_of(
      WigleyShape{.length = 10, .beam = 1.6, .draft = 0.625, .freeboard = 0.4, .segments = 24, .levels = 8});
  const FloatingBody body = body_of(mesh, 0.5, Vec3(0.3, 0.01, -0.1));
  for (int i = 0; i < 8; ++i) {
    const std::array points{Vec3(1.2 * i - 4.2, 0.7, 0.35), Vec3(2.0 - 0.5 * i, -0.6, 0.3)};
    const FirstImmersions found = first_immersions(body, kWater, points);
    const auto height = [&](double heel, std::size_t point) {
      const RightingArm arm = righting_arm(body, kWater, heel).value();
      const Pose pose{arm.height * kWater.up_W, attitude_at({}, {heel, arm.trim}, kWater.up_W)};
      const FloatingState state = floating_state(body, pose, kWater).value();
      EXPECT_NEAR(state.force_W.norm() / (body.mass() * kWater.gravity), 0.0, 1e-12);
      return (pose.p_WB + pose.q_WB * points[point]).z();
    };
    for (const auto& side : {found.starboard, found.port}) {
      ASSERT_TRUE(side.has_value()) << i;
      EXPECT_NEAR(height(side->heel, side->point), 0.0, 1e-9) << i;
      for (double heel = 0.0; heel < std::abs(side->heel); heel += 3.0 * kDegree) {
        for (const std::size_t point : {0U, 1U}) {
          EXPECT_GT(height(std::copysign(heel, side->heel), point), 0.0) << i << ' ' << heel / kDegree;
        }
      }
    }
  }
}

TEST(PointImmersion, IsAbsentOrAtOnceAtTheExtremes) {
  const BoxShip ship;
  const std::array sunk{Vec3(0, 0, 5), Vec3(0, 0, -1)};
  const FirstImmersions now = first_immersions(ship.body, kWater, sunk);
  ASSERT_TRUE(now.starboard && now.port);
  EXPECT_EQ(now.starboard->heel, 0.0);
  EXPECT_EQ(now.port->point, 1U);
  const std::array mast{Vec3(0, 0, 1000)};
  ASSERT_TRUE(first_immersions(ship.body, kWater, mast).port);
  EXPECT_NEAR(first_immersions(ship.body, kWater, mast).port->heel, -90.0 * kDegree, 0.02);

  const FirstImmersions none = first_immersions(ship.body, kWater, {});
  EXPECT_FALSE(none.starboard || none.port);
  const FloatingBody heavy = body_of(ship.mesh, 1.1);
  const FirstImmersions sinks = first_immersions(heavy, kWater, sunk);
  EXPECT_FALSE(sinks.starboard || sinks.port);
}

}  // namespace
}  // namespace buoyancy
