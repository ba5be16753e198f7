// The middle of a set of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace buoyancy {

// Of an even count the mean of the two in the middle. At least one value, none of them NaN.
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace buoyancy
