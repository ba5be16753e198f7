#include "waves/wave_spectrum.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

IrregularWaves wind_sea() {
  IrregularWaves waves;
  waves.significant_wave_height = 2.0;
  waves.peak_period = 8.0;
  waves.gamma = 3.3;
  return waves;
}

// Integral of w^n S(w), by the midpoint rule.
double moment(const WaveSpectrum& spectrum, int n, double cutoff_frequency) {
  constexpr int kSteps = 3000;
  const double step = cutoff_frequency / kSteps;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double frequency = (i + 0.5) * step;
    if (frequency > 0.35 * cutoff_frequency / 3.0) {
      sum += std::pow(frequency, n) * spectrum.density(frequency) * step;
    }
  }
  return sum;
}

// The sum of a^2 / 2 w^n over components.
double moment(const WaveComponents& components, int n) {
  double sum = 0.0;
  for (const WaveComponent& component : components) {
    sum += 0.5 * component.amplitude * component.amplitude * std::pow(component.angular_frequency, n);
  }
  return sum;
}

TEST(WaveSpectrum, HasEnergyOfSignificantWaveHeight) {
  const WaveSpectrum spectrum(wind_sea());
  const double peak = 2.0 * std::numbers::pi / 8.0;
  EXPECT_NEAR(moment(spectrum, 0, 3.0 * peak), 0.25, 1e-6);
  EXPECT_GT(spectrum.density(peak), spectrum.density(0.99 * peak));
  EXPECT_GT(spectrum.density(peak), spectrum.density(1.01 * peak));
  EXPECT_EQ(spectrum.density(3.01 * peak), 0.0);
}

TEST(WaveSpectrum, EnergyBelowTheCutoffIsThatOfTheLiterature) {
  const double frequency = 0.8;
  IrregularWaves waves = wind_sea();
  waves.cutoff = 20.0;
  const double whole = WaveSpectrum(waves).density(frequency);
  for (const auto& [cutoff, share] : {std::pair{2.0, 0.951}, {3.0, 0.990}, {4.0, 0.997}, {5.0, 0.999}}) {
    waves.cutoff = cutoff;
    EXPECT_NEAR(whole / WaveSpectrum(waves).density(frequency), share, 6e-4) << cutoff;
  }
}

TEST(WaveSpectrum, PiersonMoskowitzHasItsClosedForm) {
  IrregularWaves waves = wind_sea();
  waves.gamma = 1.0;
  waves.cutoff = 20.0;
  const double peak = 2.0 * std::numbers::pi / 8.0;
  const double truncated = std::exp(-1.25 / std::pow(20.0, 4));  // share of the energy below the cutoff
  for (const double frequency : {0.5, 0.8, 1.0, 2.0, 5.0}) {
    const double closed = 5.0 / 16.0 * 4.0 * std::pow(peak, 4) * std::pow(frequency, -5) *
                          std::exp(-1.25 * std::pow(peak / frequency, 4)) / truncated;
    EXPECT_NEAR(WaveSpectrum(waves).density(frequency) / closed, 1.0, 1e-9) << frequency;
  }
}

TEST(WaveSpectrum, ComponentsKeepEnergyAndMeanFrequency) {
  const IrregularWaves waves = wind_sea();
  const WaveComponents components = components_of(waves, 0);
  ASSERT_EQ(components.size(), 40U);
  const WaveSpectrum spectrum(waves);
  const double cutoff = 3.0 * 2.0 * std::numbers::pi / 8.0;
  EXPECT_NEAR(moment(components, 0), 0.25, 1e-15);
  EXPECT_NEAR(moment(components, 1) / moment(spectrum, 1, cutoff), 1.0, 1e-6);
  EXPECT_NEAR(moment(components, 2) / moment(spectrum, 2, cutoff), 1.0, 0.01);
  EXPECT_NEAR(moment(components, -1) / moment(spectrum, -1, cutoff), 1.0, 0.01);
  for (std::size_t i = 1; i < components.size(); ++i) {
    EXPECT_GT(components[i].angular_frequency, components[i - 1].angular_frequency);
    EXPECT_EQ(components[i].amplitude, components[0].amplitude);
  }
}

TEST(WaveSpectrum, ManyBinsConvergeToTheSpectrumsMoments) {
  IrregularWaves waves = wind_sea();
  waves.frequencies = 300;
  const WaveComponents components = components_of(waves, 0);
  const WaveSpectrum spectrum(waves);
  const double cutoff = 3.0 * 2.0 * std::numbers::pi / 8.0;
  for (const int n : {-1, 1, 2, 4}) {
    EXPECT_NEAR(moment(components, n) / moment(spectrum, n, cutoff), 1.0, 1e-3) << n;
  }
}

TEST(WaveSpectrum, DefaultGammaFollowsHeightAndPeriod) {
  EXPECT_EQ(default_gamma(4.0, 7.2), 5.0);                      // 3.6
  EXPECT_NEAR(default_gamma(4.0, 8.0), std::exp(1.15), 1e-12);  // 4
  EXPECT_NEAR(default_gamma(4.0, 10.0), 1.0, 1e-12);            // 5
  EXPECT_EQ(default_gamma(4.0, 12.0), 1.0);
  IrregularWaves waves = wind_sea();
  EXPECT_EQ(gamma_of(waves), 3.3);
  waves.gamma.reset();
  EXPECT_EQ(gamma_of(waves), default_gamma(2.0, 8.0));
}

TEST(WaveSpectrum, SpreadingHasItsMeanCosine) {
  // Of cos^2s(angle / 2): s / (s + 1).
  for (const double spreading : {1.0, 4.0, 10.0, 75.0}) {
    const std::vector<double> angles = spreading_angles(spreading, 100);
    double cosines = 0.0;
    for (const double angle : angles) cosines += std::cos(angle * std::numbers::pi / 180.0);
    EXPECT_NEAR(cosines / 100.0, spreading / (spreading + 1.0), 1e-3) << spreading;
  }
}

TEST(WaveSpectrum, SpreadingIsSymmetric) {
  EXPECT_EQ(spreading_angles(10.0, 1), std::vector<double>{0.0});
  const std::vector<double> angles = spreading_angles(10.0, 5);
  ASSERT_EQ(angles.size(), 5U);
  EXPECT_EQ(angles[2], 0.0);
  EXPECT_EQ(angles[0], -angles[4]);
  EXPECT_EQ(angles[1], -angles[3]);
  EXPECT_LT(angles[3], angles[4]);
}

TEST(WaveSpectrum, DirectionalComponentsAreTheProductOfTheBins) {
  IrregularWaves waves = wind_sea();
  waves.direction = 30.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  const WaveComponents components = components_of(waves, 0);
  ASSERT_EQ(components.size(), 200U);
  EXPECT_NEAR(moment(components, 0), 0.25, 1e-15);
  EXPECT_EQ(components[2].direction, 30.0);
  EXPECT_EQ(components[0].angular_frequency, components[4].angular_frequency);
  EXPECT_NE(components[0].phase, components[1].phase);
  EXPECT_NE(components_of(waves, 1)[0].phase, components[0].phase) << "another system has other phases";
}

TEST(WaveSpectrum, SameSeedGivesTheSameBitsEverywhere) {
  IrregularWaves waves = wind_sea();
  waves.direction = 30.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  const WaveComponents components = components_of(waves, 0);
  const std::array<std::pair<std::size_t, WaveComponent>, 3> known{
      {{0, {0.050000000000000003, 0.58143928978123527, -5.0303020455761356, 320.49330227125586}},
       {57, {0.050000000000000003, 0.77156891271384487, 30.0, 149.99991240058236}},
       {199, {0.050000000000000003, 1.9578291276994171, 65.030302045576136, 40.15384701542542}}}};
  for (const auto& [i, component] : known) {
    EXPECT_EQ(components[i].amplitude, component.amplitude) << i;
    EXPECT_EQ(components[i].angular_frequency, component.angular_frequency) << i;
    EXPECT_EQ(components[i].direction, component.direction) << i;
    EXPECT_EQ(components[i].phase, component.phase) << i;
  }
}

TEST(WaveSpectrum, CountsComponentsOfEverySystem) {
  IrregularWaves waves = wind_sea();
  waves.frequencies = 7;
  waves.directions = 3;
  IrregularWaves spread = waves;
  spread.spreading = 10.0;
  for (const WaveSystem& system :
       {WaveSystem(waves), WaveSystem(spread), WaveSystem(RegularWave{3.0, 8.0, 45.0, 90.0}),
        WaveSystem(WaveComponents(5)), WaveSystem(WaveComponents())}) {
    EXPECT_EQ(number_of_components(system), components_of(system, 0).size()) << system.index();
  }
}

TEST(WaveSpectrum, RegularWaveIsOneComponent) {
  const WaveComponents components = components_of(RegularWave{3.0, 8.0, 45.0, 90.0}, 0);
  ASSERT_EQ(components.size(), 1U);
  EXPECT_EQ(components[0].amplitude, 1.5);
  EXPECT_EQ(components[0].angular_frequency, 2.0 * std::numbers::pi / 8.0);
  EXPECT_EQ(components[0].direction, 45.0);
  EXPECT_EQ(components[0].phase, 90.0);
}

}  // namespace
}  // namespace buoyancy
