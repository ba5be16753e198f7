#include "transport/quick_wait.h"

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

// How many of so many waits looked, if finding is decided by `finds`.
template <typename Finds>
int looked_in(QuickWait& wait, int waits, Finds&& finds) {
  int looked = 0;
  for (int i = 0; i < waits; ++i) {
    if (!wait.pays()) continue;
    ++looked;
    if (finds(i)) {
      wait.found();
    } else {
      wait.missed();
    }
  }
  return looked;
}

TEST(QuickWait, LooksEachTimeWhileMessagesComeQuickly) {
  QuickWait wait;
  EXPECT_EQ(looked_in(wait, 1'000, [](int) { return true; }), 1'000);
}

TEST(QuickWait, LooksHardlyEverWhereNothingComes) {
  QuickWait wait;
  constexpr int kWaits = 1'000'000;
  EXPECT_LE(looked_in(wait, kWaits, [](int) { return false; }), kWaits / QuickWait::kRarest + 8);
}

TEST(QuickWait, ComesBackToLookingWhenMessagesComeQuicklyAgain) {
  QuickWait wait;
  looked_in(wait, 100'000, [](int) { return false; });
  looked_in(wait, 3 * QuickWait::kRarest, [](int) { return true; });
  EXPECT_EQ(looked_in(wait, 1'000, [](int) { return true; }), 1'000);
}

TEST(QuickWait, LooksRarelyWhereItFailsHalfTheTime) {
  QuickWait wait;
  constexpr int kWaits = 1'000'000;
  EXPECT_LE(looked_in(wait, kWaits, [](int i) { return i % 2 == 0; }), kWaits / 100);
}

}  // namespace
}  // namespace buoyancy
