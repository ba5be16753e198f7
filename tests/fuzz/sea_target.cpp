// Fuzz target: bytes as a sea_state_t from the network. A decoded message must encode to the same bytes. It
// is a sea, or an error that names the field on one line; a sea has finite elevations that are no higher than
// its amplitudes allow, and is the same after it has been sent and received again.
//
//   options   1 byte: bit 0 the fingerprint overwrites the packet's first bytes, bit 1 the number of
//             components that matches the length is written to the packet, bit 2 axes and gravity are those
//             of the scene, bit 3 the scene's up is slanted, bit 4 numbers of components are made usual ones
//   place     3 doubles: two coordinates, and a lead time; then an int64, the utime; not finite: 0
//   packet    all bytes that remain
#include <cmath>
#include <string>

#include "messages/conversions.h"
#include "messages/sea_state.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_packets.h"
#include "tests/support/byte_vector.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

// With more components nothing new is found, and a run takes milliseconds.
constexpr std::size_t kMaxComponents = 64;

struct Place {
  double x1 = 0.0, x2 = 0.0, lead_time = 0.0;
  std::int64_t utime = 0;
};

double finite_double(FuzzBytes& bytes) {
  const double value = bytes.raw_double();
  return std::isfinite(value) ? value : 0.0;
}

Place next_place(FuzzBytes& bytes) {
  Place place;
  place.x1 = finite_double(bytes);
  place.x2 = finite_double(bytes);
  place.lead_time = finite_double(bytes);
  for (int i = 0; i < 8; ++i)
    place.utime = static_cast<std::int64_t>((static_cast<std::uint64_t>(place.utime) << 8U) | bytes.byte());
  return place;
}

void use_medium(const Water& water, const Vec3& current_W, SeaState& state) {
  const HorizontalAxes axes = horizontal_axes(water.up_W);
  state.e1 = to_array(axes.e1_W);
  state.e2 = to_array(axes.e2_W);
  state.up = to_array(water.up_W);
  state.gravity = water.gravity;
  state.current = to_array(current_W);
}

void use_usual_numbers(SeaState& state) {
  state.depth = std::isfinite(state.depth) ? folded(state.depth, 1.0, 1e4) : state.depth;
  state.level = folded(state.level, -1e3, 1e3);
  state.ramp = folded(state.ramp, 0.0, 1e3);
  state.wave_pressure &= 1;
  for (double& value : state.amplitude) value = folded(value, 0.0, 0.9);
  for (double& value : state.angular_frequency) value = folded(value, 0.1, 10.0);
  for (double& value : state.direction) value = folded(value, -7.0, 7.0);
  for (double& value : state.phase) value = folded(value, -7.0, 7.0);
}

void check_error(const Error& error) {
  const std::string message = error.message();
  require(message.starts_with("the received sea: "), "an error says what it is about");
  require(!error.actual.empty() && !error.expected.empty(), "an error states actual and expected");
  require(message.find('\n') == std::string::npos, "an error is one line");
}

double elevation_at(const Sea& sea, const Place& place) {
  SeaSnapshot snapshot(sea);
  snapshot.set_time(place.utime, place.lead_time);
  return snapshot.elevation(place.x1, place.x2);
}

void check_sea(const Sea& sea, const Place& place, bool is_usual) {
  // Beyond this the phases are still defined by the formula, but no longer resolved by doubles.
  constexpr double kFar = 1e7;
  const double t = 1e-6 * (static_cast<double>(place.utime) - static_cast<double>(sea.time_origin()));
  const bool is_near = std::abs(place.x1) <= kFar && std::abs(place.x2) <= kFar &&
                       std::abs(place.lead_time) <= kFar && sea.current_W().norm() * std::abs(t) <= kFar;
  if (!is_near) return;
  const double eta = elevation_at(sea, place);
  require(std::abs(eta) <= sea.max_elevation() * (1.0 + 1e-12),
          "no crest is higher than the sum of the amplitudes");
  const SeaState sent = to_sea_state(sea, 1);
  const Expected<Sea> again = to_sea(sent, sea.water(), sea.current_W());
  require(again.has_value(), "a sea that is sent again is accepted");
  require(again->components().size() == sea.components().size(), "a sea keeps its components");
  if (!is_usual) return;
  // The rounding of directions is at most 1e-15 and is multiplied by k |X - U t|, at most 11 times 3e7.
  require(std::abs(elevation_at(*again, place) - eta) <= 1e-6 * (1.0 + sea.max_elevation()),
          "a sea that is sent again has the same elevations");
}

void check(FuzzBytes bytes) {
  const unsigned options = bytes.byte();
  const Place place = next_place(bytes);
  const Bytes rest = bytes.take(sea_state_size(kMaxComponents));
  ByteVector packet = copy_of(rest);
  if ((options & 1U) != 0) write_fingerprint(encoded(SeaState{}), packet);
  if ((options & 2U) != 0) write_count(sea_state_size(0), sea_state_size(1) - sea_state_size(0), packet);
  SeaState state;
  if (decode(packet, state)) {
    require(state == SeaState{}, "a message that does not decode changes nothing");
    return;
  }
  ByteVector again;
  encode(state, again);
  require(again == packet, "a decoded message encodes to the same bytes");

  Water water;
  if ((options & 8U) != 0) water.up_W = Vec3(0.95, -0.1, 0.2).normalized();
  const Vec3 current_W = (options & 32U) != 0 ? Vec3(1.5, -0.5, 0.2) : Vec3(Vec3::Zero());
  if ((options & 4U) != 0) use_medium(water, current_W, state);
  const bool is_usual = (options & 16U) != 0;
  if (is_usual) use_usual_numbers(state);
  const Expected<Sea> sea = to_sea(state, water, current_W);
  if (!sea) {
    check_error(sea.error());
    return;
  }
  check_sea(*sea, place, is_usual);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
