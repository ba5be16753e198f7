// Whether whoever waits for a message should look for it for a moment before going to sleep: it pays while
// messages come quickly, as in lock-step. On a virtual machine a sleeper is woken some 30 us after its
// message came; somebody who looks has it after one. Looking gives the processor away at each look, to
// whoever wants it.
//
// The law:
//   - A wait looks, for kSpinTime, if the messages of the two before it came within kSpinTime. That holds of
//   those
//     that slept too, by the kernel's stamp of arrival.
//   - Two ends that both sleep keep each other waiting for so long that neither looks. So after kProbeEvery
//     waits without a look, and at first, the next kProbeWaits look for kProbeTime, longer than it takes to
//     wake the other end, which then sees messages that come quickly. The first that finds nothing ends the
//     trial.
//   - Where processors are busy with others, one that is given away comes back after milliseconds: after a
//     look that took longer than kPreemptedAfter no wait looks for 1, 8, 64, ... kMaxSkipped waits; each look
//     that finds its message halves what comes next.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace buoyancy {

class AdaptiveSpin {
 public:
  using Duration = std::chrono::nanoseconds;
  static constexpr Duration kSpinTime = std::chrono::microseconds(50);
  static constexpr Duration kProbeTime = std::chrono::microseconds(200);
  static constexpr Duration kPreemptedAfter = std::chrono::microseconds(400);
  static constexpr int kProbeEvery = 128;
  static constexpr int kProbeWaits = 8;
  static constexpr std::int64_t kMaxSkipped = 4096;

  // At the beginning of each wait: for how long it should look. 0: not at all.
  Duration begin() {
    if (to_skip_ > 0) {
      --to_skip_;
      return Duration::zero();
    }
    if (quick_in_a_row_ >= 2) {
      without_look_ = 0;
      return kSpinTime;
    }
    if (trial_left_ == 0 && ++without_look_ < kProbeEvery) return Duration::zero();
    if (trial_left_ == 0) trial_left_ = kProbeWaits;
    --trial_left_;
    without_look_ = 0;
    return kProbeTime;
  }

  // After a wait that looked for so long, until it found a message or gave up.
  void record_spin(Duration took, bool found) {
    if (took > kPreemptedAfter) {
      to_skip_ = next_skip_;
      next_skip_ = std::min(8 * next_skip_, kMaxSkipped);
    } else if (found) {
      next_skip_ = std::max<std::int64_t>(next_skip_ / 2, 1);
    }
    if (!found) trial_left_ = 0;
    note(found && took <= kSpinTime);
  }

  // After one that slept: how long after its beginning the message arrived.
  void record_sleep(Duration arrived_after) { note(arrived_after <= kSpinTime); }

 private:
  void note(bool quick) { quick_in_a_row_ = quick ? std::min(quick_in_a_row_ + 1, 2) : 0; }

  int quick_in_a_row_ = 0;
  int trial_left_ = kProbeWaits;
  int without_look_ = 0;  // waits since the last that looked
  std::int64_t to_skip_ = 0;
  std::int64_t next_skip_ = 1;
};

}  // namespace buoyancy
