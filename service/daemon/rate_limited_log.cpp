#include "service/daemon/rate_limited_log.h"

#include <algorithm>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace buoyancy {

void RateLimitedLog::add(const LogEvent& warning, double now) {
  if (warning.count == 0) return;
  auto known =
      std::ranges::find(lasting_, warning.what, [](const ActiveEvent& one) { return one.pending.what; });
  if (known == lasting_.end())
    known = lasting_.insert(known, ActiveEvent{.pending = {.what = warning.what, .count = 0, .detail = {}}});
  known->pending.count += warning.count;
  known->pending.detail = warning.detail;
  known->last_occurrence = now;
}

std::vector<std::string> RateLimitedLog::drain(double now) {
  std::vector<std::string> lines;
  for (ActiveEvent& one : lasting_) {
    const std::size_t interval = std::min(std::max<std::size_t>(one.lines, 1), kRepeatIntervals.size()) - 1;
    const double since = now - one.last_line;
    const bool due = one.lines == 0 || since >= kRepeatIntervals[interval];
    if (one.pending.count == 0 || !due) continue;
    lines.push_back(fmt::format("{}: {}{}{}{}", one.pending.what, one.pending.count,
                                one.lines == 0 ? "" : fmt::format(" in {:.0f} s", since),
                                one.pending.detail.empty() ? "" : "; ", one.pending.detail));
    one.pending.count = 0;
    one.last_line = now;
    ++one.lines;
  }
  std::erase_if(lasting_, [now](const ActiveEvent& one) {
    return one.pending.count == 0 && now - one.last_occurrence >= kRepeatIntervals.back();
  });
  return lines;
}

}  // namespace buoyancy
