#include "waves/portable_math.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

TEST(PortableMath, AgreesWithTheCLibraryWithinAnUlp) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponents(-50.0, 50.0), positive(1e-3, 1e3);
  for (int i = 0; i < 1000; ++i) {
    const double x = exponents(random);
    const double y = positive(random);
    EXPECT_NEAR(portable::exp(x) / std::exp(x), 1.0, kEpsilon) << x;
    EXPECT_NEAR(portable::log(y), std::log(y), 2.0 * kEpsilon * std::abs(std::log(y))) << y;
    EXPECT_NEAR(portable::tanh(x) / std::tanh(x), 1.0, 2.0 * kEpsilon) << x;
  }
}

TEST(PortableMath, SinesAndCosinesAreExactAtQuarterTurns) {
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const portable::SinCos found = portable::sin_cos_of_degrees(90.0 * quarter);
    const int place = ((quarter % 4) + 4) % 4;
    EXPECT_EQ(found.sin, place == 1 ? 1.0 : place == 3 ? -1.0 : 0.0) << quarter;
    EXPECT_EQ(found.cos, place == 0 ? 1.0 : place == 2 ? -1.0 : 0.0) << quarter;
    EXPECT_EQ(found.sin_rest, 0.0);
    EXPECT_EQ(found.cos_rest, 0.0);
  }
}

TEST(PortableMath, SinesAndCosinesHaveQuadPrecision) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> degrees(-720.0, 720.0);
  for (int i = 0; i < 1000; ++i) {
    const double angle = degrees(random);
    const portable::SinCos found = portable::sin_cos_of_degrees(angle);
    EXPECT_NEAR(found.sin, std::sin(angle * std::numbers::pi / 180.0), 1e-14);
    EXPECT_NEAR(found.cos, std::cos(angle * std::numbers::pi / 180.0), 1e-14);
    // sin^2 + cos^2 - 1 in double-double arithmetic by fused multiply-add.
    const double sin_squared = found.sin * found.sin;
    const double cos_squared = found.cos * found.cos;
    const double rounding = std::fma(found.sin, found.sin, -sin_squared) +
                            std::fma(found.cos, found.cos, -cos_squared) + 2.0 * found.sin * found.sin_rest +
                            2.0 * found.cos * found.cos_rest;
    const double larger = std::max(sin_squared, cos_squared);
    const double smaller = std::min(sin_squared, cos_squared);
    EXPECT_NEAR((larger - 1.0) + smaller + rounding, 0.0, 1e-31) << angle;
  }
}

}  // namespace
}  // namespace buoyancy
