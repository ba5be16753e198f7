#include "waves/elevation_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/allocation_count.h"
#include "tests/truth/reference_spline.h"
#include "tests/waves/random_grid.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ElevationSpline spline_of(const SampledGrid& sampled) {
  ElevationSpline spline;
  EXPECT_TRUE(spline.set(sampled.grid));
  return spline;
}

// Points and boxes in and around a grid.
class RandomPlaces {
 public:
  RandomPlaces(std::mt19937_64& random, const ElevationGrid<double>& grid) : random_(random), grid_(grid) {}

  // Along an axis; one of a periodic grid may be some periods away.
  double along(std::size_t axis) {
    const double samples = static_cast<double>(axis == 0 ? grid_.columns : grid_.rows);
    const double length = (grid_.periodic ? samples : samples - 1.0) * grid_.spacing[axis];
    const double from = grid_.periodic ? -2.3 * length : 0.0;
    const double to = grid_.periodic ? 3.4 * length : length;
    return grid_.origin[axis] + std::uniform_real_distribution<double>(from, to)(random_);
  }
  HorizontalBox box() {
    HorizontalBox box;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double reach =
          grid_.spacing[axis] * std::exp(std::uniform_real_distribution<double>(-3.0, 3.0)(random_));
      const double middle = along(axis);
      box.low[axis] = middle - reach;
      box.high[axis] = middle + reach;
      if (grid_.periodic) continue;
      const double last = static_cast<double>(axis == 0 ? grid_.columns : grid_.rows) - 1.0;
      box.low[axis] = std::max(box.low[axis], grid_.origin[axis]);
      box.high[axis] = std::min(box.high[axis], grid_.origin[axis] + last * grid_.spacing[axis]);
    }
    return box;
  }
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

 private:
  std::mt19937_64& random_;
  const ElevationGrid<double>& grid_;
};

TEST(ElevationSpline, IsTheSplineOfDeBoorsRecursion) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 60; ++n) {
    const SampledGrid sampled = random_grid(random, n % 2 == 0);
    const ElevationSpline spline = spline_of(sampled);
    const ReferenceSpline reference(sampled.grid);
    RandomPlaces places(random, sampled.grid);
    for (int i = 0; i < 40; ++i) {
      const double x1 = places.along(0);
      const double x2 = places.along(1);
      const ElevationDerivatives there = spline.at(x1, x2);
      const auto expect_near = [&](double actual, int order_1, int order_2) {
        const double scale =
            std::pow(sampled.grid.spacing[0], order_1) * std::pow(sampled.grid.spacing[1], order_2);
        EXPECT_NEAR(actual * scale,
                    static_cast<double>(reference.derivative(x1, x2, order_1, order_2)) * scale, 3e-13)
            << order_1 << order_2;
      };
      expect_near(there.eta, 0, 0);
      expect_near(there.eta_1, 1, 0);
      expect_near(there.eta_2, 0, 1);
      expect_near(there.eta_11, 2, 0);
      expect_near(there.eta_12, 1, 1);
      expect_near(there.eta_22, 0, 2);
    }
  }
}

TEST(ElevationSpline, PassesThroughItsSamplesAndIsNaturalAtItsEdges) {
  std::mt19937_64 random(2);
  for (const bool periodic : {false, true}) {
    const SampledGrid sampled = random_grid(random, periodic, 1e3);
    const ElevationSpline spline = spline_of(sampled);
    const ElevationGrid<double>& grid = sampled.grid;
    for (std::size_t j = 0; j < grid.rows; ++j) {
      for (std::size_t i = 0; i < grid.columns; ++i) {
        const ElevationDerivatives there =
            spline.at(grid.origin[0] + static_cast<double>(i) * grid.spacing[0],
                      grid.origin[1] + static_cast<double>(j) * grid.spacing[1]);
        EXPECT_NEAR(there.eta, sampled.samples[j * grid.columns + i], 1e-9);
        if (periodic) continue;
        if (i == 0 || i == grid.columns - 1) {
          EXPECT_NEAR(there.eta_11, 0.0, 1e-7);
        }
        if (j == 0 || j == grid.rows - 1) {
          EXPECT_NEAR(there.eta_22, 0.0, 1e-7);
        }
      }
    }
  }
}

TEST(ElevationSpline, OfAPlaneIsThePlane) {
  const auto plane = [](double x1, double x2) { return 40.0 + 0.25 * x1 - 0.5 * x2; };
  const SampledGrid sampled = buoyancy::sampled(7, 30, {-3.0, 5.0}, {0.25, 2.0}, false, plane);
  const ElevationSpline spline = spline_of(sampled);
  for (const double x1 : {-3.0, -2.9, 0.0, 4.25}) {
    for (const double x2 : {5.0, 8.1, 17.0}) {
      const ElevationDerivatives there = spline.at(x1, x2);
      EXPECT_NEAR(there.eta, plane(x1, x2), 1e-12);
      EXPECT_NEAR(there.eta_1, 0.25, 1e-12);
      EXPECT_NEAR(there.eta_2, -0.5, 1e-12);
    }
  }
  EXPECT_LE(spline.bounds().third, 1e-9);
  EXPECT_LE(spline.max_curvature(), 1e-9);
  EXPECT_NEAR(spline.max_slope(), std::hypot(0.25, 0.5), 1e-6);
}

TEST(ElevationSpline, BoundsEncloseTheSurfaceAndItsThirdDerivative) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 120; ++n) {
    const SampledGrid sampled = random_grid(random, n % 2 == 0);
    const ElevationSpline spline = spline_of(sampled);
    const ReferenceSpline reference(sampled.grid);
    RandomPlaces places(random, sampled.grid);
    for (int i = 0; i < 25; ++i) {
      const HorizontalBox box = places.box();
      EXPECT_TRUE(spline.holds(box));
      const ElevationBounds bounds = spline.bounds_over(box);
      for (int point = 0; point < 12; ++point) {
        const double x1 = places.within(box.low[0], box.high[0]);
        const double x2 = places.within(box.low[1], box.high[1]);
        const auto eta = static_cast<double>(reference.elevation(x1, x2));
        EXPECT_LE(static_cast<double>(bounds.low), eta);
        EXPECT_GE(static_cast<double>(bounds.high), eta);
        EXPECT_GE(static_cast<double>(bounds.third), reference.third_derivative(x1, x2));
        const ElevationBounds at_point = spline.bounds_over({{x1, x2}, {x1, x2}});
        EXPECT_LE(bounds.low, at_point.low);
        EXPECT_GE(bounds.high, at_point.high);
        EXPECT_GE(bounds.third, at_point.third);
        const ElevationDerivatives there = spline.at(x1, x2);
        EXPECT_GE(spline.max_slope(), std::hypot(there.eta_1, there.eta_2));
        EXPECT_GE(spline.max_curvature(), std::max(std::abs(there.eta_11), std::abs(there.eta_22)));
        EXPECT_GE(spline.max_curvature(), std::abs(there.eta_12));
      }
    }
  }
}

// One of the four entries of the third derivative alone, so that no other one makes up for it.
TEST(ElevationSpline, BoundsEveryEntryOfTheThirdDerivative) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> rough(-1.0, 1.0);
  constexpr double kMiddle = 7.5;
  for (const int order_2 : {0, 1, 2, 3}) {
    for (int n = 0; n < 30; ++n) {
      std::vector<double> heights;
      for (int i = 0; i < 16; ++i) heights.push_back(rough(random));
      const bool rough_along_1 = order_2 < 2;
      const SampledGrid grid = sampled(16, 16, {0.0, 0.0}, {1.0, 1.0}, false, [&](double x1, double x2) {
        const double height = heights[static_cast<std::size_t>(rough_along_1 ? x1 : x2)];
        const double factor = (rough_along_1 ? x2 : x1) - kMiddle;
        return order_2 == 1 || order_2 == 2 ? height * factor : height;
      });
      const ElevationSpline spline = spline_of(grid);
      const ReferenceSpline reference(grid.grid);
      RandomPlaces places(random, grid.grid);
      for (int i = 0; i < 60; ++i) {
        const double x1 = rough_along_1 ? places.along(0) : kMiddle;
        const double x2 = rough_along_1 ? kMiddle : places.along(1);
        EXPECT_GE(static_cast<double>(spline.bounds_over({{x1, x2}, {x1, x2}}).third),
                  reference.third_derivative(x1, x2))
            << order_2;
      }
    }
  }
}

// In waves that the samples resolve, away from the edges.
TEST(ElevationSpline, BoundsAreTightInARegularWave) {
  constexpr double kAmplitude = 0.5;
  constexpr double kWaveNumber = 2.0;
  constexpr double kThird = kAmplitude * kWaveNumber * kWaveNumber * kWaveNumber;
  for (const double direction : {0.0, 0.4, 2.0}) {
    const auto wave = [&](double x1, double x2) {
      return kAmplitude * std::cos(kWaveNumber * (x1 * std::cos(direction) + x2 * std::sin(direction)));
    };
    const ElevationSpline spline = spline_of(sampled(80, 90, {-4.0, -4.0}, {0.1, 0.12}, false, wave));
    const ElevationBounds bounds = spline.bounds_over({{-2.0, -2.0}, {2.0, 2.0}});
    EXPECT_NEAR(static_cast<double>(bounds.high), kAmplitude, 0.02);
    EXPECT_NEAR(static_cast<double>(bounds.low), -kAmplitude, 0.02);
    EXPECT_NEAR(static_cast<double>(bounds.third), kThird, 0.15 * kThird);
    // The third derivative is small over a crest.
    const ElevationBounds crest = spline.bounds_over({{-0.02, -0.02}, {0.02, 0.02}});
    EXPECT_LE(static_cast<double>(crest.third), 0.75 * kThird);
    EXPECT_GE(static_cast<double>(crest.low), 0.7 * kAmplitude);
  }
}

TEST(ElevationSpline, RepeatsAfterAPeriod) {
  std::mt19937_64 random(4);
  const SampledGrid sampled = random_grid(random, true, 1.0, 0.5);
  const ElevationSpline spline = spline_of(sampled);
  const ElevationGrid<double>& grid = sampled.grid;
  const double period_1 = static_cast<double>(grid.columns) * grid.spacing[0];
  const double period_2 = static_cast<double>(grid.rows) * grid.spacing[1];
  RandomPlaces places(random, grid);
  for (int i = 0; i < 50; ++i) {
    const double x1 = places.along(0);
    const double x2 = places.along(1);
    const ElevationDerivatives here = spline.at(x1, x2);
    const ElevationDerivatives there = spline.at(x1 - 1e6 * period_1, x2 + 3e5 * period_2);
    EXPECT_NEAR(here.eta, there.eta, 1e-7);
    EXPECT_NEAR(here.eta_12, there.eta_12, 1e-6);
  }
}

TEST(ElevationSpline, HoldsWhatIsWithinItsSamples) {
  const SampledGrid open = sampled(5, 9, {1.0, -2.0}, {0.5, 0.25}, false, [](double, double) { return 0.0; });
  const ElevationSpline spline = spline_of(open);
  EXPECT_TRUE(spline.holds({{1.0, -2.0}, {5.0, -1.0}}));
  EXPECT_FALSE(spline.holds({{0.99, -2.0}, {5.0, -1.0}}));
  EXPECT_FALSE(spline.holds({{1.0, -2.0}, {5.01, -1.0}}));
  EXPECT_FALSE(spline.holds({{1.0, -2.01}, {5.0, -1.0}}));
  EXPECT_FALSE(spline.holds({{1.0, -2.0}, {5.0, -0.99}}));
  EXPECT_FALSE(spline.holds({{kNaN, -2.0}, {kNaN, -1.0}}));
  const SampledGrid closed =
      sampled(5, 9, {1.0, -2.0}, {0.5, 0.25}, true, [](double, double) { return 0.0; });
  EXPECT_TRUE(spline_of(closed).holds({{-1e9, -1e9}, {1e9, 1e9}}));
}

TEST(ElevationSpline, TakesTheSamplesOfMessagesAsTheyAre) {
  std::mt19937_64 random(5);
  SampledGrid doubles = random_grid(random, false);
  std::vector<float> floats;
  for (double& sample : doubles.samples) {
    floats.push_back(static_cast<float>(sample));
    sample = static_cast<double>(floats.back());
  }
  const ElevationGrid<float> grid{floats,
                                  doubles.grid.rows,
                                  doubles.grid.columns,
                                  doubles.grid.origin,
                                  doubles.grid.spacing,
                                  doubles.grid.periodic};
  ElevationSpline spline;
  ASSERT_TRUE(spline.set(grid));
  RandomPlaces places(random, doubles.grid);
  const double x1 = places.along(0);
  const double x2 = places.along(1);
  EXPECT_EQ(spline.at(x1, x2).eta, spline_of(doubles).at(x1, x2).eta);
}

TEST(ElevationSpline, RefusesWhatIsNoGrid) {
  struct Case {
    void (*spoil)(SampledGrid&);
    std::string actual, expected;
  };
  const std::vector<Case> cases{
      {[](SampledGrid& s) { s.grid.rows = 3; }, "3 rows and 5 columns", "4 to 4096 of both"},
      {[](SampledGrid& s) { s.grid.columns = 4097; }, "4 rows and 4097 columns", "4 to 4096 of both"},
      {[](SampledGrid& s) { s.grid.elevations = s.grid.elevations.first(19); }, "19 elevations",
       "4 rows of 5"},
      {[](SampledGrid& s) { s.grid.rows = 0x8000'0000'0000'0000; }, "rows", "4 to 4096"},
      {[](SampledGrid& s) { s.grid.spacing[0] = 0.0; }, "spacing[0] = 0", "0.001 to 10000 (m)"},
      {[](SampledGrid& s) { s.grid.spacing[1] = -1.0; }, "spacing[1] = -1", "0.001 to 10000 (m)"},
      {[](SampledGrid& s) { s.grid.spacing[1] = kNaN; }, "spacing[1] = nan", "0.001 to 10000 (m)"},
      {[](SampledGrid& s) { s.grid.origin[1] = -std::numeric_limits<double>::infinity(); },
       "origin[1] = -inf", "a finite number (m)"},
      {[](SampledGrid& s) { s.samples[7] = kNaN; }, "elevation[1][2] = nan", "-1000 to 1000 (m)"},
      {[](SampledGrid& s) { s.samples[19] = 1000.5; }, "elevation[3][4] = 1000.5", "-1000 to 1000 (m)"},
      {[](SampledGrid& s) { s.samples[0] = -std::numeric_limits<double>::infinity(); },
       "elevation[0][0] = -inf", "-1000 to 1000 (m)"}};
  const SampledGrid good = sampled(4, 5, {0.0, 0.0}, {1.0, 1.0}, false, [](double x1, double) { return x1; });
  for (const Case& bad : cases) {
    SampledGrid spoiled = good;
    bad.spoil(spoiled);
    ElevationSpline spline = spline_of(good);
    const Expected<void> result = spline.set(spoiled.grid);
    ASSERT_FALSE(result) << bad.actual;
    EXPECT_EQ(result.error().subject, "the grid of elevations");
    EXPECT_THAT(result.error().actual, HasSubstr(bad.actual));
    EXPECT_THAT(result.error().expected, HasSubstr(bad.expected));
    EXPECT_NEAR(spline.at(2.5, 1.0).eta, 2.5, 1e-12) << "what was set before is gone";
  }
}

TEST(ElevationSpline, AllocatesNothingForAnotherGridOfItsSize) {
  std::mt19937_64 random(6);
  SampledGrid sampled = random_grid(random, true);
  ElevationSpline spline = spline_of(sampled);
  for (double& sample : sampled.samples) sample = -sample;
  const AllocationCount allocations;
  EXPECT_TRUE(spline.set(sampled.grid));
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ElevationBlend, IsLinearInItsShares) {
  std::mt19937_64 random(7);
  const SampledGrid first = random_grid(random, true);
  const SampledGrid second = random_grid(random, true);
  const ElevationSpline one = spline_of(first);
  const ElevationSpline other = spline_of(second);
  const ElevationBlend blend{{{{&one, 0.3}, {&other, 0.7}}}, 2};
  RandomPlaces places(random, first.grid);
  for (int i = 0; i < 100; ++i) {
    const HorizontalBox box = places.box();
    const ElevationBounds bounds = blend.bounds_over(box);
    const double x1 = places.within(box.low[0], box.high[0]);
    const double x2 = places.within(box.low[1], box.high[1]);
    const ElevationDerivatives there = blend.at(x1, x2);
    EXPECT_NEAR(there.eta, 0.3 * one.at(x1, x2).eta + 0.7 * other.at(x1, x2).eta, 1e-14);
    EXPECT_NEAR(there.eta_12, 0.3 * one.at(x1, x2).eta_12 + 0.7 * other.at(x1, x2).eta_12, 1e-12);
    EXPECT_LE(static_cast<double>(bounds.low), there.eta);
    EXPECT_GE(static_cast<double>(bounds.high), there.eta);
    EXPECT_GE(bounds.third, 0.3F * one.bounds_over(box).third);
  }
}

}  // namespace
}  // namespace buoyancy
