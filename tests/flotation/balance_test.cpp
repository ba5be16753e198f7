#include "flotation/balance.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

const Water kWater;

// A cube that floats on a corner: the part below the water is a tip of volume sqrt(3)/2 d^3 at draught d, or
// the part above it is.
TEST(Balance, FindsTheDraughtOnATipForEveryDensity) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{1, 1, 1}, {3, 3, 3}});
  const Vec3 up = Vec3(1, 1, 1).normalized();
  for (const double part : {1e-9, 1e-6, 1e-3, 0.1}) {
    SCOPED_TRACE(part);
    const double tip = std::cbrt(part * 2.0 / std::sqrt(3.0));
    const double half = 0.5 * std::sqrt(3.0);
    for (const bool is_light : {true, false}) {
      const FloatingBody body = body_of(mesh, is_light ? part : 1.0 - part);
      const std::optional<BalancedAttitude> at = Balance(body, kWater).at(up);
      ASSERT_TRUE(at);
      EXPECT_TRUE(at->is_exact);
      EXPECT_NEAR(at->height, is_light ? half - tip : tip - half, 1e-15 + 1e-15 / (tip * tip));
    }
  }
}

// With slack the energy is off by the third power of what is left, and never below what balances by more.
TEST(Balance, CorrectsForTheSlackItIsGiven) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 8, .roughness = 0.4, .seed = 2});
  const FloatingBody body = body_of(mesh, 0.3, Vec3(0.1, 0.0, -0.2));
  const Balance balance(body, kWater);
  const Vec3 start = Vec3(0.2, -0.3, 0.9).normalized();
  BalancedAttitude from = *balance.at(start);
  balance.curvature(from);
  const Vec3 up = turned(start, 0.3 * start.unitOrthogonal());
  const BalancedAttitude exact = *balance.at(up, &from);
  const double scale = body.mass() * std::cbrt(body.volume());
  for (const double share : {1e-4, 1e-6, 1e-8}) {
    SCOPED_TRACE(share);
    const BalancedAttitude rough = *balance.at(up, &from, balance.slack(share * scale, from.area));
    EXPECT_FALSE(rough.is_exact);
    EXPECT_EQ(rough.excess, 0.0);
    EXPECT_NE(rough.height, exact.height);
    EXPECT_NEAR(rough.energy, exact.energy, 0.2 * share * scale);
    EXPECT_NEAR(rough.height, exact.height, 0.3 * std::sqrt(share));
    EXPECT_LT((rough.gradient - exact.gradient).norm(), 0.3 * std::sqrt(share) * scale);
  }
}

// Without a guess the waterplane at hand corrects the attitude.
TEST(Balance, CorrectsARoughStartByItsOwnWaterplane) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{2, 1, 1}, {2, 2, 2}});
  const FloatingBody body = body_of(mesh, 0.3);
  const Balance balance(body, kWater);
  BalancedAttitude rough = *balance.at(Vec3::UnitZ(), nullptr, balance.start_slack());
  EXPECT_NE(rough.excess, 0.0);
  balance.curvature(rough);
  EXPECT_EQ(rough.excess, 0.0);
  // A box is wall-sided, so that the correction is exact.
  const BalancedAttitude exact = *balance.at(Vec3::UnitZ());
  EXPECT_NEAR(rough.height, exact.height, 1e-14);
  EXPECT_NEAR(rough.energy, exact.energy, 1e-11);
  EXPECT_NEAR(rough.pivot.z(), exact.pivot.z(), 1e-14);
}

// Two cubes on a thin rod, with the water at the rod: its waterplane says nothing about the cubes.
TEST(Balance, DoesNotExtrapolateFromTheNeckOfABody) {
  const HydrostaticMesh cube = mesh_of(BoxShape{});
  const HydrostaticMesh rod = mesh_of(BoxShape{{1e-3, 1e-3, 3}, {1, 1, 1}});
  const std::array<PlacedMesh, 3> parts{PlacedMesh{.mesh = &rod},
                                        PlacedMesh{.mesh = &cube, .position_B = Vec3(0, 0, -2)},
                                        PlacedMesh{.mesh = &cube, .position_B = Vec3(0, 0, 2)}};
  const FloatingBody body = FloatingBody::make(parts, 0.95 * kWater.density, Vec3::Zero()).value();
  const Balance balance(body, kWater);
  BalancedAttitude at = *balance.at(Vec3::UnitZ(), nullptr, balance.start_slack());
  ASSERT_NEAR(at.excess, 0.05, 1e-3);
  const double height = at.height;
  balance.curvature(at);
  EXPECT_NEAR(at.area, 1e-6, 1e-12);
  EXPECT_EQ(at.height, height);
  EXPECT_NEAR(at.excess, 0.05, 1e-3);
}

}  // namespace
}  // namespace buoyancy
