#include "messages/latency_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allocation_count.h"

namespace buoyancy {
namespace {

const double kBucketRatio = std::exp2(1.0 / 32.0) * (1.0 + 1e-12);

// The definition, from all durations: the smallest that at least per_mille / 1000 of them do not exceed.
double percentile_of(std::vector<double> durations, std::size_t per_mille) {
  std::sort(durations.begin(), durations.end());
  return durations[(durations.size() * per_mille + 999) / 1000 - 1];
}

void expect_read(double read, double truth) {
  EXPECT_GE(read, truth * (1.0 - 1e-12));
  EXPECT_LE(read, std::max(truth * kBucketRatio, 1e-9 * kBucketRatio));
}

void expect_percentiles_of(const std::vector<double>& durations) {
  LatencyHistogram histogram;
  for (const double duration : durations) histogram.add(duration);
  const LatencyPercentiles read = histogram.percentiles();
  expect_read(read.p50, percentile_of(durations, 500));
  expect_read(read.p99, percentile_of(durations, 990));
  expect_read(read.p999, percentile_of(durations, 999));
  EXPECT_EQ(read.max, *std::max_element(durations.begin(), durations.end()));
  EXPECT_EQ(histogram.count(), static_cast<std::int64_t>(durations.size()));
}

TEST(LatencyHistogram, ReadsZerosBeforeAnythingIsAdded) {
  const LatencyPercentiles read = LatencyHistogram{}.percentiles();
  EXPECT_EQ(read.p50, 0.0);
  EXPECT_EQ(read.p99, 0.0);
  EXPECT_EQ(read.p999, 0.0);
  EXPECT_EQ(read.max, 0.0);
}

TEST(LatencyHistogram, ReadsEveryPercentileOfASingleDurationExactly) {
  LatencyHistogram histogram;
  histogram.add(1.7e-5);
  const LatencyPercentiles read = histogram.percentiles();
  EXPECT_EQ(read.p50, 1.7e-5);
  EXPECT_EQ(read.p99, 1.7e-5);
  EXPECT_EQ(read.p999, 1.7e-5);
  EXPECT_EQ(read.max, 1.7e-5);
}

TEST(LatencyHistogram, ReadsAUniformDistribution) {
  std::vector<double> durations;
  for (int i = 1; i <= 10000; ++i) durations.push_back(i * 1e-6);
  expect_percentiles_of(durations);
}

TEST(LatencyHistogram, ReadsAnExponentialDistribution) {
  std::mt19937_64 random(1);
  std::exponential_distribution<double> distribution(1.0 / 20e-6);
  std::vector<double> durations(100000);
  for (double& duration : durations) duration = distribution(random);
  expect_percentiles_of(durations);
}

TEST(LatencyHistogram, ReadsDurationsSpreadOverItsWholeRange) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-9.0, 3.6);
  for (const std::size_t size : {1U, 2U, 3U, 99U, 100U, 101U, 999U, 1000U, 1001U, 20000U}) {
    std::vector<double> durations(size);
    for (double& duration : durations) duration = std::pow(10.0, exponent(random));
    expect_percentiles_of(durations);
  }
}

TEST(LatencyHistogram, PutsTheRankWhereTheShareIsReached) {
  // 990 short ones and 10 long ones: the 99th percentile is still short, the 99.9th is long.
  LatencyHistogram histogram;
  for (int i = 0; i < 990; ++i) histogram.add(1e-5);
  for (int i = 0; i < 10; ++i) histogram.add(1e-2);
  EXPECT_LT(histogram.percentiles().p99, 1.1e-5);
  EXPECT_EQ(histogram.percentiles().p999, 1e-2);
  histogram.add(1e-2);
  EXPECT_EQ(histogram.percentiles().p99, 1e-2);
}

TEST(LatencyHistogram, CountsNegativeAndNaNAsZero) {
  LatencyHistogram histogram;
  histogram.add(-1.0);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.count(), 3);
  EXPECT_EQ(histogram.percentiles().p999, 0.0);
  EXPECT_EQ(histogram.percentiles().max, 0.0);
}

TEST(LatencyHistogram, ReadsWhatIsBeyondItsRangeAsTheMaximum) {
  LatencyHistogram histogram;
  histogram.add(1e6);
  EXPECT_EQ(histogram.count(), 1);
  EXPECT_EQ(histogram.percentiles().p50, 1e6);
  histogram.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.percentiles().max, std::numeric_limits<double>::infinity());
}

TEST(LatencyHistogram, TakesNothingFromTheHeap) {
  LatencyHistogram histogram;
  const AllocationCount allocations;
  for (int i = 0; i < 1000; ++i) histogram.add(i * 1e-6);
  EXPECT_GT(histogram.percentiles().p50, 0.0);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace buoyancy
