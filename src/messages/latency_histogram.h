// Percentiles of durations in constant memory: logarithmic buckets, 1/32 octave wide, from 1 ns to 4,000 s.
//
// A percentile p is the smallest duration that at least the share p of all durations does not exceed. It is
// read at the upper end of its bucket: never below the true one, at most 2.2 % (or 1 ns) above it. The
// maximum is exact. add: O(1), no heap; percentiles: O(buckets).
#pragma once

#include <array>
#include <cstdint>

#include "messages/status.h"

namespace buoyancy {

class LatencyHistogram {
 public:
  void add(double seconds);                // negative and NaN count as 0
  LatencyPercentiles percentiles() const;  // zeros where nothing was added
  std::int64_t count() const { return count_; }

 private:
  // s: of the duration with this rank, counted from 1 at the shortest.
  double value_at(std::int64_t rank) const;

  static constexpr int kPerOctave = 32;
  static constexpr int kBuckets = 42 * kPerOctave;
  std::array<std::int64_t, kBuckets> buckets_{};
  std::int64_t count_ = 0;
  double max_ = 0.0;
};

}  // namespace buoyancy
