// The cost of reading the steady clock, which is subtracted from every time.
#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

namespace buoyancy::bench {

using Clock = std::chrono::steady_clock;

inline double nanoseconds(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::nano>(to - from).count();
}

// Minimum difference between two consecutive readings of the clock.
inline double clock_cost_ns() {
  double min_ns = std::numeric_limits<double>::max();
  for (int i = 0; i < 10'000; ++i) {
    const auto start = Clock::now();
    min_ns = std::min(min_ns, nanoseconds(start, Clock::now()));
  }
  return min_ns;
}

}  // namespace buoyancy::bench
