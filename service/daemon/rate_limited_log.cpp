#include "service/daemon/rate_limited_log.h"

#include <algorithm>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace buoyancy::service {

void RateLimitedLog::add(const LogEvent& event, double now) {
  if (event.count == 0) return;
  auto known = std::ranges::find(active_, event.message,
                                 [](const ActiveEvent& active) { return active.pending.message; });
  if (known == active_.end())
    known =
        active_.insert(known, ActiveEvent{.pending = {.message = event.message, .count = 0, .detail = {}}});
  known->pending.count += event.count;
  known->pending.detail = event.detail;
  known->last_occurrence = now;
}

std::vector<std::string> RateLimitedLog::drain(double now) {
  std::vector<std::string> lines;
  for (ActiveEvent& event : active_) {
    const std::size_t interval = std::min(std::max<std::size_t>(event.lines, 1), kRepeatIntervals.size()) - 1;
    const double since = now - event.last_line;
    const bool due = event.lines == 0 || since >= kRepeatIntervals[interval];
    if (event.pending.count == 0 || !due) continue;
    lines.push_back(fmt::format("{}: {}{}{}{}", event.pending.message, event.pending.count,
                                event.lines == 0 ? "" : fmt::format(" in {:.0f} s", since),
                                event.pending.detail.empty() ? "" : "; ", event.pending.detail));
    event.pending.count = 0;
    event.last_line = now;
    ++event.lines;
  }
  std::erase_if(active_, [now](const ActiveEvent& event) {
    return event.pending.count == 0 && now - event.last_occurrence >= kRepeatIntervals.back();
  });
  return lines;
}

}  // namespace buoyancy::service
