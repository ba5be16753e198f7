#include "wave_loads/component_slots.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace buoyancy {
namespace {

// What a cell of the surface and one below it cost, in vector operations.
constexpr double kCostOfStep = 77.0;
constexpr double kCostOfSlot = 33.0;
constexpr double kCostOfComponent = 21.0;  // without slots

using Groups = std::map<double, std::vector<std::uint32_t>>;  // components by direction

std::size_t quotient_rounded_up(std::size_t a, std::size_t b) {
  return (a + b - 1) / b;
}

std::size_t slots_of(const Groups& groups, std::size_t steps) {
  std::size_t slots = 0;
  for (const auto& [direction, group] : groups) slots += quotient_rounded_up(group.size(), steps);
  return slots;
}

}  // namespace

ComponentSlots component_slots(const std::vector<double>& directions) {
  Groups groups;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    groups[directions[i]].push_back(static_cast<std::uint32_t>(i));
  }
  std::size_t longest = 0;
  for (const auto& [direction, group] : groups) longest = std::max(longest, group.size());
  ComponentSlots best;
  best.places.resize(directions.size());
  std::iota(best.places.begin(), best.places.end(), 0U);
  double least = kCostOfComponent * static_cast<double>(directions.size());
  for (std::size_t steps = 1; steps <= longest; ++steps) {
    const std::size_t slots = slots_of(groups, steps);
    const std::size_t blocks = quotient_rounded_up(slots, kSlotsOfBlock);
    const double cost =
        kCostOfStep * static_cast<double>(blocks * steps) + kCostOfSlot * static_cast<double>(slots);
    if (cost < least) {
      least = cost;
      best.steps = steps;
      best.blocks = blocks;
    }
  }
  if (!best.any()) return best;
  std::size_t slot = 0;
  for (const auto& [direction, group] : groups) {
    for (std::size_t n = 0; n < group.size(); ++n) {
      const std::size_t of_component = slot + n / best.steps;
      const std::size_t step = of_component / kSlotsOfBlock * best.steps + n % best.steps;
      best.places[group[n]] = static_cast<std::uint32_t>(step * kSlotsOfBlock + of_component % kSlotsOfBlock);
    }
    slot += quotient_rounded_up(group.size(), best.steps);
  }
  return best;
}

}  // namespace buoyancy
