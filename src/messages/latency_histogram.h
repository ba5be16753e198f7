// Computes percentiles of durations in constant memory, with logarithmic buckets that are 1/32 octave wide
// and range from 1 ns to 4,000 s.
//
// The percentile p is the smallest duration that at least the fraction p of all durations does not exceed.
// The result is the upper end of its bucket: never below the exact percentile, at most 2.2 % (or 1 ns) above
// it. The maximum is exact. add: O(1), no heap allocation; percentiles: O(buckets).
#pragma once

#include <array>
#include <cstdint>

#include "messages/status.h"

namespace buoyancy {

class LatencyHistogram {
 public:
  void add(double seconds);                // negative and NaN count as 0
  LatencyPercentiles percentiles() const;  // zeros before the first add()
  std::int64_t count() const { return count_; }

 private:
  // The duration [s] of this rank; the shortest duration has rank 1.
  double value_at(std::int64_t rank) const;

  static constexpr int kPerOctave = 32;
  static constexpr int kBuckets = 42 * kPerOctave;
  std::array<std::int64_t, kBuckets> buckets_{};
  std::int64_t count_ = 0;
  double max_ = 0.0;
};

}  // namespace buoyancy
