// One row of the stress catalogue while it is tested: every measurement is held to its gate, and the largest,
// in units of the gate, goes into the test's record (`--gtest_output=json`), from which
// scripts/measure_stability makes the table of docs/stability.md.
#pragma once

#include <string>

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
  // As they stand in the table: what is asked, who knows the result, what is allowed.
  StressCase(std::string row, std::string oracle, std::string gate);
  StressCase(const StressCase&) = delete;
  StressCase& operator=(const StressCase&) = delete;
  ~StressCase();

  // measured <= gate, both finite and not negative. A gate of 0 allows 0 alone. where: mesh, method, pose.
  void check(double measured, double gate, const std::string& where);

  // For what holds or does not: the same bits, a status, a line of a report.
  void require(bool holds, const std::string& where) { check(holds ? 0.0 : 1.0, 0.0, where); }

 private:
  std::string row_, oracle_, gate_;
  double largest_ = 0.0;  // measured / gate
  std::string largest_at_;
  long checks_ = 0;
  long violations_ = 0;
};

}  // namespace buoyancy
