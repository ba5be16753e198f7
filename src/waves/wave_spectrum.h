// Wave spectra and their discretisation into components.
//
// The spectrum is that of the JONSWAP experiment,
//   S(w) = C w^-5 exp(-5/4 (wp/w)^4) gamma^exp(-((w - wp) / (sigma wp))^2 / 2),
// with sigma = 0.07 below the peak wp and 0.09 above; with gamma = 1 it is that of Pierson and Moskowitz. The
// directional spreading is proportional to cos^2s(angle / 2).
// Sources: K. Hasselmann et al., "Measurements of wind-wave growth and swell decay during the Joint North Sea
// Wave Project", 1973; DNV-RP-C205, "Environmental conditions and environmental loads".
#pragma once

#include <cstddef>
#include <vector>

#include "waves/equal_energy_bins.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Returns the peak enhancement that DNV-RP-C205 and IEC 61400-3 give for a sea of this height [m] and peak
// period [s]: 5 for steep seas, 1 for flat ones.
double default_gamma(double significant_wave_height, double peak_period);

// Returns the gamma in use: the given one or default_gamma().
double gamma_of(const IrregularWaves& waves);

// Returns the number of frequencies of each direction: the given one, or as many as make kDefaultComponents
// or a few more.
std::int32_t frequencies_of(const IrregularWaves& waves);
inline constexpr std::int32_t kDefaultComponents = 200;

// A frequency spectrum. C is such that the energy below the cutoff is that of the significant wave height;
// there is none above. It has the same bits on every machine. Complexity: some milliseconds, and 0.2 ms per
// bin.
class WaveSpectrum {
 public:
  explicit WaveSpectrum(const IrregularWaves& waves);

  double density(double angular_frequency) const;  // [m^2 s]; angular_frequency: [rad/s], > 0
  // Returns the energy-weighted root mean squares of `bins` bins of equal energy [rad/s], ascending, which
  // keep m_0, m_2 and with them the zero-crossing period of the spectrum up to the cutoff.
  std::vector<double> bin_frequencies(std::size_t bins) const;

 private:
  double peak_;    // [rad/s]
  double cutoff_;  // over the peak
  double log_gamma_;
  EqualEnergyBins bins_;  // of the spectrum without C, over w / wp
  double variance_;       // [m^2]
};

// Returns the mean angles [deg] of `bins` bins of equal energy, ascending and symmetric. spreading: s > 0.
std::vector<double> spreading_angles(double spreading, std::size_t bins);

// Returns the components of a wave system. Irregular waves have frequencies x directions components of equal
// amplitude, whose energy is exactly that of the significant wave height, in ascending frequency: each has a
// bin of its own, so that the sea is homogeneous in time and space (waves of one frequency and several
// directions would make a standing pattern). In each group of `directions` consecutive bins, every direction
// occurs once, in a random order. place: the system's index in the sea, part of the random key.
WaveComponents components_of(const WaveSystem& system, std::size_t place);

// Returns the number of components that components_of() returns. Complexity: O(1).
std::size_t number_of_components(const WaveSystem& system);

}  // namespace buoyancy
