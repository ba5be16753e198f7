// A progress bar on standard error, where that is a terminal; elsewhere nothing at all.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace buoyancy {

class ProgressBar {
 public:
  explicit ProgressBar(std::string unit);  // of what is counted beside the bar: "steps"
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { clear(); }

  // Draws at most ten times a second. done <= total, in any unit; count: in the bar's.
  void update(std::int64_t done, std::int64_t total, std::int64_t count);
  void clear();  // so that other text may be written

 private:
  std::string unit_;
  bool is_terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace buoyancy
