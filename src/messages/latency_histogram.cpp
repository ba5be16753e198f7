#include "messages/latency_histogram.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

constexpr double kMinDuration = 1e-9;  // [s]

}  // namespace

void LatencyHistogram::add(double seconds) {
  if (!(seconds > 0.0)) seconds = 0.0;  // also replaces NaN
  const double octaves = std::log2(std::max(seconds, kMinDuration) / kMinDuration);
  const double bucket = std::min(octaves * kPerOctave, kBuckets - 1.0);
  ++buckets_[static_cast<std::size_t>(bucket)];
  ++count_;
  max_ = std::max(max_, seconds);
}

double LatencyHistogram::value_at(std::int64_t rank) const {
  std::int64_t cumulative = 0;
  for (int bucket = 0; bucket < kBuckets - 1; ++bucket) {
    cumulative += buckets_[static_cast<std::size_t>(bucket)];
    if (cumulative >= rank) return std::min(kMinDuration * std::exp2((bucket + 1.0) / kPerOctave), max_);
  }
  return max_;
}

LatencyPercentiles LatencyHistogram::percentiles() const {
  // Integer arithmetic: in floating point 0.99 * count may round up to the next rank.
  const auto rank = [&](std::int64_t per_mille) {
    return count_ / 1000 * per_mille + (count_ % 1000 * per_mille + 999) / 1000;
  };
  return {.p50 = value_at(rank(500)), .p99 = value_at(rank(990)), .p999 = value_at(rank(999)), .max = max_};
}

}  // namespace buoyancy
