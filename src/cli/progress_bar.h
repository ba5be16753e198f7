// A progress bar on standard error. It draws nothing if standard error is not a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace buoyancy {

class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);  // the unit of the count beside the bar, such as "steps"
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { clear(); }

  // Draws at most ten times per second. done <= total, in any unit; count is in the bar's unit.
  void update(std::int64_t done, std::int64_t total, std::int64_t count);
  void clear();  // removes the bar, so that other text can be written

 private:
  std::string unit_;
  bool is_terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace buoyancy
