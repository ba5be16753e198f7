#include "waves/sea_report.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "waves/wave_spectrum.h"

namespace buoyancy {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

IrregularWaves wind_sea() {
  IrregularWaves waves;
  waves.significant_wave_height = 2.0;
  waves.peak_period = 8.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  return waves;
}

std::vector<WaveSystemReport> report(const SeaDescription& description) {
  return report_wave_systems(description, Sea::make(description, {}).value());
}

std::vector<WaveSystemReport> report_systems(std::vector<WaveSystem> systems) {
  SeaDescription description;
  description.systems = std::move(systems);
  return report(description);
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
  IrregularWaves given = wind_sea();
  given.gamma = 3.3;
  IrregularWaves fully_developed = wind_sea();
  fully_developed.gamma = 1.0;
  fully_developed.significant_wave_height = 1.0;
  fully_developed.directions = 2;
  const auto reports = report_systems({RegularWave{3.0, 12.0, 0.0, 0.0}, wind_sea(), given, fully_developed});
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
  IrregularWaves waves = wind_sea();
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

TEST(SeaReport, TakesTheDepthIntoAccount) {
  SeaDescription description;
  description.systems = {RegularWave{0.1, 100.0, 0.0, 0.0}};
  description.depth = 2.0;
  const WaveSystemReport wave = report(description).at(0);
  EXPECT_NEAR(wave.peak->wavelength, 100.0 * std::sqrt(kStandardGravity * 2.0), 1.0)
      << "a shallow-water wave";
}

}  // namespace
}  // namespace buoyancy
