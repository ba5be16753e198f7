// A progress bar on stderr, where that is a terminal; elsewhere nothing at all.
#pragma once

#include <chrono>
#include <cstdint>

namespace buoyancy {

class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { clear(); }

  // Draws at most ten times a second. done <= total, in any unit; questions are counted beside the bar.
  void update(std::int64_t done, std::int64_t total, std::int64_t questions);
  void clear();  // so that other text may be written

 private:
  bool terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace buoyancy
