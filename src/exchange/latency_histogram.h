// Percentiles of durations in constant memory: logarithmic buckets, 1/32 octave wide, from 1 ns to 4,000 s; a
// percentile is read to within 2.2 %, the maximum exactly. add: O(1), no heap.
#pragma once

#include <array>
#include <cstdint>

#include "messages/status.h"

namespace buoyancy {

class LatencyHistogram {
 public:
  void add(double seconds);  // negative and NaN count as 0
  LatencyPercentiles percentiles() const;
  std::int64_t count() const { return count_; }

 private:
  static constexpr int kPerOctave = 32;
  static constexpr int kBuckets = 42 * kPerOctave;
  std::array<std::int64_t, kBuckets> buckets_{};
  std::int64_t count_ = 0;
  double max_ = 0.0;
};

}  // namespace buoyancy
