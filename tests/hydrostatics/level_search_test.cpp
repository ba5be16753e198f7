#include "hydrostatics/level_search.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

struct Found {
  double level = 0.0;
  int evaluations = 0;
};

// Searches from 0 to 1, starting at the middle.
Found search_in_unit_interval(const std::function<double(double)>& volume, double target, double slope) {
  LevelSearch search(0.0, 1.0, slope);
  Found found{.level = 0.5, .evaluations = 0};
  for (;;) {
    const double excess = volume(found.level) - target;
    ++found.evaluations;
    search.add(found.level, excess, excess);
    if (excess == 0.0 || search.is_narrow() || found.evaluations == 300) return found;
    found.level = search.next(search.is_slow(2));
  }
}

TEST(LevelSearch, FindsLinearVolumeAtSecondLevelFromItsSlope) {
  const Found found = search_in_unit_interval([](double level) { return 3.0 * level; }, 0.75, 3.0);
  EXPECT_EQ(found.level, 0.25);
  EXPECT_EQ(found.evaluations, 2);
}

TEST(LevelSearch, FindsLevelOfCurvedVolumes) {
  for (const double level : {1e-6, 0.01, 0.3, 0.5, 0.77, 0.999}) {
    for (const double power : {1.0, 2.0, 3.0, 0.5}) {
      const auto volume = [&](double at) { return std::pow(at, power); };
      const Found found = search_in_unit_interval(volume, volume(level), 0.0);
      EXPECT_NEAR(found.level, level, 1e-15 / level) << power;
      EXPECT_LE(found.evaluations, 60) << level << " " << power;
    }
  }
}

TEST(LevelSearch, FindsLevelBetweenFlatPartsAndAtSteps) {
  const auto step = [](double at) { return at < 0.7 ? 0.0 : 1.0; };
  EXPECT_NEAR(search_in_unit_interval(step, 0.5, 0.0).level, 0.7, 1e-15);
  const auto ramp = [](double at) { return std::fmin(std::fmax((at - 0.9) / 1e-3, 0.0), 1.0); };
  EXPECT_NEAR(search_in_unit_interval(ramp, 0.25, 0.0).level, 0.90025, 1e-15);
}

TEST(LevelSearch, IsSlowWhereExcessDoesNotHalve) {
  LevelSearch search(0.0, 1.0, 0.0);
  search.add(0.2, -1.0, -1.0);
  search.add(0.3, -0.9, -0.9);
  EXPECT_FALSE(search.is_slow(1)) << "two levels are too few";
  search.add(0.4, -0.46, -0.46);
  EXPECT_TRUE(search.is_slow(1)) << "0.46 is more than half of 0.9";
  EXPECT_FALSE(search.is_slow(2)) << "0.46 is less than half of 1";
}

}  // namespace
}  // namespace buoyancy
