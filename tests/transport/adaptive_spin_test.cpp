#include "transport/adaptive_spin.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

using Duration = AdaptiveSpin::Duration;
using std::chrono::microseconds;

// Simulates a wait for a message that arrives after `delay`. Returns whether a spin found it.
bool finds(AdaptiveSpin& wait, Duration delay) {
  const Duration limit = wait.begin();
  if (limit > Duration::zero()) wait.record_spin(std::min(delay, limit), delay <= limit);
  if (delay <= limit) return true;
  wait.record_sleep(delay);
  return false;
}

int count_found(AdaptiveSpin& wait, int waits, Duration delay) {
  int found = 0;
  for (int i = 0; i < waits; ++i) found += finds(wait, delay) ? 1 : 0;
  return found;
}

TEST(AdaptiveSpin, SpinsOnEveryWaitWhileMessagesArriveQuickly) {
  AdaptiveSpin wait;
  EXPECT_EQ(count_found(wait, 1'000, microseconds(5)), 1'000);
}

TEST(AdaptiveSpin, RarelySpinsIfMessagesAreFarApart) {
  AdaptiveSpin wait;
  constexpr int kWaits = 100'000;
  int spins = 0;
  for (int i = 0; i < kWaits; ++i) {
    const Duration limit = wait.begin();
    if (limit > Duration::zero()) {
      ++spins;
      wait.record_spin(limit, false);
    }
    wait.record_sleep(microseconds(1'000));
  }
  EXPECT_LE(spins, kWaits / AdaptiveSpin::kProbeEvery + 1);
}

TEST(AdaptiveSpin, SpinsAgainAfterTwoQuickMessages) {
  AdaptiveSpin wait;
  count_found(wait, 1'000, microseconds(1'000));
  EXPECT_GE(count_found(wait, 1'000, microseconds(5)), 1'000 - 2);
}

TEST(AdaptiveSpin, RecoversWhenBothEndsBlock) {
  constexpr Duration kWakeUp = microseconds(60);
  constexpr Duration kWork = microseconds(5);
  AdaptiveSpin here;
  AdaptiveSpin there;
  count_found(here, 1'000, microseconds(1'000));
  count_found(there, 10'000, microseconds(1'000));
  // Each end responds after its work, and after its wake-up if it blocked.
  bool here_awake = false;
  bool there_awake = false;
  for (int exchange = 0; exchange < 2 * AdaptiveSpin::kProbeEvery; ++exchange) {
    here_awake = finds(here, kWork + (there_awake ? Duration::zero() : kWakeUp));
    there_awake = finds(there, kWork + (here_awake ? Duration::zero() : kWakeUp));
  }
  EXPECT_TRUE(here_awake);
  EXPECT_TRUE(there_awake);
}

TEST(AdaptiveSpin, RarelySpinsIfPreempted) {
  AdaptiveSpin wait;
  constexpr int kWaits = 100'000;
  int preempted = 0;
  for (int i = 0; i < kWaits; ++i) {
    if (wait.begin() > Duration::zero()) {
      ++preempted;
      wait.record_spin(microseconds(4'000), true);
    } else {
      wait.record_sleep(microseconds(5));
    }
  }
  EXPECT_LE(preempted, kWaits / AdaptiveSpin::kMaxSkipped + 5);
}

}  // namespace
}  // namespace buoyancy
