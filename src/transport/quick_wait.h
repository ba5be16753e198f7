// Whether it pays to look for a message for a moment before going to sleep: it does while they come quickly,
// as in lock-step. On a virtual machine a sleeper is woken some 30 us after the message came; somebody who
// looks has it after one.
//
// The law: a wait that looks and finds the message in time makes looking twice as likely, one that does not
// makes it eight times less likely, down to one wait of kRarest. Where the processors are busy with others,
// looking would cost a share of theirs, so time is measured on the clock: given away and late is no find.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace buoyancy {

class QuickWait {
 public:
  static constexpr std::chrono::microseconds kLongest{50};  // of looking
  static constexpr std::int64_t kRarest = 4096;             // waits of which one looks, where it never pays

  // Asked at the beginning of each wait: look before sleeping?
  bool pays() {
    if (to_skip_ == 0) return true;
    --to_skip_;
    return false;
  }

  // After a wait that looked.
  void found() { every_ = std::max<std::int64_t>(every_ / 2, 1), to_skip_ = every_ - 1; }
  void missed() { every_ = std::min(every_ * 8, kRarest), to_skip_ = every_ - 1; }

 private:
  std::int64_t every_ = 1;  // so many waits, one of which looks
  std::int64_t to_skip_ = 0;
};

}  // namespace buoyancy
