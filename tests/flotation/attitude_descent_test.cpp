#include "flotation/attitude_descent.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

constexpr int kStarts = 40;

// Descends from rough starts around an attitude that is tilted by an angle, with no minimum known. Returns
// how many ended. All ends are on one curve of equal energy.
int ends_from(const FloatingBody& body, double tilt) {
  const Balance balance(body, kWater);
  AttitudeDescent descent(balance);
  std::optional<double> energy;
  int ends = 0;
  for (int i = 0; i < kStarts; ++i) {
    const double angle = tilt + 0.2 * kDegree * (i % 5);
    const double azimuth = 2.4 * i;
    const Vec3 up(std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle));
    const std::optional<BalancedAttitude> start = balance.at(up, nullptr, balance.start_slack());
    if (!start) continue;
    const std::optional<Minimum> end = descent.minimum_from(
        *start,
        [](const BalancedAttitude& /*at*/, const Vec3& /*target*/, double /*step*/) { return false; });
    if (!end) continue;
    ++ends;
    EXPECT_LE(end->attitude.gradient.norm(), balance.gradient_rounding());
    if (!energy) energy = end->attitude.energy;
    EXPECT_NEAR(end->attitude.energy, *energy, 1e-9 * *energy);
  }
  return ends;
}

// The curve of loll is at 25.4 degrees. A rough start there may have less energy than the curve.
TEST(AttitudeDescent, EndsFromRoughStartsInAValleyWithRipples) {
  const HydrostaticMesh mesh = mesh_of(CylinderShape{1.0, 1.0, 256, 1});
  const double density = 1500.0 / (kWater.density * mesh.volume);
  EXPECT_EQ(ends_from(body_of(mesh, density, Vec3(0, 0, 0.33)), 25.0 * kDegree), kStarts);
}

// The valley of a cone is a narrow circle, with a slope that is below the rounding of the energy. Some
// descents wander where even its curvature is rounding.
TEST(AttitudeDescent, FollowsAValleyThatIsCurved) {
  const HydrostaticMesh mesh = mesh_of(ConeShape{1.0, 1.992, 14, 1});
  EXPECT_GE(ends_from(body_of(mesh, 0.4609, Vec3(0, 0, 0.5339)), 160.0 * kDegree), kStarts * 3 / 4);
}

}  // namespace
}  // namespace buoyancy
