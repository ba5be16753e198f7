#include "service/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

namespace buoyancy {
namespace {

constexpr std::size_t kWidth = 40;
constexpr std::chrono::milliseconds kInterval(100);

}  // namespace

ProgressBar::ProgressBar()
    : terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      next_(start_ + kInterval) {}

void ProgressBar::update(std::int64_t done, std::int64_t total, std::int64_t questions) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return;
  next_ = now + kInterval;
  const double part =
      total > 0 ? std::clamp(static_cast<double>(done) / static_cast<double>(total), 0.0, 1.0) : 1.0;
  const auto filled = static_cast<std::size_t>(part * kWidth);
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double left = part > 0.0 ? seconds * (1.0 - part) / part : 0.0;
  const std::string line =
      fmt::format("\r[{}{}] {:3.0f} %  {} questions  {:.0f}/s  {:.0f} s left\x1b[K", std::string(filled, '#'),
                  std::string(kWidth - filled, ' '), part * 100.0, questions,
                  static_cast<double>(questions) / seconds, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

}  // namespace buoyancy
