#include "cli/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace buoyancy {
namespace {

constexpr int kWidth = 40;
constexpr std::chrono::milliseconds kInterval(100);

}  // namespace

ProgressBar::ProgressBar(std::string unit)
    : unit_(std::move(unit)),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      next_(start_ + kInterval) {}

void ProgressBar::update(std::int64_t done, std::int64_t total, std::int64_t count) {
  if (!is_terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + kInterval;
  const double fraction =
      total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 1.0;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = fraction > 0.0 ? seconds * (1.0 - fraction) / fraction : 0.0;
  const std::string bar(static_cast<std::size_t>(fraction * kWidth), '#');
  std::fprintf(stderr, "\r[%-*s] %3.0f %%  %lld %s  %.0f/s  %.0f s left\x1b[K", kWidth, bar.c_str(),
               100.0 * fraction, static_cast<long long>(count), unit_.c_str(),
               static_cast<double>(count) / seconds, left);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

}  // namespace buoyancy
