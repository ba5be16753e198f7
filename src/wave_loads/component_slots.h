// How the components of a sea are laid out for sums by direction (sea_expansion.h).
//
// kLanesOfStep components lie side by side, which are a step; the steps of a block follow each other. Those
// in one lane of a block have the same direction. Either every lane is a slot, or, in a layout of one block,
// the lanes are rows of one lane for each direction, and a slot is all lanes of its direction. Lanes are
// filled up by components without an amplitude.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace buoyancy {

inline constexpr std::size_t kLanesOfStep = 16;

struct ComponentSlots {
  std::size_t steps = 0;  // of a block; 0: the components are not sorted into slots
  std::size_t blocks = 0;
  std::size_t count = 0;  // of slots
  std::size_t rows = 1;   // of lanes that a slot has; only in one block more than 1
  // By component: (block * steps + step) * kLanesOfStep + lane; without slots its own number.
  std::vector<std::uint32_t> places;

  bool any() const { return steps > 0; }
  std::size_t place_count() const { return any() ? blocks * steps * kLanesOfStep : places.size(); }
  // The slot of a place, and whether the place is the slot's first.
  std::size_t slot_of(std::size_t place) const {
    const std::size_t lane = place / (steps * kLanesOfStep) * kLanesOfStep + place % kLanesOfStep;
    return rows > 1 ? lane % count : lane;
  }
  bool begins_slot(std::size_t place) const {
    return place / kLanesOfStep % steps == 0 && (rows == 1 || place % kLanesOfStep < count);
  }
};

// directions: [deg], of each component. No slots if a component on its own would cost less.
ComponentSlots component_slots(const std::vector<double>& directions);

}  // namespace buoyancy
