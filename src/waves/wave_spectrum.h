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

// A spectrum without its directions. C is such that the energy below the cutoff is that of the significant
// wave height; there is none above. The same bits on every machine. Complexity: some milliseconds.
class WaveSpectrum {
 public:
  explicit WaveSpectrum(const IrregularWaves& waves);

  double density(double angular_frequency) const;  // [m^2 s]; angular_frequency: [rad/s], > 0
  // [rad/s], the energy-weighted means of `bins` bins of equal energy, ascending.
  std::vector<double> mean_frequencies(std::size_t bins) const;

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
// amplitude, whose energy is exactly that of the significant wave height; each has the mean frequency and the
// mean direction of its bin. place: of the system in the sea, from 0, a part of the key of the phases.
WaveComponents components_of(const WaveSystem& system, std::size_t place);

// How many components_of() returns. O(1).
std::size_t number_of_components(const WaveSystem& system);

}  // namespace buoyancy
