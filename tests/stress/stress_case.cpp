#include "tests/stress/stress_case.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

constexpr int kMaxShown = 4;  // violations

}  // namespace

StressCase::StressCase(std::string row, std::string oracle, std::string gate)
    : row_(std::move(row)), oracle_(std::move(oracle)), gate_(std::move(gate)) {}

StressCase::~StressCase() {
  EXPECT_GT(checks_, 0) << "the row made no measurement";
  if (violations_ > kMaxShown) ADD_FAILURE() << violations_ << " violations in " << checks_ << " checks";
  std::array<char, 32> largest{};
  std::snprintf(largest.data(), largest.size(), "%.4g", largest_);
  testing::Test::RecordProperty("row", row_);
  testing::Test::RecordProperty("oracle", oracle_);
  testing::Test::RecordProperty("gate", gate_);
  testing::Test::RecordProperty("largest", largest.data());
  testing::Test::RecordProperty("largest_at", largest_at_);
  testing::Test::RecordProperty("checks", std::to_string(checks_));
}

void StressCase::check(double measured, double gate, const std::string& where) {
  ++checks_;
  const bool holds = measured >= 0.0 && measured <= gate && std::isfinite(gate);
  double ratio = measured == 0.0 ? 0.0 : measured / gate;
  if (std::isnan(ratio)) ratio = std::numeric_limits<double>::infinity();
  if (ratio > largest_) {
    largest_ = ratio;
    largest_at_ = where;
  }
  if (!holds && ++violations_ <= kMaxShown) {
    ADD_FAILURE() << row_ << ": " << measured << ", expected at most " << gate << " (" << gate_ << "), at "
                  << where;
  }
}

}  // namespace buoyancy
