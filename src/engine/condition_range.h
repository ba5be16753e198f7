// The range of what a sender may say about a compartment or a tank.
#pragma once

#include <algorithm>
#include <optional>

#include "base/number_range.h"
#include "scene/subdivision.h"

namespace buoyancy {

// [-], the share of a compartment that is open to the sea.
inline constexpr NumberRange kFloodedRange = NumberRange::from_zero_to(1.0);

// Returns the volume of liquid in a tank [m^3]; nullopt if it is out of range. A volume above that of the
// tank by rounding alone counts as the tank's.
inline std::optional<double> usable_liquid_volume(const BodyTank& tank, double volume) {
  constexpr double kRounding = 1e-9;  // relative, of a tank's volume as senders compute it
  const double capacity = tank.capacity();
  if (!NumberRange::from_zero_to(capacity * (1.0 + kRounding)).contains(volume)) return std::nullopt;
  return std::min(volume, capacity);
}

}  // namespace buoyancy
