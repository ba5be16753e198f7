// A sea as a message: its core type, its encoding as sea_state_t, and its conversion from and to a Sea.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/water.h"
#include "messages/wire.h"
#include "waves/sea.h"

namespace buoyancy {

// The fields are those of sea_state_t.lcm, which documents them. Angles are in radians, as on the wire; those
// of a Sea are in degrees.
struct SeaState {
  std::int64_t utime = 0;  // [us]
  std::int64_t instance_id = 0;
  std::array<double, 3> e1{};                              // W frame
  std::array<double, 3> e2{};                              // W frame
  std::array<double, 3> up{};                              // W frame
  double level = 0.0;                                      // [m]
  double depth = std::numeric_limits<double>::infinity();  // [m]
  double gravity = 0.0;                                    // [m/s^2]
  std::int64_t time_origin = 0;                            // [us]
  double ramp = 0.0;                                       // [s]
  std::array<double, 3> current{};                         // [m/s], W frame
  std::int32_t wave_pressure = 0;                          // a constant of sea_state_t.lcm
  // One entry per component.
  std::vector<double> amplitude;          // [m]
  std::vector<double> angular_frequency;  // [rad/s]
  std::vector<double> direction;          // [rad]
  std::vector<double> phase;              // [rad]

  bool operator==(const SeaState&) const = default;
};

// Size [bytes] of an encoded sea with this number of components.
std::size_t sea_state_size(std::size_t components);

// Replaces bytes by the encoded sea: no heap allocation once its capacity suffices for the largest one.
// Precondition: the arrays have the same length, at most kMaxWaveComponents.
void encode(const SeaState& state, std::vector<std::uint8_t>& bytes);
// Makes the checks of wire.h's decode(). DecodeError::kCount: a number of components that is negative or
// above kMaxWaveComponents. On an error, state is unchanged; its arrays are reused. Values are not validated.
std::optional<DecodeError> decode(Bytes bytes, SeaState& state);

// Makes the same checks and returns the utime only. O(1).
tl::expected<std::int64_t, DecodeError> peek_sea_utime(Bytes bytes);

// Returns the message of a scene's sea, which always holds: its utime is 0.
SeaState to_sea_state(const Sea& sea, std::int64_t instance_id);

// water, current_W [m/s]: of the scene. Its density, up and gravity are used; the level is the message's, and
// so is the current that carries the waves, so that they are where the sender sees them. The Sea is the one
// that the message was made from, to rounding. Errors name the field at fault: not finite, out of its range,
// axes, gravity or current other than those of the scene, an unknown wave_pressure, and those of Sea::make().
Expected<Sea> to_sea(const SeaState& state, const Water& water, const Vec3& current_W);

}  // namespace buoyancy
