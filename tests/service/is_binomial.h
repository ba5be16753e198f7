// Whether a count is one that a binomial distribution allows.
#pragma once

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace buoyancy::service {

// Of n draws; five standard deviations are exceeded once in 1.7 million times.
template <typename Count>
testing::AssertionResult is_binomial(std::int64_t count, Count n, double probability) {
  const double mean = static_cast<double>(n) * probability;
  const double bound = 5.0 * std::sqrt(mean * (1.0 - probability)) + 0.5;
  if (std::abs(static_cast<double>(count) - mean) <= bound) return testing::AssertionSuccess();
  return testing::AssertionFailure() << count << " of " << n << ", expected " << mean << " +- " << bound;
}

}  // namespace buoyancy::service
