// Median and other percentiles of a set of numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace buoyancy::bench {

// For an even count the mean of the two middle values. Precondition: at least one value, no NaN.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Smallest value that is not exceeded by the fraction `share` of all values, 0 < share <= 1. Precondition: at
// least one value, no NaN.
inline double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace buoyancy::bench
