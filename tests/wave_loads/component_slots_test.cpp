#include "wave_loads/component_slots.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

// `number` components of each of `directions` directions, in a random order.
std::vector<double> directions_of(int directions, int number, std::uint64_t seed) {
  std::vector<double> all;
  for (int direction = 0; direction < directions; ++direction) {
    all.insert(all.end(), static_cast<std::size_t>(number), 7.5 * direction);
  }
  std::shuffle(all.begin(), all.end(), std::mt19937_64(seed));
  return all;
}

TEST(ComponentSlots, HoldComponentsOfOneDirectionEach) {
  for (const int directions : {1, 5, 8, 9, 31}) {
    for (const int number : {40, 64}) {
      const std::vector<double> all = directions_of(directions, number, 3);
      const ComponentSlots slots = component_slots(all);
      ASSERT_TRUE(slots.any()) << directions << " directions of " << number;
      ASSERT_EQ(slots.places.size(), all.size());
      std::set<std::uint32_t> places(slots.places.begin(), slots.places.end());
      EXPECT_EQ(places.size(), all.size()) << "two components have the same place";
      EXPECT_LT(*places.rbegin(), slots.place_count());
      std::map<std::size_t, double> direction_of_slot;
      std::set<std::size_t> begun;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto [slot, is_new] = direction_of_slot.try_emplace(slots.slot_of(slots.places[i]), all[i]);
        EXPECT_EQ(slot->second, all[i]);
        EXPECT_LT(slot->first, slots.count);
        if (slots.begins_slot(slots.places[i])) {
          EXPECT_TRUE(begun.insert(slot->first).second) << "slot " << slot->first << " begins twice";
        }
      }
      EXPECT_EQ(begun.size(), direction_of_slot.size());
    }
  }
}

// Four rows of five lanes would be more than a block, and one row would leave most of its lanes unused.
TEST(ComponentSlots, HaveSeveralLanesWhereDirectionsAreFew) {
  const ComponentSlots slots = component_slots(directions_of(5, 40, 3));
  EXPECT_EQ(slots.count, 5U);
  EXPECT_EQ(slots.rows, 3U);
  EXPECT_EQ(slots.steps, 14U);
  EXPECT_EQ(slots.blocks, 1U);
}

TEST(ComponentSlots, AreLeftOutWhereDirectionsDiffer) {
  std::vector<double> directions;
  for (int i = 0; i < 200; ++i) directions.push_back(1.8 * i);
  const ComponentSlots slots = component_slots(directions);
  EXPECT_FALSE(slots.any());
  EXPECT_EQ(slots.place_count(), directions.size());
  EXPECT_EQ(slots.places.back(), directions.size() - 1);
  EXPECT_FALSE(component_slots({}).any());
}

}  // namespace
}  // namespace buoyancy
