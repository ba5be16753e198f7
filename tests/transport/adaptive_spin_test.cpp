#include "transport/adaptive_spin.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

using Duration = AdaptiveSpin::Duration;
using std::chrono::microseconds;

// A wait for a message that comes after `after`. Did it look and find it?
bool finds(AdaptiveSpin& wait, Duration after) {
  const Duration longest = wait.begin();
  if (longest > Duration::zero()) wait.record_spin(std::min(after, longest), after <= longest);
  if (after <= longest) return true;
  wait.record_sleep(after);
  return false;
}

int found_in(AdaptiveSpin& wait, int waits, Duration after) {
  int found = 0;
  for (int i = 0; i < waits; ++i) found += finds(wait, after) ? 1 : 0;
  return found;
}

TEST(AdaptiveSpin, LooksEachTimeWhileMessagesComeQuickly) {
  AdaptiveSpin wait;
  EXPECT_EQ(found_in(wait, 1'000, microseconds(5)), 1'000);
}

TEST(AdaptiveSpin, HardlyEverLooksWhereMessagesAreFarApart) {
  AdaptiveSpin wait;
  constexpr int kWaits = 100'000;
  int looks = 0;
  for (int i = 0; i < kWaits; ++i) {
    const Duration longest = wait.begin();
    if (longest > Duration::zero()) {
      ++looks;
      wait.record_spin(longest, false);
    }
    wait.record_sleep(microseconds(1'000));
  }
  EXPECT_LE(looks, kWaits / AdaptiveSpin::kProbeEvery + 1);
}

TEST(AdaptiveSpin, LooksAgainAfterTwoMessagesThatCameQuickly) {
  AdaptiveSpin wait;
  found_in(wait, 1'000, microseconds(1'000));
  EXPECT_GE(found_in(wait, 1'000, microseconds(5)), 1'000 - 2);
}

TEST(AdaptiveSpin, TwoEndsThatSleepWakeEachOther) {
  constexpr Duration kWakeUp = microseconds(60);
  constexpr Duration kWork = microseconds(5);
  AdaptiveSpin here;
  AdaptiveSpin there;
  found_in(here, 1'000, microseconds(1'000));
  found_in(there, 10'000, microseconds(1'000));
  // Each responses after its work, and after its wake-up where it slept.
  bool here_awake = false;
  bool there_awake = false;
  for (int handler = 0; handler < 2 * AdaptiveSpin::kProbeEvery; ++handler) {
    here_awake = finds(here, kWork + (there_awake ? Duration::zero() : kWakeUp));
    there_awake = finds(there, kWork + (here_awake ? Duration::zero() : kWakeUp));
  }
  EXPECT_TRUE(here_awake);
  EXPECT_TRUE(there_awake);
}

TEST(AdaptiveSpin, LooksRarelyWhereTheProcessorDoesNotComeBackForLong) {
  AdaptiveSpin wait;
  constexpr int kWaits = 100'000;
  int given_away = 0;
  for (int i = 0; i < kWaits; ++i) {
    if (wait.begin() > Duration::zero()) {
      ++given_away;
      wait.record_spin(microseconds(4'000), true);
    } else {
      wait.record_sleep(microseconds(5));
    }
  }
  EXPECT_LE(given_away, kWaits / AdaptiveSpin::kMaxSkipped + 5);
}

}  // namespace
}  // namespace buoyancy
