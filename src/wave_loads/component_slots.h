// How the components of a sea are laid out for sums by direction (sea_expansion.h).
//
// The components of one direction share a slot, or several of equal length. kSlotsOfBlock slots lie side by
// side in a block; the components that lie side by side are a step. Slots are filled up by components without
// an amplitude.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace buoyancy {

inline constexpr std::size_t kSlotsOfBlock = 8;

struct ComponentSlots {
  std::size_t steps = 0;  // of a block; 0: the components are not sorted into slots
  std::size_t blocks = 0;
  // By component: (block * steps + step) * kSlotsOfBlock + slot in the block; without slots its own number.
  std::vector<std::uint32_t> places;

  bool any() const { return steps > 0; }
  std::size_t place_count() const { return any() ? blocks * steps * kSlotsOfBlock : places.size(); }
  // The slot of a place, counted through all blocks, and whether it is the slot's first.
  std::size_t slot_of(std::size_t place) const {
    return place / (steps * kSlotsOfBlock) * kSlotsOfBlock + place % kSlotsOfBlock;
  }
  bool begins_slot(std::size_t place) const { return place / kSlotsOfBlock % steps == 0; }
};

// directions: [deg], of each component. No slots if a component on its own would cost less.
ComponentSlots component_slots(const std::vector<double>& directions);

}  // namespace buoyancy
