#include "transport/adaptive_spin.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

using Duration = QuickWait::Duration;
using std::chrono::microseconds;

// A wait for a message that comes after `after`. Did it look and find it?
bool finds(QuickWait& wait, Duration after) {
  const Duration longest = wait.begin();
  if (longest > Duration::zero()) wait.looked(std::min(after, longest), after <= longest);
  if (after <= longest) return true;
  wait.slept(after);
  return false;
}

int found_in(QuickWait& wait, int waits, Duration after) {
  int found = 0;
  for (int i = 0; i < waits; ++i) found += finds(wait, after) ? 1 : 0;
  return found;
}

TEST(QuickWait, LooksEachTimeWhileMessagesComeQuickly) {
  QuickWait wait;
  EXPECT_EQ(found_in(wait, 1'000, microseconds(5)), 1'000);
}

TEST(QuickWait, HardlyEverLooksWhereMessagesAreFarApart) {
  QuickWait wait;
  constexpr int kWaits = 100'000;
  int looks = 0;
  for (int i = 0; i < kWaits; ++i) {
    const Duration longest = wait.begin();
    if (longest > Duration::zero()) {
      ++looks;
      wait.looked(longest, false);
    }
    wait.slept(microseconds(1'000));
  }
  EXPECT_LE(looks, kWaits / QuickWait::kTrialEvery + 1);
}

TEST(QuickWait, LooksAgainAfterTwoMessagesThatCameQuickly) {
  QuickWait wait;
  found_in(wait, 1'000, microseconds(1'000));
  EXPECT_GE(found_in(wait, 1'000, microseconds(5)), 1'000 - 2);
}

TEST(QuickWait, TwoEndsThatSleepWakeEachOther) {
  constexpr Duration kWakeUp = microseconds(60);
  constexpr Duration kWork = microseconds(5);
  QuickWait here;
  QuickWait there;
  found_in(here, 1'000, microseconds(1'000));
  found_in(there, 10'000, microseconds(1'000));
  // Each answers after its work, and after its wake-up where it slept.
  bool here_awake = false;
  bool there_awake = false;
  for (int exchange = 0; exchange < 2 * QuickWait::kTrialEvery; ++exchange) {
    here_awake = finds(here, kWork + (there_awake ? Duration::zero() : kWakeUp));
    there_awake = finds(there, kWork + (here_awake ? Duration::zero() : kWakeUp));
  }
  EXPECT_TRUE(here_awake);
  EXPECT_TRUE(there_awake);
}

TEST(QuickWait, LooksRarelyWhereTheProcessorDoesNotComeBackForLong) {
  QuickWait wait;
  constexpr int kWaits = 100'000;
  int given_away = 0;
  for (int i = 0; i < kWaits; ++i) {
    if (wait.begin() > Duration::zero()) {
      ++given_away;
      wait.looked(microseconds(4'000), true);
    } else {
      wait.slept(microseconds(5));
    }
  }
  EXPECT_LE(given_away, kWaits / QuickWait::kMostSkipped + 5);
}

}  // namespace
}  // namespace buoyancy
