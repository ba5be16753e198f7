// A change of a compartment or tank as a message: its core type, and its encoding as body_condition_t.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

// The values equal the constants of body_condition_t.lcm; a received message may have any other.
enum class ConditionKind : std::int32_t { kCompartment = 0, kTank = 1 };

// The fields are those of body_condition_t.lcm, which documents them.
struct ConditionChange {
  std::int64_t utime = 0;  // [us]
  std::int32_t body_id = 0;
  ConditionKind kind = ConditionKind::kCompartment;
  std::int32_t index = 0;
  double flooded = 0.0;
  double liquid_volume = 0.0;  // [m^3]

  bool operator==(const ConditionChange&) const = default;
};

// Replaces bytes by the encoded change.
void encode(const ConditionChange& change, std::vector<std::uint8_t>& bytes);
// Makes the checks of wire.h's decode(). On an error, change is unchanged. Values are not validated.
std::optional<DecodeError> decode(Bytes bytes, ConditionChange& change);

}  // namespace buoyancy
