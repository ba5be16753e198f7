#include "waves/sea.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/waves/seas.h"
#include "waves/sea_snapshot.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

const IrregularWaves kWindSea = wind_sea(2.0, 8.0);

std::string error_of(const SeaDescription& description, const Water& water = {}) {
  const Expected<Sea> sea = Sea::make(description, water);
  return sea ? "no error" : sea.error().message();
}

TEST(Sea, JoinsItsSystems) {
  const Expected<Sea> sea = Sea::make(sea_of({kWindSea, RegularWave{3.0, 12.0, 90.0, 0.0}}), {});
  ASSERT_TRUE(sea) << sea.error().message();
  EXPECT_EQ(sea->components().size(), 201U);
  EXPECT_EQ(sea->prepared().size(), 201U);
  EXPECT_NEAR(sea->significant_wave_height(), std::sqrt(4.0 + 16.0 * 1.5 * 1.5 / 2.0), 1e-12);
  EXPECT_NEAR(sea->max_elevation(), 200.0 * 0.5 * std::sqrt(2.0 / 200.0) + 1.5, 1e-12);
  EXPECT_EQ(sea->prepared().k1.back(), 0.0) << "towards 90 degrees";
  EXPECT_EQ(sea->prepared().k2.back(), sea->prepared().wave_number.back());
}

TEST(Sea, OfItsOwnComponentsIsTheSameSea) {
  const Expected<Sea> sea = Sea::make(sea_of({kWindSea}), {});
  const Expected<Sea> again = Sea::make(sea_of({sea->components()}), {});
  EXPECT_EQ(again->prepared().k1, sea->prepared().k1);
  EXPECT_EQ(again->prepared().k2_rest, sea->prepared().k2_rest);
  EXPECT_EQ(again->prepared().phase, sea->prepared().phase);
}

TEST(Sea, OfZeroAmplitudesIsStill) {
  EXPECT_TRUE(Sea::make({}, {})->is_still());
  EXPECT_TRUE(Sea::make(sea_of({RegularWave{0.0, 8.0, 0.0, 0.0}}), {})->is_still());
  EXPECT_TRUE(Sea::make(sea_of({wind_sea(0.0, 8.0)}), {})->is_still());
  EXPECT_FALSE(Sea::make(sea_of({RegularWave{1e-6, 8.0, 0.0, 0.0}}), {})->is_still());
}

TEST(Sea, HorizontalAxesFollowUp) {
  const HorizontalAxes usual = horizontal_axes(Vec3::UnitZ());
  EXPECT_EQ(usual.e1_W, Vec3::UnitX());
  EXPECT_EQ(usual.e2_W, Vec3::UnitY());
  const HorizontalAxes along_y = horizontal_axes(Vec3::UnitY());
  EXPECT_EQ(along_y.e1_W, Vec3::UnitX());
  EXPECT_EQ(along_y.e2_W, Vec3(0, 0, -1));
  const HorizontalAxes along_x = horizontal_axes(Vec3::UnitX());
  EXPECT_EQ(along_x.e1_W, Vec3::UnitY());
  EXPECT_EQ(along_x.e2_W, Vec3::UnitZ());
  const Vec3 up_W = Vec3(0.3, -0.5, 0.9).normalized();
  const HorizontalAxes tilted = horizontal_axes(up_W);
  EXPECT_NEAR(tilted.e1_W.dot(up_W), 0.0, 1e-15);
  EXPECT_NEAR(tilted.e2_W.cross(up_W).dot(tilted.e1_W), 1.0, 1e-15) << "right-handed";
}

TEST(Sea, AmplitudesGrowAlongTheRamp) {
  SeaDescription description = sea_of({RegularWave{1.0, 8.0, 0.0, 0.0}});
  EXPECT_EQ(Sea::make(description, {})->amplitude_factor(-1.0), 1.0) << "no ramp";
  description.ramp = 20.0;
  const Expected<Sea> sea = Sea::make(description, {});
  EXPECT_EQ(sea->amplitude_factor(-1.0), 0.0);
  EXPECT_EQ(sea->amplitude_factor(0.0), 0.0);
  EXPECT_NEAR(sea->amplitude_factor(5.0), 0.5 - 0.5 * std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(sea->amplitude_factor(10.0), 0.5, 1e-15);
  EXPECT_EQ(sea->amplitude_factor(20.0), 1.0);
  EXPECT_EQ(sea->amplitude_factor(1e9), 1.0);
}

TEST(Sea, SteepnessOfOneOrTwoComponentsIsTheSumOfAk) {
  const double k = 1.0 / kStandardGravity;  // of 1 rad/s
  const auto steepness = [](WaveComponents components) {
    return Sea::make(sea_of({std::move(components)}), {})->extreme_steepness();
  };
  EXPECT_EQ(steepness({}), 0.0);
  EXPECT_NEAR(steepness({{2.0, 1.0, 0.0, 0.0}}), 2.0 * k, 1e-15);
  EXPECT_NEAR(steepness({{2.0, 1.0, 0.0, 0.0}, {1.0, 2.0, 90.0, 0.0}}), 6.0 * k, 1e-15);
}

TEST(Sea, SteepnessOfManyComponentsIsFourDeviations) {
  WaveComponents components;
  for (int i = 0; i < 50; ++i) components.push_back({0.1, 1.0 + 0.02 * i, 5.0 * i, 40.0 * i});
  double squares = 0.0;
  for (const WaveComponent& component : components) {
    const double k = component.angular_frequency * component.angular_frequency / kStandardGravity;
    squares += component.amplitude * k * component.amplitude * k;
  }
  const Expected<Sea> sea = Sea::make(sea_of({components}), {});
  EXPECT_NEAR(sea->extreme_steepness(), 4.0 * std::sqrt(0.5 * squares), 1e-14);
}

// Where a k is 1, the modelled pressure just below the surface of a crest no longer rises downwards.
TEST(Sea, IsTooSteepWherePressureFallsDownwardsUnderACrest) {
  const auto pressure_rises = [](const Sea& sea) {
    const SeaSnapshot snapshot(sea);  // a crest at the origin
    const double surface = snapshot.elevation(0.0, 0.0);
    return snapshot.at(Vec3(0, 0, surface - 1e-3)).pressure > 0.0;
  };
  for (const double ak : {0.98, 1.02}) {
    const double amplitude = ak * kStandardGravity;  // k = 1 / g
    const Expected<Sea> sea = Sea::make(sea_of({WaveComponents{{amplitude, 1.0, 0.0, 0.0}}}), {});
    ASSERT_TRUE(sea) << sea.error().message();
    EXPECT_EQ(sea->is_too_steep(), ak > 1.0) << ak;
    EXPECT_EQ(pressure_rises(*sea), ak < 1.0) << ak;
  }
}

// A number of a system of waves, and the range that it must lie in.
struct Limited {
  const char* name;
  std::function<WaveSystem(double)> system_with;
  double low, high;
  bool takes_low = true;
};

template <typename Change>
std::function<WaveSystem(double)> irregular(const Change& change) {
  return [change](double value) {
    IrregularWaves waves = kWindSea;
    change(waves, value);
    return WaveSystem(waves);
  };
}

std::vector<Limited> limited_numbers() {
  const auto regular = [](double RegularWave::*member) {
    return [member](double value) {
      RegularWave wave{1.0, 8.0, 0.0, 0.0};
      wave.*member = value;
      return WaveSystem(wave);
    };
  };
  const auto component = [](double WaveComponent::*member) {
    return [member](double value) {
      WaveComponents waves{{0.1, 1.0, 0.0, 0.0}, {0.1, 1.0, 0.0, 0.0}};
      waves[1].*member = value;
      return WaveSystem(waves);
    };
  };
  constexpr double kMost = kMaxWaveComponents;
  return {
      {"height", regular(&RegularWave::height), 0.0, 1e4},
      {"period", regular(&RegularWave::period), 0.01, 1e5},
      {"direction", regular(&RegularWave::direction), -1e6, 1e6},
      {"phase", regular(&RegularWave::phase), -1e6, 1e6},
      {"amplitude", component(&WaveComponent::amplitude), 0.0, 1e4},
      {"angular_frequency", component(&WaveComponent::angular_frequency), 1e-5, 1e3},
      {"direction", component(&WaveComponent::direction), -1e6, 1e6},
      {"phase", component(&WaveComponent::phase), -1e6, 1e6},
      {"significant_wave_height",
       irregular([](auto& waves, double value) { waves.significant_wave_height = value; }), 0.0, 1e4},
      {"peak_period", irregular([](auto& waves, double value) { waves.peak_period = value; }), 0.01, 1e5},
      {"gamma", irregular([](auto& waves, double value) { waves.gamma = value; }), 1.0, 10.0},
      {"direction", irregular([](auto& waves, double value) { waves.direction = value; }), -1e6, 1e6},
      {"spreading", irregular([](auto& waves, double value) { waves.spreading = value; }), 0.0, 1e4, false},
      {"frequencies", irregular([](auto& waves, double value) {
         waves.directions = 1;
         waves.frequencies = static_cast<std::int32_t>(value);
       }),
       1.0, kMost},
      {"directions", irregular([](auto& waves, double value) {
         waves.frequencies = 1;
         waves.directions = static_cast<std::int32_t>(value);
       }),
       1.0, kMost},
      {"cutoff", irregular([](auto& waves, double value) { waves.cutoff = value; }), 1.1, 20.0}};
}

TEST(Sea, TakesEveryNumberAtItsLimitsAndNamesOneBeyond) {
  for (const Limited& limited : limited_numbers()) {
    const std::string name = limited.name;
    const bool is_count = name == "frequencies" || name == "directions";
    const auto error_at = [&limited](double value) {
      return error_of(sea_of({RegularWave{1.0, 8.0, 0.0, 0.0}, limited.system_with(value)}));
    };
    const auto beyond = [is_count](double limit, double direction) {
      return is_count ? limit + direction : std::nextafter(limit, direction * kInfinity);
    };
    const auto is_named = AllOf(HasSubstr("wave system 2: "), HasSubstr(name + " = "));
    // The first system's component is one of those that the most frequencies leave no room for.
    if (is_count) {
      EXPECT_THAT(error_at(limited.high),
                  HasSubstr("number of wave components = 4097; expected at most 4096"));
      EXPECT_EQ(error_at(limited.high - 1.0), "no error") << name;
    } else {
      EXPECT_EQ(error_at(limited.high), "no error") << name;
    }
    if (limited.takes_low) {
      EXPECT_EQ(error_at(limited.low), "no error") << name;
    } else {
      EXPECT_THAT(error_at(limited.low), is_named);
    }
    EXPECT_THAT(error_at(beyond(limited.low, -1.0)), is_named);
    EXPECT_THAT(error_at(beyond(limited.high, 1.0)), is_named);
    if (is_count) continue;
    for (const double value : {kNaN, kInfinity}) EXPECT_THAT(error_at(value), is_named);
  }
  SeaDescription description = sea_of({RegularWave{1.0, 8.0, 0.0, 0.0}});
  description.ramp = 1e9;
  EXPECT_EQ(error_of(description), "no error");
  for (const double ramp : {std::nextafter(1e9, kInfinity), -1e-300, kNaN}) {
    description.ramp = ramp;
    EXPECT_THAT(error_of(description), AllOf(HasSubstr("the sea: "), HasSubstr("ramp = ")));
  }
}

TEST(Sea, SaysWhatRangeIsExpected) {
  IrregularWaves waves = kWindSea;
  waves.gamma = 100.0;
  EXPECT_THAT(error_of(sea_of({waves})), HasSubstr("gamma = 100; expected a number from 1 to 10"));
}

TEST(Sea, RefusesWavesHigherThanTheWaterIsDeep) {
  SeaDescription description = sea_of({RegularWave{2.0, 8.0, 0.0, 0.0}});
  description.depth = 2.0;
  EXPECT_THAT(error_of(description), HasSubstr("height = 2; expected less than the water's depth, 2 m"));
  description.depth = std::nextafter(2.0, kInfinity);
  EXPECT_EQ(error_of(description), "no error");
  description.depth = 0.0;
  EXPECT_THAT(error_of(description), HasSubstr("depth = 0"));
  description.depth = -kInfinity;
  EXPECT_THAT(error_of(description), HasSubstr("depth = -inf"));
}

TEST(Sea, RefusesSystemsWhoseTroughsReachTheBed) {
  const WaveComponents pair{{0.9, 1.0, 0.0, 0.0}, {0.9, 1.1, 0.0, 0.0}};
  SeaDescription description = sea_of({pair});
  description.depth = 1.0;
  EXPECT_THAT(error_of(description),
              HasSubstr("deepest trough = 1.8; expected less than the water's depth, 1 m"));
  description.depth = 1.9;
  EXPECT_EQ(error_of(description), "no error");
  IrregularWaves waves;
  waves.significant_wave_height = 0.8;
  description = sea_of({waves, waves});
  description.depth = 1.0;
  EXPECT_THAT(error_of(description), HasSubstr("deepest trough = 1.13"));
  description.depth = 1.2;
  EXPECT_EQ(error_of(description), "no error");
}

TEST(Sea, RefusesWavesWithoutGravity) {
  Water water;
  water.gravity = 0.0;
  EXPECT_THAT(error_of(sea_of({RegularWave{1.0, 8.0, 0.0, 0.0}}), water), HasSubstr("gravity = 0"));
  EXPECT_EQ(error_of({}, water), "no error");
}

}  // namespace
}  // namespace buoyancy
