#include "waves/sea_report.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/waves/seas.h"
#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr double kTurn = 2.0 * std::numbers::pi;

const IrregularWaves kWindSea = wind_sea(2.0, 8.0);

std::vector<WaveSystemReport> report(const SeaDescription& description) {
  return report_wave_systems(description, Sea::make(description, {}).value());
}

std::vector<WaveSystemReport> report_systems(std::vector<WaveSystem> systems) {
  return report(sea_of(std::move(systems)));
}

TEST(SeaReport, DescribesRegularWaves) {
  const WaveSystemReport wave = report_systems({RegularWave{3.0, 12.0, 90.0, 0.0}}).at(0);
  EXPECT_EQ(wave.type, "regular");
  EXPECT_EQ(wave.components, 1U);
  EXPECT_EQ(wave.height, 3.0);
  EXPECT_NEAR(wave.significant_wave_height, 3.0 * std::sqrt(2.0), 1e-14);
  EXPECT_FALSE(wave.gamma);
  ASSERT_TRUE(wave.peak);
  EXPECT_EQ(wave.peak->period, 12.0);
  const double wavelength = kStandardGravity * 12.0 * 12.0 / kTurn;
  EXPECT_NEAR(wave.peak->wavelength, wavelength, 1e-11);
  EXPECT_NEAR(wave.peak->steepness, 3.0 / wavelength, 1e-15);
}

TEST(SeaReport, DescribesSpectraOfEachSystem) {
  IrregularWaves given = kWindSea;
  given.gamma = 3.3;
  IrregularWaves fully_developed = kWindSea;
  fully_developed.gamma = 1.0;
  fully_developed.significant_wave_height = 1.0;
  fully_developed.directions = 2;
  const auto reports = report_systems({RegularWave{3.0, 12.0, 0.0, 0.0}, kWindSea, given, fully_developed});
  ASSERT_EQ(reports.size(), 4U);
  EXPECT_EQ(reports[1].type, "jonswap");
  EXPECT_EQ(reports[1].components, 200U);
  EXPECT_NEAR(reports[1].significant_wave_height, 2.0, 1e-14);
  EXPECT_EQ(reports[1].gamma, default_gamma(2.0, 8.0));
  EXPECT_TRUE(reports[1].gamma_is_default);
  ASSERT_TRUE(reports[1].peak);
  EXPECT_EQ(reports[1].peak->period, 8.0);
  EXPECT_NEAR(reports[1].peak->steepness, 2.0 * kTurn / (kStandardGravity * 64.0), 1e-14);
  EXPECT_EQ(reports[2].gamma, 3.3);
  EXPECT_FALSE(reports[2].gamma_is_default);
  EXPECT_EQ(reports[3].type, "pierson_moskowitz");
  EXPECT_EQ(reports[3].components, 200U);
  EXPECT_NEAR(reports[3].significant_wave_height, 1.0, 1e-14);
}

TEST(SeaReport, CalculatesThePeakOfComponents) {
  const WaveSystemReport one = report_systems({WaveComponents{{0.5, 0.7, 0.0, 0.0}}}).at(0);
  EXPECT_EQ(one.type, "components");
  ASSERT_TRUE(one.peak);
  EXPECT_NEAR(one.peak->period, kTurn / 0.7, 1e-13);
  IrregularWaves waves = kWindSea;
  waves.gamma = 3.3;
  const WaveSystemReport many = report_systems({components_of(waves, 0)}).at(0);
  ASSERT_TRUE(many.peak);
  EXPECT_NEAR(many.peak->period, 8.0, 0.2) << "that of the spectrum";
  EXPECT_NEAR(many.height, 2.0, 1e-14);
}

TEST(SeaReport, HasNoPeakWithoutEnergy) {
  const auto reports = report_systems({WaveComponents{}, WaveComponents{{0.0, 1.0, 0.0, 0.0}}});
  for (const WaveSystemReport& still : reports) {
    EXPECT_EQ(still.height, 0.0);
    EXPECT_FALSE(still.peak);
  }
}

TEST(SeaReport, HasMomentsAndZeroCrossingPeriod) {
  const WaveSystemReport regular = report_systems({RegularWave{3.0, 12.0, 90.0, 0.0}}).at(0);
  EXPECT_NEAR(regular.m0, 9.0 / 8.0, 1e-15);
  EXPECT_NEAR(regular.m2, 9.0 / 8.0 * (kTurn / 12.0) * (kTurn / 12.0), 1e-15);
  EXPECT_NEAR(*regular.zero_crossing_period, 12.0, 1e-13);
  const WaveSystemReport two =
      report_systems({WaveComponents{{0.5, 0.7, 0.0, 0.0}, {0.3, 1.1, 0.0, 0.0}}}).at(0);
  EXPECT_NEAR(two.m1, 0.125 * 0.7 + 0.045 * 1.1, 1e-16);
  EXPECT_NEAR(*two.zero_crossing_period, kTurn * std::sqrt(0.17 / (0.125 * 0.49 + 0.045 * 1.21)), 1e-13);
}

std::vector<std::string> warnings(const SeaDescription& description) {
  const Sea sea = Sea::make(description, {}).value();
  std::vector<std::string> messages;
  for (const Warning& warning : sea_warnings("pool", sea, report_wave_systems(description, sea))) {
    messages.push_back(warning.message());
  }
  return messages;
}

std::vector<std::string> warnings(WaveSystem system, double depth = std::numeric_limits<double>::infinity()) {
  return warnings(sea_of({std::move(system)}, WavePressure::kWheeler, depth));
}

RegularWave regular(double steepness, double period) {
  const double wavelength = kStandardGravity * period * period / kTurn;
  return {steepness * wavelength, period, 0.0, 0.0};
}

TEST(SeaReport, WarnsOfWavesBeyondMichesLimit) {
  EXPECT_THAT(warnings(regular(0.141, 4.0)), IsEmpty());
  EXPECT_THAT(warnings(regular(0.143, 4.0)), SizeIs(1));
  EXPECT_THAT(warnings(regular(0.2, 1.0)), SizeIs(1));
  EXPECT_EQ(
      warnings(RegularWave{7.9, 4.0, 0.0, 0.0}),
      std::vector<std::string>{
          "pool: wave system 1: a wave height of 7.9 m; expected less than 3.546 m, at which such waves "
          "break: 0.142 lambda tanh(k depth) (Miche 1944, DNV-RP-C205). Likely cause: a height that does "
          "not belong to the period or to the depth, or one in feet. Use lower or longer waves, or deeper "
          "water: breaking is not modelled, and linear waves of this height are like none in nature."});
}

TEST(SeaReport, WarnsOfWavesTooHighForTheDepth) {
  EXPECT_THAT(warnings(RegularWave{1.55, 20.0, 0.0, 0.0}, 2.0), IsEmpty());
  EXPECT_THAT(warnings(RegularWave{1.9, 8.0, 0.0, 0.0}, 2.0),
              ElementsAre(HasSubstr("less than 1.56 m, at which such waves break: 0.78 of the depth")));
  IrregularWaves waves = kWindSea;
  waves.peak_period = 12.0;
  EXPECT_THAT(warnings(waves, 3.4), IsEmpty());
  EXPECT_THAT(warnings(waves, 3.3),
              ElementsAre(HasSubstr("less than 1.98 m, at which such waves break: Hs of 0.6")));
}

TEST(SeaReport, WarnsOfSpectraTooSteep) {
  const auto of = [](double steepness, double period) {
    return warnings(wind_sea(steepness * kStandardGravity * period * period / kTurn, period));
  };
  EXPECT_THAT(of(0.066, 5.0), IsEmpty());
  EXPECT_THAT(of(0.067, 5.0), ElementsAre(HasSubstr("2 pi Hs / (g Tp^2) is 1/15 up to Tp = 8 s")));
  EXPECT_THAT(of(0.053, 11.5), IsEmpty()) << "halfway between 1/15 and 1/25";
  EXPECT_THAT(of(0.054, 11.5), SizeIs(1));
  EXPECT_THAT(of(0.041, 18.0), SizeIs(1));
}

TEST(SeaReport, WarnsOfComponentsAloneAndTogether) {
  const double w = kTurn / 4.0;  // 25 m long, breaking from 3.55 m on
  EXPECT_THAT(warnings(WaveComponents{{1.7, w, 0.0, 0.0}}), IsEmpty());
  EXPECT_THAT(warnings(WaveComponents{{1.8, w, 0.0, 0.0}}), SizeIs(1));
  EXPECT_THAT(warnings(WaveComponents{{1.0, 0.3, 0.0, 0.0}, {0.1, 8.0, 0.0, 0.0}}),
              ElementsAre(HasSubstr("a wave height of 0.2 m")))
      << "ripples of 1 m on a swell";
  EXPECT_THAT(
      warnings(WaveComponents{{0.5, w, 0.0, 0.0}, {0.5, 1.1 * w, 0.0, 0.0}, {0.5, 0.9 * w, 0.0, 0.0}}),
      ElementsAre(HasSubstr("Hs where")));
  const Sea sea = Sea::make(sea_of({WaveComponents{{1.8, w, 0.0, 0.0}}}), {}).value();
  ASSERT_EQ(sea_warnings("received", sea, {}).size(), 1U);
  EXPECT_EQ(sea_warnings("received", sea, {})[0].subject, "received: the sea");
}

TEST(SeaReport, WarnsOfSystemsThatBreakTogether) {
  const IrregularWaves waves = wind_sea(5.0, 8.0);
  EXPECT_THAT(warnings(sea_of({waves, waves})),
              ElementsAre(HasSubstr("pool: the sea: a wave height of 7.07")));
}

TEST(SeaReport, RepeatsWhenItsRecordIsLikeItsBeginning) {
  const auto of = [](const WaveSystem& system) { return repeat_time(components_of(system, 0)); };
  EXPECT_NEAR(of(RegularWave{1.0, 12.0, 0.0, 0.0}), 12.0, 1e-12);
  EXPECT_EQ(of(WaveComponents{{0.0, 1.0, 0.0, 0.0}}), std::numeric_limits<double>::infinity());
  // Beats: |cos(0.05 t)| is 1/3 again after 38.2 s.
  EXPECT_NEAR(of(WaveComponents{{1.0, 0.9, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0}}), 38.2, 5.0);
  EXPECT_EQ(of(kWindSea), std::numeric_limits<double>::infinity());
  IrregularWaves few = kWindSea;
  few.directions = 1;
  few.frequencies = 40;
  EXPECT_NEAR(of(few) / 60.0, 7.5, 2.0) << "minutes";
}

TEST(SeaReport, TakesTheDepthIntoAccount) {
  const WaveSystemReport wave =
      report(sea_of({RegularWave{0.1, 100.0, 0.0, 0.0}}, WavePressure::kWheeler, 2.0)).at(0);
  EXPECT_NEAR(wave.peak->wavelength, 100.0 * std::sqrt(kStandardGravity * 2.0), 1.0)
      << "a shallow-water wave";
}

}  // namespace
}  // namespace buoyancy
