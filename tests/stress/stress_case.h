// One row of the stress catalogue during its test. Every measurement is compared with its gate, the largest
// value allowed; the largest measurement, in units of its gate, goes into the test's record
// (`--gtest_output=json`), from which scripts/measure stability makes the table of docs/stability.md.
#pragma once

#include <string>

namespace buoyancy {

// The number of random tries of a row. ThreadSanitizer is some thirty times slower and cannot find anything
// on one thread.
constexpr int tries(int count) {
#ifdef __SANITIZE_THREAD__
  return count < 20 ? 1 : count / 20;
#else
  return count;
#endif
}

class StressCase {
 public:
  // The first three cells of the table's row: the case, the source of the true result, the gate.
  StressCase(std::string row, std::string oracle, std::string gate);
  StressCase(const StressCase&) = delete;
  StressCase& operator=(const StressCase&) = delete;
  ~StressCase();

  // Requires measured <= gate, both finite and not negative; a gate of 0 allows only 0. where: mesh, method,
  // pose.
  void check(double measured, double gate, const std::string& where);

  // Requires a condition: identical bits, a status, a line of a report.
  void require(bool holds, const std::string& where) { check(holds ? 0.0 : 1.0, 0.0, where); }

 private:
  std::string row_, oracle_, gate_;
  double largest_ = 0.0;  // measured / gate
  std::string largest_at_;
  long checks_ = 0;
  long violations_ = 0;
};

}  // namespace buoyancy
