#include "waves/sea_snapshot.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "tests/waves/random_grid.h"
#include "waves/dispersion.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = kStandardGravity;
constexpr std::int64_t kToday = 1'795'478'400'123'457;  // [us], in 2026

Sea make_sea(std::vector<WaveSystem> systems, const std::function<void(SeaDescription&)>& change = {},
             const Water& water = {}) {
  SeaDescription description{.systems = std::move(systems)};
  if (change) change(description);
  return Sea::make(description, water).value();
}

Sea wind_sea(double height, double depth = std::numeric_limits<double>::infinity(),
             const Vec3& current_W = Vec3::Zero()) {
  const IrregularWaves waves{.significant_wave_height = height,
                             .peak_period = 5.0,
                             .gamma = {},
                             .direction = 30.0,
                             .spreading = 10.0,
                             .frequencies = 10,
                             .directions = 3};
  return make_sea({waves}, [&](SeaDescription& description) {
    description.depth = depth;
    description.current_W = current_W;
  });
}

std::int64_t microseconds(double t) {
  return static_cast<std::int64_t>(std::llround(1e6 * t));
}

TEST(SeaSnapshot, RegularWaveIsACosine) {
  const Sea sea = make_sea({RegularWave{3.0, 8.0, 60.0, 90.0}});
  const double k = wave_number(2.0 * kPi / 8.0, kGravity, std::numeric_limits<double>::infinity());
  SeaSnapshot now(sea);
  for (const double t : {0.0, 1.0, 3.5}) {
    now.set_time(microseconds(t));
    for (const double x : {0.0, 10.0, -25.0}) {
      const double y = 0.3 * x + 1.0;
      const double along = x * std::cos(kPi / 3.0) + y * std::sin(kPi / 3.0);
      EXPECT_NEAR(now.elevation(x, y), 1.5 * std::cos(k * along - 2.0 * kPi / 8.0 * t + kPi / 2.0), 1e-13);
    }
  }
}

TEST(SeaSnapshot, LeadTimeIsLater) {
  const Sea sea = wind_sea(1.0);
  SeaSnapshot now(sea), later(sea);
  now.set_time(kToday, 0.25);
  later.set_time(kToday + 250'000);
  EXPECT_NEAR(now.elevation(3.0, 4.0), later.elevation(3.0, 4.0), 1e-14);
}

// Against 113 bits, with positions of 1,000 km and the utime of today.
void expect_exact_phases(const Sea& sea) {
  using Quad = boost::multiprecision::cpp_bin_float_quad;
  SeaSnapshot now(sea);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> position(-1e6, 1e6);
  for (int i = 0; i < 20; ++i) {
    const std::int64_t utime = kToday + 98'765'432'101 * i;
    const double x = position(random);
    const double y = position(random);
    Quad elevation = 0;
    for (const WaveComponent& component : sea.components()) {
      const Quad w = component.angular_frequency;
      const Quad radians = boost::math::constants::pi<Quad>() / 180;
      // Exact up to the rounding of w^2 / g, which is the component's wave number by definition.
      const Quad k = component.angular_frequency * component.angular_frequency / kGravity;
      const Quad direction = radians * component.direction;
      const Quad t = Quad(utime) / 1'000'000;
      const Quad x1 = x - sea.current_W().x() * t;
      const Quad x2 = y - sea.current_W().y() * t;
      elevation += component.amplitude *
                   cos(k * (x1 * cos(direction) + x2 * sin(direction)) - w * t + radians * component.phase);
    }
    now.set_time(utime);
    EXPECT_NEAR(now.elevation(x, y), elevation.convert_to<double>(), 1e-14 * sea.max_elevation());
  }
}

TEST(SeaSnapshot, KeepsItsPhasesFarFromOrigins) {
  expect_exact_phases(wind_sea(2.0));
}

TEST(SeaSnapshot, WavesRideOnTheCurrent) {
  constexpr double kDeep = std::numeric_limits<double>::infinity();
  const Sea sea = wind_sea(2.0, kDeep, {1.7, -0.6, 0.2});
  expect_exact_phases(sea);
  // The water of an observer who drifts is that without a current.
  SeaSnapshot carried(sea);
  const Sea still = wind_sea(2.0);
  SeaSnapshot at_rest(still);
  const double t = 50.0;
  carried.set_time(microseconds(t));
  at_rest.set_time(microseconds(t));
  const Vec3 p_W(3.0, -4.0, -1.0);
  const WaterAtPoint there = carried.at(p_W + t * Vec3(1.7, -0.6, 0.0));
  const WaterAtPoint here = at_rest.at(p_W);
  EXPECT_NEAR(there.elevation, here.elevation, 1e-13);
  EXPECT_NEAR(there.pressure, here.pressure, 1e-8);
  EXPECT_LE((there.velocity_W - here.velocity_W).norm(), 1e-13);
  EXPECT_LE((there.acceleration_W - here.acceleration_W).norm(), 1e-13);
}

TEST(SeaSnapshot, TakesEveryUtime) {
  const Sea sea = make_sea({RegularWave{2.0, 8.0, 0.0, 0.0}});
  SeaSnapshot now(sea);
  for (const std::int64_t utime : {std::numeric_limits<std::int64_t>::min(),
                                   std::numeric_limits<std::int64_t>::max(), std::int64_t{-1}}) {
    now.set_time(utime);
    EXPECT_LE(std::abs(now.phases()[0]), kPi * (1.0 + 1e-15));
  }
  // A whole number of periods later.
  now.set_time(8'000'000'000'000'000'000);
  EXPECT_NEAR(now.elevation(0.0, 0.0), 1.0, 2e-3) << "the period of 8 s is 2 pi / w to 1e-16";
}

TEST(SeaSnapshot, TimeOriginShiftsTime) {
  const Sea from_zero = wind_sea(1.0);
  const Sea from_today = make_sea({from_zero.components()},
                                  [](SeaDescription& description) { description.time_origin = kToday; });
  SeaSnapshot one(from_zero), other(from_today);
  one.set_time(12'345'678);
  other.set_time(kToday + 12'345'678);
  EXPECT_EQ(one.phases(), other.phases());
}

TEST(SeaSnapshot, RampScalesTheWaves) {
  const Sea sea = make_sea({RegularWave{2.0, 8.0, 0.0, 0.0}},
                           [](SeaDescription& description) { description.ramp = 16.0; });
  SeaSnapshot now(sea);
  EXPECT_EQ(now.elevation(0.0, 0.0), 0.0);
  now.set_time(8'000'000);
  EXPECT_NEAR(now.elevation(0.0, 0.0), 0.5, 1e-12);
  now.set_time(16'000'000);
  EXPECT_NEAR(now.elevation(0.0, 0.0), 1.0, 1e-12);
}

TEST(SeaSnapshot, PressureIsZeroAtTheSurfaceAndAbove) {
  for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
    for (const double depth : {4.0, std::numeric_limits<double>::infinity()}) {
      const IrregularWaves waves{.significant_wave_height = 1.0,
                                 .peak_period = 4.0,
                                 .gamma = {},
                                 .spreading = {},
                                 .frequencies = {}};
      const Sea sea = make_sea({waves}, [&](SeaDescription& description) {
        description.pressure = pressure;
        description.depth = depth;
      });
      SeaSnapshot now(sea);
      now.set_time(kToday);
      const double elevation = now.elevation(2.0, 1.0);
      const double head = sea.water().density * kGravity;
      EXPECT_NEAR(now.at({2.0, 1.0, elevation - 1e-9}).pressure / head, 0.0, 2e-9);
      EXPECT_EQ(now.at({2.0, 1.0, elevation + 1e-9}).pressure, 0.0);
      EXPECT_GT(now.at({2.0, 1.0, elevation - 0.5}).pressure / head, 0.1);
    }
  }
}

TEST(SeaSnapshot, HydrostaticPressureIsThatOfTheDepth) {
  const IrregularWaves waves{
      .significant_wave_height = 1.0, .peak_period = 4.0, .gamma = {}, .spreading = {}, .frequencies = {}};
  const Sea sea = make_sea(
      {waves}, [](SeaDescription& description) { description.pressure = WavePressure::kHydrostatic; });
  SeaSnapshot now(sea);
  const WaterAtPoint point = now.at({2.0, 1.0, -3.0});
  EXPECT_NEAR(point.height, -3.0 - now.elevation(2.0, 1.0), 1e-15);
  EXPECT_NEAR(point.pressure, -sea.water().density * kGravity * point.height, 1e-9);
}

TEST(SeaSnapshot, WheelerPressureHasItsClosedForm) {
  const Sea sea = make_sea({RegularWave{1.0, 5.0, 0.0, 0.0}},
                           [](SeaDescription& description) { description.depth = 4.0; });
  SeaSnapshot now(sea);
  const double k = sea.prepared().wave_number[0];
  for (const double x : {0.0, 2.0, 7.0}) {
    const double eta = 0.5 * std::cos(k * x);
    const double zeta = -1.5;
    const double stretched = 4.0 * (zeta - eta) / (4.0 + eta);
    const double head = -zeta + std::cosh(k * (stretched + 4.0)) / std::cosh(4.0 * k) * eta;
    EXPECT_NEAR(now.at({x, 3.0, zeta}).pressure, sea.water().density * kGravity * head, 1e-9);
  }
}

// Linear theory holds to first order in the amplitude: for waves of micrometres its equations hold exactly.
class LinearTheory : public ::testing::TestWithParam<double> {};

TEST_P(LinearTheory, VelocityPressureAndElevationBelongTogether) {
  const Sea sea = wind_sea(1e-6, GetParam());
  constexpr double kStep = 1e-3;
  constexpr std::int64_t kMicroseconds = 1000;
  const Vec3 p_W(12.0, -5.0, -1.3);
  const double level = std::abs(sea.max_elevation());
  SeaSnapshot before(sea), now(sea), after(sea);
  before.set_time(kToday - kMicroseconds);
  now.set_time(kToday);
  after.set_time(kToday + kMicroseconds);

  const auto derivative = [](double low, double high) { return (high - low) / (2.0 * kStep); };
  const WaterAtPoint here = now.at(p_W);
  double divergence = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = kStep * Vec3::Unit(i);
    const WaterAtPoint low = now.at(p_W - step);
    const WaterAtPoint high = now.at(p_W + step);
    divergence += derivative(low.velocity_W[i], high.velocity_W[i]);
    // Euler's equation without its quadratic term.
    const double pressure_gradient = derivative(low.pressure, high.pressure) / sea.water().density;
    const double weight = i == 2 ? kGravity : 0.0;
    EXPECT_NEAR(here.acceleration_W[i], -pressure_gradient - weight, 1e-4 * level + 1e-8) << i;
    EXPECT_NEAR(here.acceleration_W[i], derivative(before.at(p_W).velocity_W[i], after.at(p_W).velocity_W[i]),
                1e-5 * level)
        << i;
  }
  EXPECT_NEAR(divergence, 0.0, 1e-5 * level);
  // The surface moves with the water.
  const Vec3 at_surface(12.0, -5.0, 0.0);
  EXPECT_NEAR(now.at(at_surface).velocity_W.z(),
              derivative(before.elevation(12.0, -5.0), after.elevation(12.0, -5.0)), 1e-5 * level);
  // No water crosses the bed.
  if (std::isfinite(GetParam())) {
    EXPECT_NEAR(now.at({12.0, -5.0, -GetParam()}).velocity_W.z(), 0.0, 1e-6 * level);
  }
}

INSTANTIATE_TEST_SUITE_P(Depths, LinearTheory,
                         ::testing::Values(2.0, 10.0, std::numeric_limits<double>::infinity()));

TEST(SeaSnapshot, TurnsWithUp) {
  const std::vector<WaveSystem> systems{wind_sea(1.0).components()};
  const Sea upright = make_sea(systems);
  Water sideways;
  sideways.up_W = Vec3::UnitX();
  sideways.level = 2.0;
  const Sea turned = make_sea(systems, {}, sideways);
  SeaSnapshot one(upright), other(turned);
  one.set_time(kToday);
  other.set_time(kToday);
  const Vec3 along(3.0, 4.0, -1.0);  // on e1, e2 and up
  const WaterAtPoint expected = one.at(along);
  const WaterAtPoint found = other.at({along.z() + 2.0, along.x(), along.y()});
  EXPECT_NEAR(found.pressure, expected.pressure, 1e-9);
  EXPECT_NEAR(found.velocity_W.x(), expected.velocity_W.z(), 1e-12);
  EXPECT_NEAR(found.velocity_W.y(), expected.velocity_W.x(), 1e-12);
  EXPECT_NEAR(found.velocity_W.z(), expected.velocity_W.y(), 1e-12);
}

// The water's surface at two times [us] is that of these functions.
Sea sea_of_surfaces(std::int64_t first, std::int64_t second, const Water& water = {}) {
  const auto surface = [](std::int64_t utime, const std::function<double(double, double)>& elevation) {
    auto spline = std::make_shared<ElevationSpline>();
    EXPECT_TRUE(spline->set(sampled(20, 20, {0.0, 0.0}, {1.0, 1.0}, false, elevation).grid));
    return TimedElevation{utime, std::move(spline)};
  };
  return Sea::of_surfaces({surface(first, [](double x1, double) { return 0.1 * x1; }),
                           surface(second, [](double, double x2) { return 0.2 * x2 - 1.0; })},
                          water);
}

TEST(SeaSnapshot, IsLinearInTimeBetweenTwoSurfaces) {
  Water water;
  water.level = 2.0;
  const Sea sea = sea_of_surfaces(kToday, kToday + 400'000, water);
  EXPECT_FALSE(sea.is_still());
  SeaSnapshot now(sea);
  const auto between = [](double share, double x1, double x2) {
    return (1.0 - share) * 0.1 * x1 + share * (0.2 * x2 - 1.0);
  };
  for (const double share : {-3.0, 0.0, 0.25, 0.75, 1.0, 50.0}) {
    now.set_time(kToday + static_cast<std::int64_t>(400'000 * share));
    const double clamped = std::min(std::max(share, 0.0), 1.0);
    EXPECT_NEAR(now.elevation(3.5, 7.25), between(clamped, 3.5, 7.25), 1e-12) << share;
    const WaterAtPoint point = now.at({3.5, 7.25, 1.0});
    EXPECT_NEAR(point.height, 1.0 - water.level - between(clamped, 3.5, 7.25), 1e-12);
    EXPECT_NEAR(point.pressure, -point.height * water.density * water.gravity, 1e-6);
    // The surface moves between the two times, and until the later one.
    const double rise = share > 0.0 && share <= 1.0 ? (0.2 * 7.25 - 1.0 - 0.1 * 3.5) / 0.4 : 0.0;
    EXPECT_NEAR((point.velocity_W - rise * Vec3::UnitZ()).norm(), 0.0, 1e-12);
    EXPECT_EQ(point.acceleration_W, Vec3::Zero());
  }
  now.set_time(kToday, 0.1);
  EXPECT_NEAR(now.elevation(3.5, 7.25), between(0.25, 3.5, 7.25), 1e-12);
}

TEST(SeaSnapshot, HasNoElevationBeyondTheEdgeOfAGrid) {
  const Sea sea = sea_of_surfaces(0, 1);
  const SeaSnapshot now(sea);
  EXPECT_NEAR(now.elevation(19.0, 0.0), 1.9, 1e-12);
  for (const auto& [x1, x2] : {std::pair(-0.01, 5.0), {19.01, 5.0}, {5.0, -0.01}, {5.0, 1e300}}) {
    EXPECT_TRUE(std::isnan(now.elevation(x1, x2))) << x1 << ", " << x2;
  }
}

TEST(Sea, OfSurfacesHasTheHighestElevationOfItsGrids) {
  const Sea sea = sea_of_surfaces(0, 1);
  EXPECT_NEAR(sea.max_elevation(), 2.8, 0.3);
  EXPECT_GE(sea.max_elevation(), 2.8);
  EXPECT_EQ(sea.pressure(), WavePressure::kHydrostatic);
}

}  // namespace
}  // namespace buoyancy
