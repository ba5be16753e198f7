// The surface of a sea on a grid as a message: its core type, and its encoding as sea_grid_t.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "waves/elevation_spline.h"

namespace buoyancy {

// The fields are those of sea_grid_t.lcm, which documents them.
struct SeaGridHeader {
  std::int64_t utime = 0;  // [us]
  std::int64_t instance_id = 0;
  std::array<double, 2> origin{};   // [m]
  std::array<double, 2> spacing{};  // [m]
  double level = 0.0;               // [m]
  std::int32_t periodic = 0;        // 0 or 1
  std::int32_t rows = 0;
  std::int32_t columns = 0;

  bool operator==(const SeaGridHeader&) const = default;
};

// Size [bytes] of an encoded grid.
std::size_t sea_grid_size(std::size_t rows, std::size_t columns);

// Replaces bytes by the encoded grid: no heap allocation once its capacity suffices for the largest one.
// elevations: [m], row after row. Precondition: there are rows * columns.
void encode(const SeaGridHeader& header, std::span<const float> elevations, std::vector<std::uint8_t>& bytes);

// Makes the checks of wire.h's decode(), and decodes all but the elevations. DecodeError::kCount: rows or
// columns are not from kMinGridSide to kMaxGridSide. Values are not validated. O(1).
tl::expected<SeaGridHeader, DecodeError> peek_sea_grid(Bytes bytes);

// Sets the surface to that of a message, without a copy of its elevations in between. Errors: bytes that are
// no such message, and a field that is not finite or out of range; then the surface is unchanged. For heap
// allocation and complexity see ElevationSpline::set().
Expected<void> set_surface(Bytes message, ElevationSpline& surface);

}  // namespace buoyancy
