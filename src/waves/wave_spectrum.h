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

// The peak enhancement that DNV-RP-C205 and IEC 61400-3 give for a sea of this height [m] and peak period
// [s]: 5 for steep seas, 1 for flat ones.
double default_gamma(double significant_wave_height, double peak_period);

// The gamma that is used: the given one or default_gamma().
double gamma_of(const IrregularWaves& waves);

// The number of frequencies of each direction that is used: the given one, or as many as make
// kDefaultComponents or a few more.
std::int32_t frequencies_of(const IrregularWaves& waves);
inline constexpr std::int32_t kDefaultComponents = 200;

// A spectrum without its directions. C is such that the energy below the cutoff is that of the significant
// wave height; there is none above. The same bits on every machine. Complexity: some milliseconds, and 0.2 ms
// per bin.
class WaveSpectrum {
 public:
  explicit WaveSpectrum(const IrregularWaves& waves);

  double density(double angular_frequency) const;  // [m^2 s]; angular_frequency: [rad/s], > 0
  // [rad/s], ascending: the root mean squares of `bins` bins of equal energy, weighted with the energy, so
  // that m_0 and m_2, and with them the zero-crossing period, are those of the spectrum up to the cutoff.
  std::vector<double> bin_frequencies(std::size_t bins) const;

 private:
  double peak_;    // [rad/s]
  double cutoff_;  // over the peak
  double log_gamma_;
  EqualEnergyBins bins_;  // of the spectrum without C, over w / wp
  double variance_;       // [m^2]
};

// [deg], ascending and symmetric about 0: the mean angles of `bins` bins of equal energy. spreading: s > 0.
std::vector<double> spreading_angles(double spreading, std::size_t bins);

// The components of a wave system. Irregular waves have frequencies x directions components of equal
// amplitude, whose energy is exactly that of the significant wave height, and of ascending frequency: each
// has a bin of its own, so that the sea is homogeneous in time and space (waves of one frequency and several
// directions would stand still as a pattern). In each group of `directions` consecutive bins, every direction
// occurs once, in an order drawn at random. place: of the system in the sea, from 0, a part of the key of
// phases and orders.
WaveComponents components_of(const WaveSystem& system, std::size_t place);

// How many components_of() returns. O(1).
std::size_t number_of_components(const WaveSystem& system);

}  // namespace buoyancy
