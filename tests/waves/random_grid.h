// Grids of elevations with the samples that they refer to.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <random>
#include <vector>

#include "waves/elevation_spline.h"

namespace buoyancy {

struct SampledGrid {
  std::vector<double> samples;
  ElevationGrid<double> grid;

  SampledGrid() = default;
  SampledGrid(const SampledGrid& other) : samples(other.samples), grid(other.grid) { refer(); }
  SampledGrid& operator=(const SampledGrid&) = delete;

  void refer() { grid.elevations = samples; }
};

// Of a function of X1 and X2.
inline SampledGrid sampled(std::size_t rows, std::size_t columns, std::array<double, 2> origin,
                           std::array<double, 2> spacing, bool periodic,
                           const std::function<double(double, double)>& elevation) {
  SampledGrid result;
  result.grid = {{}, rows, columns, origin, spacing, periodic};
  for (std::size_t j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < columns; ++i) {
      result.samples.push_back(elevation(origin[0] + static_cast<double>(i) * spacing[0],
                                         origin[1] + static_cast<double>(j) * spacing[1]));
    }
  }
  result.refer();
  return result;
}

// Samples without any order: the roughest surface of this height.
inline SampledGrid random_grid(std::mt19937_64& random, bool periodic, double height = 1.0,
                               double spacing = 0.0) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto side = [&] { return std::uniform_int_distribution<std::size_t>(4, 21)(random); };
  const std::array<double, 2> spacings{spacing > 0.0 ? spacing : uniform(0.1, 3.0),
                                       spacing > 0.0 ? spacing * uniform(0.6, 1.7) : uniform(0.1, 3.0)};
  const std::size_t rows = side();
  const std::size_t columns = side();
  return sampled(rows, columns, {uniform(-9.0, 9.0), uniform(-9.0, 9.0)}, spacings, periodic,
                 [&](double, double) { return uniform(-height, height); });
}

}  // namespace buoyancy
