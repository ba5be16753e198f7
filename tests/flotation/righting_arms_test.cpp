#include "flotation/righting_arms.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/equilibrium.h"
#include "tests/flotation/bodies.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

using Point2 = std::array<double, 2>;

// The reference: a rectangle of the section, turned, cut at the water by Sutherland and Hodgman's algorithm,
// at the level that bisection finds.
class SectionReference {
 public:
  SectionReference(double beam, double depth, double area, double height_of_mass)
      : beam_(beam), depth_(depth), area_(area), mass_(height_of_mass) {}

  // [m], the arm at a heel. y points to starboard, z up, from the middle of the keel.
  double arm(double heel) const {
    std::array<Point2, 4> corners{Point2{-beam_ / 2, 0}, Point2{beam_ / 2, 0}, Point2{beam_ / 2, depth_},
                                  Point2{-beam_ / 2, depth_}};
    for (Point2& corner : corners) corner = turned(corner, heel);
    double low = -2.0 * (beam_ + depth_);
    double high = -low;
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (low + high);
      (area_and_moment(corners, middle)[0] > area_ ? high : low) = middle;
    }
    const Point2 found = area_and_moment(corners, 0.5 * (low + high));
    return found[1] / found[0] - turned({0.0, mass_}, heel)[0];
  }

 private:
  // Heel to starboard lowers the points to starboard.
  static Point2 turned(const Point2& p, double heel) {
    return {p[0] * std::cos(heel) + p[1] * std::sin(heel), -p[0] * std::sin(heel) + p[1] * std::cos(heel)};
  }

  static Point2 area_and_moment(const std::array<Point2, 4>& corners, double level) {
    std::vector<Point2> wet;
    for (std::size_t i = 0; i < 4; ++i) {
      const Point2& a = corners[i];
      const Point2& b = corners[(i + 1) % 4];
      if (a[1] < level) wet.push_back(a);
      if ((a[1] < level) != (b[1] < level)) {
        const double share = (level - a[1]) / (b[1] - a[1]);
        wet.push_back({a[0] + share * (b[0] - a[0]), level});
      }
    }
    Point2 sums{};
    for (std::size_t i = 0; i < wet.size(); ++i) {
      const Point2& a = wet[i];
      const Point2& b = wet[(i + 1) % wet.size()];
      const double cross = a[0] * b[1] - a[1] * b[0];
      sums[0] += cross / 2.0;
      sums[1] += cross * (a[0] + b[0]) / 6.0;
    }
    return sums;
  }

  double beam_, depth_, area_, mass_;
};

std::vector<double> degrees(double from, double to, double step) {
  std::vector<double> heels;
  for (int i = 0; from + i * step <= to + 1e-9; ++i) heels.push_back((from + i * step) * kDegree);
  return heels;
}

TEST(RightingArms, OfABoxMatchAPolygonClipAtEveryHeel) {
  const BoxShip ship;
  const SectionReference reference(20.0, 12.0, 120.0, 8.0);
  const auto heels = degrees(-180, 180, 2.5);
  const auto curve = righting_curve(ship.body, kWater, heels);
  ASSERT_TRUE(curve);
  RightingArmOptions fixed;
  fixed.fixed_trim = 0.0;
  const auto with_fixed_trim = righting_curve(ship.body, kWater, heels, fixed);
  ASSERT_TRUE(with_fixed_trim);
  for (std::size_t i = 0; i < heels.size(); ++i) {
    const RightingArm& arm = curve->points[i].arm;
    EXPECT_NEAR(arm.gz, reference.arm(heels[i]), 1e-12) << heels[i] / kDegree;
    EXPECT_NEAR(arm.kn, arm.gz + 8.0 * std::sin(heels[i]), 1e-13);
    EXPECT_NEAR(arm.trim, 0.0, 1e-12);
    EXPECT_NEAR(with_fixed_trim->points[i].arm.gz, arm.gz, 1e-12);
  }
}

// The area does not depend on the step of the heel.
TEST(RightingArms, HaveTheExactAreaUnderTheCurve) {
  const BoxShip ship;
  for (const double step : {10.0, 1.0}) {
    const auto heels = degrees(-40, 40, step);
    const auto curve = righting_curve(ship.body, kWater, heels);
    ASSERT_TRUE(curve);
    const auto area_at = [&](double heel) {
      for (const RightingCurvePoint& point : curve->points) {
        if (std::abs(point.arm.heel - heel * kDegree) < 1e-9) return point.area;
      }
      return std::nan("");
    };
    EXPECT_NEAR(area_at(30), 0.132002392797, 1e-12);
    EXPECT_NEAR(area_at(40) - area_at(30), 0.16178627, 1e-8);
    EXPECT_NEAR(area_at(-30), area_at(30), 1e-13);
    EXPECT_NEAR(area_at(0), 0.0, 1e-15);
  }
}

TEST(RightingArms, FindTheMaximumAndTheVanishingAngle) {
  const BoxShip ship;
  const SectionReference reference(20.0, 12.0, 120.0, 8.0);
  const auto curve = righting_curve(ship.body, kWater, degrees(-180, 180, 5));
  ASSERT_TRUE(curve && curve->max_starboard && curve->max_port && curve->vanishing_starboard());
  const double maximum = curve->max_starboard->heel;
  EXPECT_GT(reference.arm(maximum), reference.arm(maximum + 1e-3));
  EXPECT_GT(reference.arm(maximum), reference.arm(maximum - 1e-3));
  EXPECT_NEAR(curve->max_port->heel, -maximum, 1e-6);
  EXPECT_NEAR(curve->max_port->gz, -curve->max_starboard->gz, 1e-12);
  const double vanishing = *curve->vanishing_starboard();
  EXPECT_GT(vanishing, 60 * kDegree);
  EXPECT_NEAR(reference.arm(vanishing), 0.0, 1e-11);
  EXPECT_NEAR(*curve->vanishing_port(), -vanishing, 1e-11);
}

TEST(RightingArms, CrossZeroAtTheAngleOfLoll) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{60, 20, 12}, {1, 1, 1}});
  const FloatingBody body = body_of(mesh, 0.5, Vec3(0, 0, 8.7 - 6.0));
  const auto curve = righting_curve(body, kWater, degrees(-90, 90, 5));
  ASSERT_TRUE(curve);
  const double radius = 400.0 / 72.0;
  const double loll = std::atan(std::sqrt(-2.0 * (3.0 + radius - 8.7) / radius));
  ASSERT_EQ(curve->crossings.size(), 4U);
  EXPECT_NEAR(curve->crossings[1].heel, -loll, 1e-11);
  EXPECT_NEAR(curve->crossings[2].heel, loll, 1e-11);
  EXPECT_TRUE(curve->crossings[2].returns);
  EXPECT_FALSE(curve->crossings[3].returns);
  EXPECT_EQ(curve->vanishing_starboard(), curve->crossings[3].heel);
}

// A hull that is not symmetric fore and aft trims as it heels: at the free trim no moment about the
// transverse axis is left, and the area is that of a fine sum.
TEST(RightingArms, CrossZeroAtTheAngleOfList) {
  // The centre of mass is off the centre plane to starboard, so that GZ = sin (GM + BM/2 tan^2) - y cos.
  const BoxShip ship;
  constexpr double kBm = 400.0 / 72.0;
  constexpr double kGm = 3.0 + kBm - 8.0;
  for (const double offset : {1e-4, 0.03, 0.3}) {
    const FloatingBody body = body_of(ship.mesh, 0.5, Vec3(0, -offset, 2.0));
    for (const double step : {5.0, 4.0, 0.5}) {
      const auto curve = righting_curve(body, kWater, degrees(-90.0, 90.0, step));
      ASSERT_TRUE(curve);
      std::vector<double> rests;
      for (const ArmCrossing& crossing : curve->crossings) {
        if (crossing.returns) rests.push_back(crossing.heel);
      }
      ASSERT_EQ(rests.size(), 1U) << offset << ' ' << step;
      const double tangent = std::tan(rests[0]);
      EXPECT_GT(tangent, 0.0);
      EXPECT_NEAR(tangent * (kGm + 0.5 * kBm * tangent * tangent), offset, 1e-9) << offset << ' ' << step;
      EXPECT_LT(curve->vanishing_port().value(), -0.9);
      EXPECT_GT(curve->vanishing_starboard().value(), 0.9);
    }
  }
}

TEST(RightingArms, LeaveNoTrimmingMomentWithFreeTrim) {
  const HydrostaticMesh aft = mesh_of(BoxShape{{20, 6, 4}, {1, 1, 1}});
  const HydrostaticMesh forward = mesh_of(BoxShape{{20, 3, 4}, {1, 1, 1}});
  const std::array<PlacedMesh, 2> parts{PlacedMesh{.mesh = &aft, .position_B = Vec3(-10, 0, 0)},
                                        PlacedMesh{.mesh = &forward, .position_B = Vec3(10, 0, 0)}};
  const FloatingBody body =
      FloatingBody::make(parts, 0.5 * 720.0 * kWater.density, Vec3(-1.0, 0.1, -0.5)).value();
  const auto heels = degrees(-120, 120, 0.5);
  const auto curve = righting_curve(body, kWater, heels);
  ASSERT_TRUE(curve);
  const ShipAxes axes;
  double sum = 0.0;
  for (std::size_t i = 0; i < heels.size(); ++i) {
    const RightingArm& arm = curve->points[i].arm;
    const Eigen::Quaterniond q = attitude_at(axes, {arm.heel, arm.trim}, Vec3::UnitZ());
    // The height from the draught, for the state at this pose.
    const Vec3 up_B = q.conjugate() * Vec3::UnitZ();
    const Pose pose{Vec3(0, 0, -arm.draft - lowest_along(body, up_B) - up_B.dot(body.center_B())), q};
    const auto state = floating_state(body, pose, kWater);
    ASSERT_TRUE(state);
    const double weight = body.mass() * kWater.gravity;
    EXPECT_NEAR(state->force_W.z(), 0.0, 1e-11 * weight);
    EXPECT_NEAR(state->torque_W.y(), 0.0, 1e-11 * weight);
    // The torque about the forward axis turns the body back: to port.
    EXPECT_NEAR(state->torque_W.x(), -arm.gz * weight, 1e-11 * weight);
    EXPECT_NEAR(state->energy, arm.energy, 1e-12 * weight);
    if (heels[i] > 1e-9) {
      sum += 0.5 * (arm.gz + curve->points[i - 1].arm.gz) * (arm.heel - curve->points[i - 1].arm.heel);
      EXPECT_NEAR(curve->points[i].area, sum, 1e-4 * std::max(sum, 0.1)) << arm.heel / kDegree;
    }
  }
  EXPECT_GT(std::abs(curve->points.back().arm.trim), 0.03);
}

TEST(RightingArms, AreAbsentForABodyThatSinks) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  EXPECT_FALSE(righting_arm(body_of(mesh, 1.1), kWater, 0.3));
  const std::array<double, 2> heels{0.0, 0.3};
  EXPECT_FALSE(righting_curve(body_of(mesh, 1.1), kWater, heels));
}

TEST(RightingArms, ReportTheirProgress) {
  const BoxShip ship;
  RightingArmOptions options;
  std::vector<std::int64_t> done;
  options.progress = [&](std::int64_t count, std::int64_t total) {
    EXPECT_EQ(total, 5);
    done.push_back(count);
  };
  const std::array heels{-0.2, -0.1, 0.0, 0.1, 0.2};
  ASSERT_TRUE(righting_curve(ship.body, kWater, heels, options));
  EXPECT_EQ(done, (std::vector<std::int64_t>{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace buoyancy
