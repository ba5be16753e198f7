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

// The exact percentile: the smallest duration that at least per_mille / 1000 of all durations do not exceed.
double exact_percentile(std::vector<double> durations, std::size_t per_mille) {
  std::sort(durations.begin(), durations.end());
  return durations[(durations.size() * per_mille + 999) / 1000 - 1];
}

void expect_within_bucket(double percentile, double exact) {
  EXPECT_GE(percentile, exact * (1.0 - 1e-12));
  EXPECT_LE(percentile, std::max(exact * kBucketRatio, 1e-9 * kBucketRatio));
}

void expect_percentiles(const std::vector<double>& durations) {
  LatencyHistogram histogram;
  for (const double duration : durations) histogram.add(duration);
  const LatencyPercentiles percentiles = histogram.percentiles();
  expect_within_bucket(percentiles.p50, exact_percentile(durations, 500));
  expect_within_bucket(percentiles.p99, exact_percentile(durations, 990));
  expect_within_bucket(percentiles.p999, exact_percentile(durations, 999));
  EXPECT_EQ(percentiles.max, *std::max_element(durations.begin(), durations.end()));
  EXPECT_EQ(histogram.count(), static_cast<std::int64_t>(durations.size()));
}

TEST(LatencyHistogram, IsExactForNoneAndForOneDuration) {
  LatencyHistogram histogram;
  for (const double duration : {0.0, 1.7e-5}) {
    if (duration > 0.0) histogram.add(duration);
    const LatencyPercentiles percentiles = histogram.percentiles();
    EXPECT_EQ(percentiles.p50, duration);
    EXPECT_EQ(percentiles.p99, duration);
    EXPECT_EQ(percentiles.p999, duration);
    EXPECT_EQ(percentiles.max, duration);
  }
}

TEST(LatencyHistogram, MatchesUniformDistribution) {
  std::vector<double> durations;
  for (int i = 1; i <= 10000; ++i) durations.push_back(i * 1e-6);
  expect_percentiles(durations);
}

TEST(LatencyHistogram, MatchesExponentialDistribution) {
  std::mt19937_64 random(1);
  std::exponential_distribution<double> distribution(1.0 / 20e-6);
  std::vector<double> durations(100000);
  for (double& duration : durations) duration = distribution(random);
  expect_percentiles(durations);
}

TEST(LatencyHistogram, MatchesDurationsOverItsWholeRange) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-9.0, 3.6);
  for (const std::size_t size : {1U, 2U, 3U, 99U, 100U, 101U, 999U, 1000U, 1001U, 20000U}) {
    std::vector<double> durations(size);
    for (double& duration : durations) duration = std::pow(10.0, exponent(random));
    expect_percentiles(durations);
  }
}

TEST(LatencyHistogram, RoundsRankUp) {
  // With 990 short and 10 long durations, the 99th percentile is short and the 99.9th is long.
  LatencyHistogram histogram;
  for (int i = 0; i < 990; ++i) histogram.add(1e-5);
  for (int i = 0; i < 10; ++i) histogram.add(1e-2);
  EXPECT_LT(histogram.percentiles().p99, 1.1e-5);
  EXPECT_EQ(histogram.percentiles().p999, 1e-2);
  histogram.add(1e-2);
  EXPECT_EQ(histogram.percentiles().p99, 1e-2);
}

TEST(LatencyHistogram, CountsNegativeAndNanAsZero) {
  LatencyHistogram histogram;
  histogram.add(-1.0);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.count(), 3);
  EXPECT_EQ(histogram.percentiles().p999, 0.0);
  EXPECT_EQ(histogram.percentiles().max, 0.0);
}

TEST(LatencyHistogram, ReturnsMaximumBeyondItsRange) {
  LatencyHistogram histogram;
  histogram.add(1e6);
  EXPECT_EQ(histogram.count(), 1);
  EXPECT_EQ(histogram.percentiles().p50, 1e6);
  histogram.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.percentiles().max, std::numeric_limits<double>::infinity());
}

TEST(LatencyHistogram, DoesNotAllocate) {
  LatencyHistogram histogram;
  const AllocationCount allocations;
  for (int i = 0; i < 1000; ++i) histogram.add(i * 1e-6);
  EXPECT_GT(histogram.percentiles().p50, 0.0);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace buoyancy
