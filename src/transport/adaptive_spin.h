// Decides how long a thread that waits for a message spins (polls) before it blocks. Spinning pays while
// messages arrive in quick succession, as in lock-step: on a virtual machine a blocked thread wakes some
// 30 us after its message arrived, a spinning thread after 1 us. The spinning thread yields the processor at
// each poll to any other thread that wants it.
//
// Rules:
//   - A wait spins for kSpinTime if the messages of the two previous waits arrived within kSpinTime. For a
//     wait that blocked, the kernel's time stamp of the arrival counts.
//   - Two ends that both block delay each other so much that neither would ever spin again. So at first, and
//     after kProbeEvery waits without a spin, the next kProbeWaits waits spin for kProbeTime, which is longer
//     than the other end takes to wake up; the other end then observes messages in quick succession. The
//     first probe that finds nothing ends the probing.
//   - On a loaded machine a yielded processor comes back only after milliseconds: after a spin that took
//     longer than kPreemptedAfter, no wait spins for the next 1, 8, 64, ... kMaxSkipped waits. Each spin that
//     finds its message halves the next such number.
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

  // Called at the beginning of each wait. Returns for how long it should spin; 0: block at once.
  Duration begin() {
    if (waits_to_skip_ > 0) {
      --waits_to_skip_;
      return Duration::zero();
    }
    if (consecutive_fast_ >= 2) {
      waits_since_spin_ = 0;
      return kSpinTime;
    }
    if (probes_left_ == 0 && ++waits_since_spin_ < kProbeEvery) return Duration::zero();
    if (probes_left_ == 0) probes_left_ = kProbeWaits;
    --probes_left_;
    waits_since_spin_ = 0;
    return kProbeTime;
  }

  // Called after a wait that spun. elapsed: until a message was found or the spin ended.
  void record_spin(Duration elapsed, bool found) {
    if (elapsed > kPreemptedAfter) {
      waits_to_skip_ = next_skip_count_;
      next_skip_count_ = std::min(8 * next_skip_count_, kMaxSkipped);
    } else if (found) {
      next_skip_count_ = std::max<std::int64_t>(next_skip_count_ / 2, 1);
    }
    if (!found) probes_left_ = 0;
    record_arrival(found && elapsed <= kSpinTime);
  }

  // Called after a wait that blocked. arrived_after: from its beginning to the arrival of the message.
  void record_sleep(Duration arrived_after) { record_arrival(arrived_after <= kSpinTime); }

 private:
  void record_arrival(bool fast) { consecutive_fast_ = fast ? std::min(consecutive_fast_ + 1, 2) : 0; }

  int consecutive_fast_ = 0;
  int probes_left_ = kProbeWaits;
  int waits_since_spin_ = 0;  // waits since the last spin
  std::int64_t waits_to_skip_ = 0;
  std::int64_t next_skip_count_ = 1;
};

}  // namespace buoyancy
