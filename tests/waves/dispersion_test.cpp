#include "waves/dispersion.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Dispersion, HoldsFromShallowToDeepWater) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> log_frequency(-4.0, 2.0), log_depth(-3.0, 5.0);
  for (int i = 0; i < 10'000; ++i) {
    const double frequency = std::pow(10.0, log_frequency(random));
    const double depth = std::pow(10.0, log_depth(random));
    const long double k = wave_number(frequency, kGravity, depth);
    const long double squared = static_cast<long double>(kGravity) * k * std::tanh(k * depth);
    const long double wanted = static_cast<long double>(frequency) * frequency;
    ASSERT_NEAR(static_cast<double>(squared / wanted), 1.0, 2e-15)
        << frequency << " rad/s, " << depth << " m";
  }
}

TEST(Dispersion, IsThatOfDeepWaterWithoutBed) {
  EXPECT_EQ(wave_number(2.0, 10.0, kInfinity), 0.4);
  EXPECT_EQ(wave_number(2.0, 10.0, 1000.0), 0.4);
}

TEST(Dispersion, TendsToThatOfShallowWater) {
  const double depth = 1e-6;
  EXPECT_NEAR(wave_number(1.0, kGravity, depth) * std::sqrt(kGravity * depth), 1.0, 1e-6);
}

}  // namespace
}  // namespace buoyancy
