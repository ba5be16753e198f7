#include "messages/sea_grid.h"

#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include <buoyancy/sea_grid_t.hpp>

#include "base/format.h"
#include "base/number_range.h"
#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

constexpr const char* kSubject = "the received grid of the sea";

// Size [bytes] of everything before the first elevation: fingerprint and header.
std::size_t fixed_size() {
  const SeaGridHeader header;
  LayoutSize layout;
  layout(std::int64_t{});
  visit_header(header, layout);
  return layout.size();
}

bool is_side(std::int32_t count) {
  return count >= static_cast<std::int32_t>(kMinGridSide) && count <= static_cast<std::int32_t>(kMaxGridSide);
}

Error no_grid(DecodeError error) {
  return {kSubject, to_string(error),
          "the bytes of a sea_grid_t of this version, of 4 to 4096 rows and columns",
          "the sender has another version of the message, or sends another type on this channel", ""};
}

std::optional<Error> error_in(const SeaGridHeader& header) {
  if (!std::isfinite(header.level)) {
    return Error{kSubject, "level = " + format_shortest(header.level), NumberRange::any("m").describe(), "",
                 ""};
  }
  if (header.periodic != 0 && header.periodic != 1) {
    return Error{kSubject, "periodic = " + std::to_string(header.periodic), "0 or 1",
                 "the sender has not set it", ""};
  }
  return std::nullopt;
}

}  // namespace

std::size_t sea_grid_size(std::size_t rows, std::size_t columns) {
  return fixed_size() + rows * columns * sizeof(float);
}

void encode(const SeaGridHeader& header, std::span<const float> elevations,
            std::vector<std::uint8_t>& bytes) {
  assert(elevations.size() ==
         static_cast<std::size_t>(header.rows) * static_cast<std::size_t>(header.columns));
  bytes.resize(fixed_size() + elevations.size_bytes());
  BigEndianWriter writer(bytes.data());
  writer(sea_grid_t::getHash());
  visit_header(header, writer);
  for (const float elevation : elevations) writer(elevation);
}

tl::expected<SeaGridHeader, DecodeError> peek_sea_grid(Bytes bytes) {
  if (bytes.size() < fixed_size()) return tl::unexpected(DecodeError::kTruncated);
  BigEndianReader reader(bytes.data());
  std::int64_t fingerprint = 0;
  reader(fingerprint);
  if (fingerprint != sea_grid_t::getHash()) return tl::unexpected(DecodeError::kFingerprint);
  SeaGridHeader header;
  visit_header(header, reader);
  if (!is_side(header.rows) || !is_side(header.columns)) return tl::unexpected(DecodeError::kCount);
  const std::size_t size =
      sea_grid_size(static_cast<std::size_t>(header.rows), static_cast<std::size_t>(header.columns));
  if (bytes.size() != size) return tl::unexpected(DecodeError::kLength);
  return header;
}

Expected<void> set_surface(Bytes message, ElevationSpline& surface) {
  const tl::expected<SeaGridHeader, DecodeError> header = peek_sea_grid(message);
  if (!header) return make_error(no_grid(header.error()));
  if (std::optional<Error> error = error_in(*header)) return make_error(*std::move(error));
  const auto rows = static_cast<std::size_t>(header->rows);
  const auto columns = static_cast<std::size_t>(header->columns);
  static_assert(sizeof(BigEndianFloat) == sizeof(float) && alignof(BigEndianFloat) == 1);
  const auto* const first = reinterpret_cast<const BigEndianFloat*>(message.data() + fixed_size());
  Expected<void> set = surface.set(ElevationGrid<BigEndianFloat>{
      {first, rows * columns}, rows, columns, header->origin, header->spacing, header->periodic == 1});
  if (!set) set.error().subject = kSubject;
  return set;
}

}  // namespace buoyancy
