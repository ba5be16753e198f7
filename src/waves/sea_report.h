// What buoyancyd --check and the log report about the wave systems of a sea.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "waves/sea.h"

namespace buoyancy {

// The wave that represents a system: a regular wave itself, the peak of a spectrum, and for components, whose
// energy need not have a peak, the calculated peak period 2 pi m_-2 m_1 / m_0^2.
struct PeakWave {
  double period = 0.0;      // [s]
  double wavelength = 0.0;  // [m], in the water's depth
  // WaveSystemReport::height over the wavelength; for irregular waves, the significant steepness.
  double steepness = 0.0;
};

// The height at which waves break, by that criterion which a system is nearest to.
struct Breaking {
  double height = 0.0;         // [m], of the system, or of one of its components
  double limit = 0.0;          // [m]
  std::string_view criterion;  // the limit's formula and source
};

struct WaveSystemReport {
  std::string_view type;                 // "regular", "jonswap", "pierson_moskowitz", "components"
  std::size_t components = 0;            // number of them
  double height = 0.0;                   // [m], of a regular wave from crest to trough, else significant
  double significant_wave_height = 0.0;  // [m], of the components: 4 sqrt(m_0)
  double m0 = 0.0, m1 = 0.0, m2 = 0.0;   // [m^2 (rad/s)^n], the moments m_n = sum a^2 w^n / 2
  std::optional<double> gamma;           // of a spectrum, as used
  bool gamma_is_default = false;
  // Nullopt for components without energy.
  std::optional<PeakWave> peak;
  std::optional<double> zero_crossing_period;  // [s], Tz = 2 pi sqrt(m_0 / m_2)
  std::optional<Breaking> breaking;
};

// Returns one report per system. sea: made from this description. Complexity: O(components).
std::vector<WaveSystemReport> report_wave_systems(const SeaDescription& description, const Sea& sea);
// Reports all components of a sea as one system of components.
WaveSystemReport report_components(const Sea& sea);

// Returns the time [s] after which the record of these waves resembles its beginning, at a point that drifts
// with the current: the first time after its initial decay at which the envelope of the autocorrelation of
// the elevation, |sum a^2 exp(i w t)| / sum a^2, exceeds kRepeatCorrelation. Waves whose envelope never
// decays below it, such as a regular wave, repeat after their mean period 2 pi m_0 / m_1. Infinity: not
// within kRepeatSearch mean periods, or no energy. Complexity: O(components), about 50 us per component.
inline constexpr double kRepeatCorrelation = 1.0 / 3.0;
inline constexpr double kRepeatSearch = 5000.0;
double repeat_time(std::span<const WaveComponent> components);

// Warns about a sea that is higher than waves get before they break, and about one too steep for linear
// theory (Sea::is_too_steep()). systems: reports of the sea's systems, or none for a received sea, which has
// components only. subject: whose sea it is, such as the scene's name.
std::vector<Warning> sea_warnings(const std::string& subject, const Sea& sea,
                                  std::span<const WaveSystemReport> systems);

}  // namespace buoyancy
