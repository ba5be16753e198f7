// What a user says about the sea: its wave systems, its depth, and how pressure follows from them.
// Sea::make() (sea.h) makes a Sea of it.
//
// Directions and phases are in degrees, as in the scene file and in the tools of the field; everything else
// is in SI units. A direction is the one TOWARDS which waves run, anticlockwise seen from above, from the
// first horizontal axis (HorizontalAxes in sea.h). A component's elevation over the water's level is
//   amplitude cos(k d . X - angular_frequency t + phase),
// where X is the horizontal position from the world's origin and d the unit vector of the direction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "base/vec3.h"

namespace buoyancy {

inline constexpr std::size_t kMaxWaveComponents = 4096;  // of a sea, all systems together

struct WaveComponent {
  double amplitude = 0.0;          // [m], >= 0
  double angular_frequency = 1.0;  // [rad/s], > 0
  double direction = 0.0;          // [deg]
  double phase = 0.0;              // [deg], at X = 0 and t = 0
};

struct RegularWave {
  double height = 0.0;     // [m], from crest to trough; >= 0
  double period = 1.0;     // [s], > 0
  double direction = 0.0;  // [deg]
  double phase = 0.0;      // [deg]
};

// An irregular wave system: the JONSWAP spectrum, which is that of Pierson and Moskowitz where gamma is 1.
struct IrregularWaves {
  double significant_wave_height = 0.0;  // [m], >= 0
  double peak_period = 1.0;              // [s], > 0
  std::optional<double> gamma;           // peak enhancement, 1 to 10; default: default_gamma()
  double direction = 0.0;                // [deg], the mean
  // s of the directional spreading cos^2s(angle / 2), > 0; by default the waves are long-crested.
  std::optional<double> spreading;
  std::optional<std::int32_t> frequencies;  // of each direction; default: frequencies_of()
  std::int32_t directions = 1;              // number of bins of equal energy; 1 without a spreading
  double cutoff = 3.0;                      // highest angular frequency over that of the peak, 1.1 to 20
  std::uint64_t seed = 1;                   // of the phases and of the order of directions
};

using WaveComponents = std::vector<WaveComponent>;
using WaveSystem = std::variant<RegularWave, IrregularWaves, WaveComponents>;

// How pressure follows from the elevation eta at depth s < 0 below the instantaneous surface.
enum class WavePressure {
  kHydrostatic,  // p = -rho g s
  kWheeler,      // linear wave theory, stretched to the instantaneous surface
};

// Returns the value of the scene file's key.
constexpr std::string_view to_string(WavePressure pressure) {
  return pressure == WavePressure::kWheeler ? "wheeler" : "hydrostatic";
}

struct SeaDescription {
  double depth = std::numeric_limits<double>::infinity();  // [m], of the water at rest
  WavePressure pressure = WavePressure::kWheeler;
  std::int64_t time_origin = 0;  // [us], the utime of t = 0
  double ramp = 0.0;             // [s], see Sea::amplitude_factor()
  // [m/s]. Its horizontal part carries the waves; an observer drifting with it sees the given frequencies.
  Vec3 current_W = Vec3::Zero();
  std::vector<WaveSystem> systems;
};

// The messages in which a scene says that its sea comes.
enum class SeaMessages : std::uint8_t { kNone, kComponents, kGrids };
// As the scene file says it, such as `waves = "grid"`. Precondition: not kNone.
inline constexpr const char* to_string(SeaMessages messages) {
  return messages == SeaMessages::kGrids ? "waves = \"grid\"" : "waves = \"received\"";
}

}  // namespace buoyancy
