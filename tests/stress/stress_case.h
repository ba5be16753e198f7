// One row of the stress catalogue while it is tested: every measurement is held to its gate, and the largest,
// in units of the gate, goes into the test's record (`--gtest_output=json`), from which
// scripts/measure_stability makes the table of docs/stability.md.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace buoyancy {

// How many random tries a row makes. ThreadSanitizer is some thirty times slower and has nothing to find on
// one thread.
constexpr int tries(int count) {
#ifdef __SANITIZE_THREAD__
  return count < 20 ? 1 : count / 20;
#else
  return count;
#endif
}

class StressCase {
 public:
  // As they stand in the table: what is asked, who knows the answer, what is allowed.
  StressCase(std::string row, std::string oracle, std::string gate)
      : row_(std::move(row)), oracle_(std::move(oracle)), gate_(std::move(gate)) {}
  StressCase(const StressCase&) = delete;
  StressCase& operator=(const StressCase&) = delete;
  ~StressCase() {
    EXPECT_GT(checks_, 0) << "nothing was measured";
    if (violations_ > kShown) ADD_FAILURE() << violations_ << " violations in " << checks_ << " checks";
    std::array<char, 32> largest{};
    std::snprintf(largest.data(), largest.size(), "%.4g", largest_);
    testing::Test::RecordProperty("row", row_);
    testing::Test::RecordProperty("oracle", oracle_);
    testing::Test::RecordProperty("gate", gate_);
    testing::Test::RecordProperty("largest", largest.data());
    testing::Test::RecordProperty("largest_at", largest_at_);
    testing::Test::RecordProperty("checks", std::to_string(checks_));
  }

  // measured <= gate, both finite and not negative. A gate of 0 allows 0 alone. where: mesh, method, pose.
  void check(double measured, double gate, const std::string& where) {
    ++checks_;
    const bool holds = measured >= 0.0 && measured <= gate && std::isfinite(gate);
    double ratio = measured == 0.0 ? 0.0 : measured / gate;
    if (std::isnan(ratio)) ratio = std::numeric_limits<double>::infinity();
    if (ratio > largest_) {
      largest_ = ratio;
      largest_at_ = where;
    }
    if (!holds && ++violations_ <= kShown) {
      ADD_FAILURE() << row_ << ": " << measured << ", allowed " << gate << " (" << gate_ << "), at " << where;
    }
  }

  // For what holds or does not: the same bits, a status, a line of a report.
  void require(bool holds, const std::string& where) { check(holds ? 0.0 : 1.0, 0.0, where); }

 private:
  static constexpr int kShown = 4;

  std::string row_, oracle_, gate_;
  double largest_ = 0.0;  // measured / gate
  std::string largest_at_;
  long checks_ = 0;
  long violations_ = 0;
};

}  // namespace buoyancy
