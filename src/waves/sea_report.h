// What buoyancyd --check reports about the wave systems of a sea.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "waves/sea.h"

namespace buoyancy {

// The wave that stands for a system: of a regular wave the wave itself, of a spectrum its peak, and of
// components the calculated peak period 2 pi m_-2 m_1 / m_0^2, from the moments m_n = sum a^2 w^n / 2, since
// their energy need not have a peak.
struct PeakWave {
  double period = 0.0;      // [s]
  double wavelength = 0.0;  // [m], in the water's depth
  // WaveSystemReport::height over the wavelength; of irregular waves the significant steepness.
  double steepness = 0.0;
};

struct WaveSystemReport {
  std::string_view type;                 // "regular", "jonswap", "pierson_moskowitz", "components"
  std::size_t components = 0;            // number of them
  double height = 0.0;                   // [m], of a regular wave from crest to trough, else significant
  double significant_wave_height = 0.0;  // [m], of the components: 4 sqrt(sum a^2 / 2)
  std::optional<double> gamma;           // of a spectrum, as used
  bool gamma_is_default = false;
  std::optional<PeakWave> peak;  // nullopt for components without energy
};

// One report per system. sea: made of this description. Complexity: O(components).
std::vector<WaveSystemReport> report_wave_systems(const SeaDescription& description, const Sea& sea);

}  // namespace buoyancy
