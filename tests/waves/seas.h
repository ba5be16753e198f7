// Seas of which several tests have one.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "waves/sea_description.h"

namespace buoyancy {

inline SeaDescription sea_of(std::vector<WaveSystem> systems, WavePressure pressure = WavePressure::kWheeler,
                             double depth = std::numeric_limits<double>::infinity()) {
  return {.depth = depth, .pressure = pressure, .systems = std::move(systems)};
}

// Of five directions.
inline IrregularWaves wind_sea(double height, double period) {
  return {.significant_wave_height = height,
          .peak_period = period,
          .gamma = {},
          .spreading = 10.0,
          .frequencies = {},
          .directions = 5};
}

}  // namespace buoyancy
