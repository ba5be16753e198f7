#include "geometry/pairwise_total.h"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

double term(std::size_t i) {
  return std::sin(static_cast<double>(i)) * std::exp2(static_cast<double>(i % 60));
}

TEST(PairwiseTotal, HasTheBitsOfTheSumOnOneThread) {
  for (const std::size_t count : {0, 1, 255, 256, 257, 8192, 24'577, 300'000}) {
    PairwiseSum<double> sum;
    for (std::size_t i = 0; i < count; ++i) sum.add(term(i));
    EXPECT_EQ(pairwise_total<double>(count, term), sum.total()) << count;
  }
}

}  // namespace
}  // namespace buoyancy
