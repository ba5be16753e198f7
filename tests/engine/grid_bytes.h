// Messages of surfaces on grids.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "messages/sea_grid.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

inline constexpr SeaGridHeader kGridAroundOrigin{
    .instance_id = 5, .origin = {-8.0, -7.5}, .spacing = {0.5, 0.5}, .rows = 32, .columns = 33};

// The samples of a function of X1 and X2 on the grid of the header.
inline ByteVector grid_bytes(const SeaGridHeader& header,
                             const std::function<double(double, double)>& elevation) {
  std::vector<float> elevations;
  for (std::int32_t j = 0; j < header.rows; ++j) {
    for (std::int32_t i = 0; i < header.columns; ++i) {
      elevations.push_back(static_cast<float>(
          elevation(header.origin[0] + i * header.spacing[0], header.origin[1] + j * header.spacing[1])));
    }
  }
  ByteVector bytes;
  encode(header, elevations, bytes);
  return bytes;
}

}  // namespace buoyancy
