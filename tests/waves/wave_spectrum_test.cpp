#include "waves/wave_spectrum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

IrregularWaves wind_sea() {
  return {
      .significant_wave_height = 2.0, .peak_period = 8.0, .gamma = 3.3, .spreading = {}, .frequencies = {}};
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

TEST(WaveSpectrum, ComponentsKeepEnergyAndZeroCrossingPeriod) {
  const IrregularWaves waves = wind_sea();
  const WaveComponents components = components_of(waves, 0);
  ASSERT_EQ(components.size(), 200U);
  const WaveSpectrum spectrum(waves);
  const double cutoff = 3.0 * 2.0 * std::numbers::pi / 8.0;
  EXPECT_NEAR(moment(components, 0), 0.25, 1e-15);
  EXPECT_NEAR(moment(components, 1) / moment(spectrum, 1, cutoff), 1.0, 1e-3);
  EXPECT_NEAR(moment(components, 2) / moment(spectrum, 2, cutoff), 1.0, 1e-6);
  EXPECT_NEAR(moment(components, -1) / moment(spectrum, -1, cutoff), 1.0, 1e-3);
  for (std::size_t i = 1; i < components.size(); ++i) {
    EXPECT_GT(components[i].angular_frequency, components[i - 1].angular_frequency);
    EXPECT_EQ(components[i].amplitude, components[0].amplitude);
  }
}

// Of a spectrum of unit energy and peak frequency, not cut off: the midpoint rule in log(x), and in closed
// form what is beyond its end.
double textbook_moment(double gamma, int n) {
  constexpr double kEnd = 50.0;
  constexpr int kSteps = 100'000;
  const double begin = std::log(0.3);
  const double step = (std::log(kEnd) - begin) / kSteps;
  double energy = 0.0;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = std::exp(begin + (i + 0.5) * step);
    const double distance = (x - 1.0) / (x < 1.0 ? 0.07 : 0.09);
    const double density = std::pow(x, -5) * std::exp(-1.25 * std::pow(x, -4)) *
                           std::pow(gamma, std::exp(-0.5 * distance * distance));
    energy += density * x * step;
    sum += std::pow(x, n) * density * x * step;
  }
  return (sum + std::pow(kEnd, n - 4) / (4 - n)) / energy;
}

struct Moments {
  double m1, m2, tz;  // over those of the textbook
};

Moments against_textbook(IrregularWaves waves) {
  const double peak = 2.0 * std::numbers::pi / waves.peak_period;
  const WaveComponents components = components_of(waves, 0);
  const double energy = waves.significant_wave_height * waves.significant_wave_height / 16.0;
  EXPECT_NEAR(moment(components, 0), energy, 1e-15);
  const double m2 = moment(components, 2) / (energy * peak * peak * textbook_moment(*waves.gamma, 2));
  return {moment(components, 1) / (energy * peak * textbook_moment(*waves.gamma, 1)), m2,
          1.0 / std::sqrt(m2)};
}

// docs/waves.md states these numbers.
TEST(WaveSpectrum, MomentsAreThoseThatTheDocumentationStates) {
  for (const double spreading : {0.0, 10.0}) {
    IrregularWaves waves = wind_sea();
    if (spreading > 0.0) {
      waves.spreading = spreading;
      waves.directions = 5;
    }
    for (const auto& [gamma, m1, m2, tz] :
         {std::array{1.0, -0.032, -0.126, 0.070}, {3.3, -0.024, -0.100, 0.054}}) {
      waves.gamma = gamma;
      waves.cutoff = IrregularWaves{}.cutoff;
      const Moments by_default = against_textbook(waves);
      EXPECT_NEAR(by_default.m1 - 1.0, m1, 1e-3);
      EXPECT_NEAR(by_default.m2 - 1.0, m2, 1e-3);
      EXPECT_NEAR(by_default.tz - 1.0, tz, 1e-3);
      waves.cutoff = 8.0;
      const Moments whole = against_textbook(waves);
      EXPECT_NEAR(whole.m1, 1.0, 0.02);
      EXPECT_NEAR(whole.m2, 1.0, 0.02);
      EXPECT_NEAR(whole.tz, 1.0, 0.01);
    }
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

// Of thousands of bins the outermost lie where the density is a millionth of that in the middle.
TEST(WaveSpectrum, SpreadingReachesAsFarAsItsEnergy) {
  constexpr std::size_t kBins = 4000;
  constexpr int kSteps = 1'000'000;
  for (const double spreading : {1.0, 3.5, 10.0, 75.0, 400.0}) {
    // The mean angle of the bin on the rim, by a sum over the circle from there.
    const auto density = [spreading](double angle) {
      return std::pow(std::cos(0.5 * angle * std::numbers::pi / 180.0), 2.0 * spreading);
    };
    const double step = 180.0 / kSteps;
    double energy = 0.0;
    for (int i = 0; i < kSteps; ++i) energy += 2.0 * density((i + 0.5) * step);
    const double of_bin = energy / kBins;
    double sum = 0.0;
    double angles = 0.0;
    for (int i = kSteps - 1; sum < of_bin; --i) {
      const double share = std::min(density((i + 0.5) * step), of_bin - sum);
      sum += share;
      angles += share * (i + 0.5) * step;
    }
    EXPECT_NEAR(spreading_angles(spreading, kBins).back(), angles / sum, 2e-3) << spreading;
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

TEST(WaveSpectrum, EveryDirectionalComponentHasAFrequencyOfItsOwn) {
  IrregularWaves waves = wind_sea();
  waves.direction = 30.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  const WaveComponents components = components_of(waves, 0);
  ASSERT_EQ(components.size(), 200U);
  EXPECT_NEAR(moment(components, 0), 0.25, 1e-15);
  const std::vector<double> angles = spreading_angles(10.0, 5);
  std::set<std::vector<double>> orders;
  for (std::size_t group = 0; group < 40; ++group) {
    std::vector<double> directions;
    for (std::size_t i = 5 * group; i < 5 * group + 5; ++i) {
      if (i > 0) {
        EXPECT_GT(components[i].angular_frequency, components[i - 1].angular_frequency) << i;
      }
      directions.push_back(components[i].direction);
    }
    orders.insert(directions);
    std::sort(directions.begin(), directions.end());
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(directions[i], 30.0 + angles[i]) << group;
  }
  EXPECT_GT(orders.size(), 20U) << "of 120";
  EXPECT_NE(components[0].phase, components[1].phase);
  EXPECT_NE(components_of(waves, 1)[0].phase, components[0].phase) << "another system has other phases";
}

// With directions that share their frequencies, the heights that were measured here were 1.63 to 2.39 m.
TEST(WaveSpectrum, DirectionalSeaHasItsHeightAtEveryPlace) {
  IrregularWaves waves = wind_sea();
  waves.spreading = 10.0;
  waves.directions = 5;
  constexpr double kStep = 4.0;  // [s]
  constexpr int kSteps = 9000;   // 10 h
  for (waves.seed = 1; waves.seed <= 20; ++waves.seed) {
    const WaveComponents components = components_of(waves, 0);
    for (const auto& [x, y] :
         {std::pair{0.0, 0.0}, {100.0, -30.0}, {-7.0, 250.0}, {3e3, 4e3}, {11.0, 13.0}}) {
      std::vector<std::complex<double>> now, turn;
      for (const WaveComponent& wave : components) {
        const double w = wave.angular_frequency;
        const double direction = wave.direction * std::numbers::pi / 180.0;
        const double along = w * w / 9.80665 * (std::cos(direction) * x + std::sin(direction) * y);
        now.push_back(std::polar(wave.amplitude, along + wave.phase * std::numbers::pi / 180.0));
        turn.push_back(std::polar(1.0, -w * kStep));
      }
      double squares = 0.0;
      for (int step = 0; step < kSteps; ++step) {
        double elevation = 0.0;
        for (std::size_t i = 0; i < now.size(); ++i) {
          const double re = now[i].real() * turn[i].real() - now[i].imag() * turn[i].imag();
          now[i] = {re, now[i].real() * turn[i].imag() + now[i].imag() * turn[i].real()};
          elevation += re;
        }
        squares += elevation * elevation;
      }
      EXPECT_NEAR(4.0 * std::sqrt(squares / kSteps), 2.0, 0.06)
          << "seed " << waves.seed << " at " << x << ", " << y;
    }
  }
}

TEST(WaveSpectrum, SameSeedGivesTheSameBitsEverywhere) {
  IrregularWaves waves = wind_sea();
  waves.direction = 30.0;
  waves.spreading = 10.0;
  waves.directions = 5;
  const WaveComponents components = components_of(waves, 0);
  const std::array<std::pair<std::size_t, WaveComponent>, 3> known{
      {{0, {0.050000000000000003, 0.53554533078405608, 43.439541029419971, 320.49330227125586}},
       {57, {0.050000000000000003, 0.77157884592549431, 65.030302045576136, 149.99991240058236}},
       {199, {0.050000000000000003, 2.2344375775920264, 65.030302045576136, 40.15384701542542}}}};
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
