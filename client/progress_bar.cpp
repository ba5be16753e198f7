#include "client/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <unistd.h>

namespace buoyancy {

ProgressBar::ProgressBar(std::int64_t steps)
    : steps_(std::max<std::int64_t>(steps, 1)),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      next_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::show(std::int64_t step) {
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  drawn_ = true;

  constexpr int kWidth = 40;
  const double done = static_cast<double>(step) / static_cast<double>(steps_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = step > 0 ? elapsed * (1.0 - done) / done : 0.0;
  const std::string bar(static_cast<std::size_t>(kWidth * done), '#');
  std::fprintf(stderr, "\r[%-*s] %3.0f %%  step %lld of %lld, %.0f s left\x1b[K", kWidth, bar.c_str(),
               100.0 * done, static_cast<long long>(step), static_cast<long long>(steps_), left);
}

}  // namespace buoyancy
