#include "waves/wave_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "waves/portable_math.h"
#include "waves/random_phase.h"

namespace buoyancy {
namespace {

// Returns the spectrum at x = w / wp, without its factor C.
double shape(double x, double log_gamma) {
  const double squared = 1.0 / (x * x);
  double exponent = -1.25 * squared * squared;
  if (log_gamma != 0.0) {
    const double distance = (x - 1.0) / (x < 1.0 ? 0.07 : 0.09);
    exponent += log_gamma * portable::exp(-0.5 * distance * distance);
  }
  return portable::exp(exponent) * squared * squared / x;
}

// Below the first boundary the spectrum has 1e-20 of its energy. Between two boundaries it varies by little,
// and sigma changes at one of them.
std::vector<double> frequency_boundaries(double cutoff) {
  constexpr double kFirst = 0.4;
  constexpr double kWidth = 0.02;
  const int below_peak = static_cast<int>((1.0 - kFirst) / kWidth);
  std::vector<double> boundaries;
  boundaries.reserve(static_cast<std::size_t>(below_peak));
  for (int i = 0; i < below_peak; ++i) boundaries.push_back(kFirst + (1.0 - kFirst) / below_peak * i);
  for (double x = 1.0; x < cutoff; x *= 1.0 + kWidth) boundaries.push_back(x);
  boundaries.push_back(cutoff);
  return boundaries;
}

EqualEnergyBins frequency_bins(double log_gamma, double cutoff) {
  return {[log_gamma](double x) { return shape(x, log_gamma); }, frequency_boundaries(cutoff),
          EqualEnergyBins::Mean::kRootMeanSquare};
}

std::int32_t directions_of(const IrregularWaves& waves) {
  return waves.spreading ? waves.directions : 1;
}

double variance_of(double significant_wave_height) {
  return significant_wave_height * significant_wave_height / 16.0;
}

}  // namespace

double default_gamma(double significant_wave_height, double peak_period) {
  const double ratio = peak_period / std::sqrt(significant_wave_height);
  if (ratio <= 3.6) return 5.0;
  if (ratio > 5.0) return 1.0;
  return portable::exp(5.75 - 1.15 * ratio);
}

double gamma_of(const IrregularWaves& waves) {
  return waves.gamma ? *waves.gamma : default_gamma(waves.significant_wave_height, waves.peak_period);
}

std::int32_t frequencies_of(const IrregularWaves& waves) {
  const std::int32_t directions = directions_of(waves);
  return waves.frequencies.value_or((kDefaultComponents + directions - 1) / directions);
}

WaveSpectrum::WaveSpectrum(const IrregularWaves& waves)
    : peak_(2.0 * std::numbers::pi / waves.peak_period),
      cutoff_(waves.cutoff),
      log_gamma_(portable::log(gamma_of(waves))),
      bins_(frequency_bins(log_gamma_, cutoff_)),
      variance_(variance_of(waves.significant_wave_height)) {}

double WaveSpectrum::density(double angular_frequency) const {
  const double x = angular_frequency / peak_;
  return x <= cutoff_ ? variance_ / (bins_.energy() * peak_) * shape(x, log_gamma_) : 0.0;
}

std::vector<double> WaveSpectrum::bin_frequencies(std::size_t bins) const {
  std::vector<double> frequencies = bins_.means(bins);
  for (double& frequency : frequencies) frequency *= peak_;
  return frequencies;
}

std::vector<double> spreading_angles(double spreading, std::size_t bins) {
  if (bins == 1) return {0.0};
  // Beyond `widest` the density is below 1e-18 of that in the middle, since cos(x) <= exp(-x^2 / 2).
  constexpr double kLogarithm = 41.5;  // of 1e18
  const double widest = std::min(180.0, 2.0 * std::sqrt(kLogarithm / spreading) * (180.0 / std::numbers::pi));
  const auto density = [spreading](double angle) {
    const double cosine = portable::sin_cos_of_degrees(0.5 * angle).cos;
    return cosine > 0.0 ? portable::exp(2.0 * spreading * portable::log(cosine)) : 0.0;
  };
  constexpr int kPanels = 48;
  std::vector<double> boundaries;
  for (int i = 0; i <= kPanels; ++i) boundaries.push_back(widest * (2.0 * i / kPanels - 1.0));
  const std::vector<double> means =
      EqualEnergyBins(density, boundaries, EqualEnergyBins::Mean::kArithmetic).means(bins);
  std::vector<double> angles;
  for (std::size_t i = 0; i < bins; ++i) angles.push_back(0.5 * (means[i] - means[bins - 1 - i]));
  return angles;
}

WaveComponents components_of(const WaveSystem& system, std::size_t place) {
  if (const auto* components = std::get_if<WaveComponents>(&system)) return *components;
  if (const auto* regular = std::get_if<RegularWave>(&system)) {
    return {{0.5 * regular->height, 2.0 * std::numbers::pi / regular->period, regular->direction,
             regular->phase}};
  }
  const auto& waves = std::get<IrregularWaves>(system);
  const auto frequencies = static_cast<std::size_t>(frequencies_of(waves));
  const auto directions = static_cast<std::size_t>(directions_of(waves));
  const std::vector<double> angles = spreading_angles(waves.spreading.value_or(1.0), directions);
  const double amplitude = std::sqrt(2.0 * variance_of(waves.significant_wave_height) /
                                     static_cast<double>(frequencies * directions));
  const std::vector<double> bins = WaveSpectrum(waves).bin_frequencies(frequencies * directions);
  const auto key = static_cast<std::uint32_t>(place);
  WaveComponents components;
  components.reserve(bins.size());
  while (components.size() < bins.size()) {
    const auto group = static_cast<std::uint32_t>(components.size() / directions);
    for (const std::size_t direction : random_order(waves.seed, key, group, directions)) {
      const std::size_t i = components.size();
      components.push_back({amplitude, bins[i], waves.direction + angles[direction],
                            random_phase(waves.seed, key, static_cast<std::uint32_t>(i))});
    }
  }
  return components;
}

std::size_t number_of_components(const WaveSystem& system) {
  if (const auto* components = std::get_if<WaveComponents>(&system)) return components->size();
  const auto* waves = std::get_if<IrregularWaves>(&system);
  if (waves == nullptr) return 1;
  return static_cast<std::size_t>(frequencies_of(*waves)) * static_cast<std::size_t>(directions_of(*waves));
}

}  // namespace buoyancy
