// Fuzz target: bytes as messages of the type sea_grid_t from the network. What decodes encodes to the same
// bytes. It is a surface, or an error that names the field on one line and changes nothing; a surface has
// finite elevations that are within its bounds. Two of them are a sea between their times.
//
//   options   1 byte: bit 0 the fingerprint overwrites the packets' first bytes, bit 1 rows and columns that
//             match the length are written to them, bit 2 all but rows, columns and elevations are made usual
//   place     3 doubles: two shares of the grid, and a time in seconds; not finite: 0
//   packets   2 bytes: the size of the first; then both
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "engine/sea_timeline.h"
#include "messages/sea_grid.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_packets.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

// With more samples nothing new is found.
constexpr std::size_t kMaxSide = 12;

struct Place {
  double share_1 = 0.0, share_2 = 0.0, time = 0.0;
};

double finite_double(FuzzBytes& bytes) {
  const double value = bytes.raw_double();
  return std::isfinite(value) ? value : 0.0;
}

ByteVector valid_grid() {
  ByteVector bytes;
  encode({.spacing = {1.0, 1.0}, .rows = 4, .columns = 4}, std::vector<float>(16), bytes);
  return bytes;
}

// Writes the numbers of rows and columns of the largest grid that fits, and truncates the packet after it.
void write_sides(ByteVector& packet) {
  const std::size_t fixed = sea_grid_size(0, 0);
  if (packet.size() < sea_grid_size(4, 4)) return;
  std::size_t columns = 4;
  const auto rows_of = [&] { return (packet.size() - fixed) / sizeof(float) / columns; };
  while (columns < kMaxSide && rows_of() > columns) ++columns;
  const std::size_t rows = std::min(rows_of(), kMaxSide);
  if (rows < 4) return;
  for (std::size_t i = 1; i < 8; ++i) packet[fixed - 1 - i] = 0;
  packet[fixed - 1] = static_cast<std::uint8_t>(columns);
  packet[fixed - 5] = static_cast<std::uint8_t>(rows);
  packet.resize(sea_grid_size(rows, columns));
}

std::vector<float> elevations_of(const SeaGridHeader& header, Bytes packet) {
  std::vector<float> elevations;
  const auto count = static_cast<std::size_t>(header.rows) * static_cast<std::size_t>(header.columns);
  const Bytes samples = packet.last(count * sizeof(float));
  for (std::size_t i = 0; i < count; ++i) {
    BigEndianFloat sample;
    std::copy_n(samples.begin() + static_cast<std::ptrdiff_t>(4 * i), 4, sample.bytes.begin());
    const std::uint32_t bits = (std::uint32_t{sample.bytes[0]} << 24U) |
                               (std::uint32_t{sample.bytes[1]} << 16U) |
                               (std::uint32_t{sample.bytes[2]} << 8U) | std::uint32_t{sample.bytes[3]};
    elevations.push_back(std::bit_cast<float>(bits));
  }
  return elevations;
}

void use_usual_numbers(ByteVector& packet) {
  const auto decoded = peek_sea_grid(packet);
  if (!decoded) return;
  SeaGridHeader header = *decoded;
  for (std::size_t n = 0; n < 2; ++n) {
    header.origin[n] = folded(header.origin[n], -1e3, 1e3);
    header.spacing[n] = folded(header.spacing[n], 0.1, 100.0);
  }
  header.level = folded(header.level, -1e3, 1e3);
  header.periodic &= 1;
  std::vector<float> elevations = elevations_of(header, packet);
  for (float& elevation : elevations) {
    elevation = static_cast<float>(folded(static_cast<double>(elevation), -10.0, 10.0));
  }
  encode(header, elevations, packet);
}

void check_error(const Error& error) {
  const std::string message = error.message();
  require(message.starts_with("the received grid of the sea: "), "an error says what it is about");
  require(!error.actual.empty() && !error.expected.empty(), "an error states actual and expected");
  require(message.find('\n') == std::string::npos, "an error is one line");
}

void check_surface(const ElevationSpline& surface, const Place& place) {
  const auto within = [](const ElevationSpline::Axis& axis, double share) {
    return axis.origin + axis.spacing * axis.cells * folded(share, 0.0, 1.0);
  };
  const double x1 = within(surface.axis(0), place.share_1);
  const double x2 = within(surface.axis(1), place.share_2);
  const double eta = surface.at(x1, x2).eta;
  const ElevationBounds bounds = surface.bounds();
  const double rounding = surface.rounding(kMaxGridElevation, 0.0) + 1e-9;
  require(
      eta >= static_cast<double>(bounds.low) - rounding && eta <= static_cast<double>(bounds.high) + rounding,
      "an elevation is within the bounds");
}

void check(FuzzBytes bytes) {
  static const Scene scene =
      scene_of("[water]\nwaves = \"grid\"\n[[body]]\nid = 1\nshape = { type = \"box\" }\n");
  const unsigned options = bytes.byte();
  Place place;
  place.share_1 = finite_double(bytes);
  place.share_2 = finite_double(bytes);
  place.time = finite_double(bytes);
  const std::size_t max_size = sea_grid_size(kMaxSide, kMaxSide);
  const std::size_t first_size = bytes.word() % (max_size + 1);
  std::array<ByteVector, 2> packets{copy_of(bytes.take(first_size)), copy_of(bytes.take(max_size))};
  SeaTimeline timeline(scene);
  std::size_t received = 0;
  for (ByteVector& packet : packets) {
    if ((options & 1U) != 0) write_fingerprint(valid_grid(), packet);
    if ((options & 2U) != 0) write_sides(packet);
    if ((options & 4U) != 0) use_usual_numbers(packet);
    ElevationSpline surface;
    require(set_surface(valid_grid(), surface).has_value(), "a plane is a surface");
    const Expected<void> set = set_surface(packet, surface);
    require(set.has_value() == timeline.receive(packet, scene).has_value(), "what is a surface is received");
    if (!set) {
      check_error(set.error());
      require(surface.at(1.5, 1.5).eta == 0.0, "a grid that cannot be used changes nothing");
      continue;
    }
    ++received;
    const SeaGridHeader header = peek_sea_grid(packet).value();
    ByteVector again;
    encode(header, elevations_of(header, packet), again);
    require(again == packet, "a decoded grid encodes to the same bytes");
    check_surface(surface, place);
    const std::shared_ptr<const SeaPeriod>* const period = timeline.at(header.utime);
    require(period != nullptr, "a grid holds at its time");
    const SeaAtTime now(*(*period)->sea, header.utime);
    require(now.surface().count == 1 && now.surface().parts[0].share == 1.0,
            "a grid alone is the surface then");
  }
  const std::shared_ptr<const SeaPeriod>* const period = timeline.at(0, place.time);
  if (period == nullptr) return;
  const SeaAtTime now(*(*period)->sea, 0, place.time);
  double share = 0.0;
  for (std::size_t n = 0; n < now.surface().count; ++n) share += now.surface().parts[n].share;
  require(received > 0 && std::abs(share - 1.0) < 1e-12, "shares add up to 1");
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
