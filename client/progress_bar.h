// A line on a terminal that shows how far a run has come; nothing where standard error is no terminal.
#pragma once

#include <chrono>
#include <cstdint>

namespace buoyancy {

class ProgressBar {
 public:
  explicit ProgressBar(std::int64_t steps);  // in all, >= 1
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  // clears the line

  void show(std::int64_t step);  // draws ten times a second at most

 private:
  std::int64_t steps_;
  bool is_terminal_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace buoyancy
