#include "wave_loads/component_slots.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace buoyancy {
namespace {

// What a cell of the surface and one below it cost, in vector operations.
constexpr double kCostOfStep = 143.0;
constexpr double kCostOfSlot = 33.0;
constexpr double kCostOfFold = 33.0;       // of half of the rows onto the others
constexpr double kCostOfComponent = 21.0;  // without slots

using Components = std::vector<std::uint32_t>;

std::size_t quotient_rounded_up(std::size_t a, std::size_t b) {
  return (a + b - 1) / b;
}

// The components of each direction.
std::vector<Components> by_direction(const std::vector<double>& directions) {
  std::map<double, Components> of_direction;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    of_direction[directions[i]].push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<Components> groups;
  groups.reserve(of_direction.size());
  for (auto& [direction, group] : of_direction) groups.push_back(std::move(group));
  return groups;
}

// A layout in blocks of `steps` steps, without the places. in_rows: all lanes of a direction are one slot.
ComponentSlots layout(const std::vector<Components>& groups, std::size_t steps, bool in_rows) {
  ComponentSlots slots;
  slots.steps = steps;
  std::size_t lanes = 0;
  for (const Components& group : groups) {
    const std::size_t of_group = quotient_rounded_up(group.size(), steps);
    lanes += of_group;
    if (in_rows) slots.rows = std::max(slots.rows, of_group);
  }
  slots.count = in_rows ? groups.size() : lanes;
  slots.blocks = quotient_rounded_up(slots.rows * slots.count, kLanesOfStep);
  return slots;
}

double cost_of(const ComponentSlots& slots) {
  return kCostOfStep * static_cast<double>(slots.blocks * slots.steps) +
         kCostOfSlot * static_cast<double>(slots.count) +
         kCostOfFold * std::ceil(std::log2(static_cast<double>(slots.rows)));
}

void set_places(const std::vector<Components>& groups, ComponentSlots& slots) {
  std::size_t first_lane = 0;  // of a direction
  for (const Components& group : groups) {
    std::size_t lane = first_lane;
    for (std::size_t n = 0; n < group.size(); ++n) {
      if (n > 0 && n % slots.steps == 0) lane += slots.rows > 1 ? slots.count : 1;
      const std::size_t step = lane / kLanesOfStep * slots.steps + n % slots.steps;
      slots.places[group[n]] = static_cast<std::uint32_t>(step * kLanesOfStep + lane % kLanesOfStep);
    }
    first_lane = slots.rows > 1 ? first_lane + 1 : lane + 1;
  }
}

}  // namespace

ComponentSlots component_slots(const std::vector<double>& directions) {
  const std::vector<Components> groups = by_direction(directions);
  std::size_t longest = 0;
  for (const Components& group : groups) longest = std::max(longest, group.size());
  ComponentSlots best;
  double least = kCostOfComponent * static_cast<double>(directions.size());
  for (std::size_t steps = 1; steps <= longest; ++steps) {
    for (const bool in_rows : {false, true}) {
      const ComponentSlots slots = layout(groups, steps, in_rows);
      const bool possible = slots.rows == 1 || slots.blocks == 1;
      if (!possible || cost_of(slots) >= least) continue;
      least = cost_of(slots);
      best = slots;
    }
  }
  best.places.resize(directions.size());
  if (best.any()) {
    set_places(groups, best);
  } else {
    std::iota(best.places.begin(), best.places.end(), 0U);
  }
  return best;
}

}  // namespace buoyancy
