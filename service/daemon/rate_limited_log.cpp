#include "service/daemon/rate_limited_log.h"

#include <algorithm>
#include <utility>

#include <spdlog/fmt/fmt.h>

namespace buoyancy {

void TroubleLog::add(const Trouble& trouble, double now) {
  if (trouble.count == 0) return;
  auto known = std::ranges::find(lasting_, trouble.what, [](const Lasting& one) { return one.unsaid.what; });
  if (known == lasting_.end())
    known = lasting_.insert(known, Lasting{.unsaid = {.what = trouble.what, .count = 0, .detail = {}}});
  known->unsaid.count += trouble.count;
  known->unsaid.detail = trouble.detail;
  known->last_occurrence = now;
}

std::vector<std::string> TroubleLog::take(double now) {
  std::vector<std::string> lines;
  for (Lasting& one : lasting_) {
    const std::size_t interval = std::min(std::max<std::size_t>(one.lines, 1), kTroubleIntervals.size()) - 1;
    const double since = now - one.last_line;
    const bool due = one.lines == 0 || since >= kTroubleIntervals[interval];
    if (one.unsaid.count == 0 || !due) continue;
    lines.push_back(fmt::format("{}: {}{}{}{}", one.unsaid.what, one.unsaid.count,
                                one.lines == 0 ? "" : fmt::format(" in {:.0f} s", since),
                                one.unsaid.detail.empty() ? "" : "; ", one.unsaid.detail));
    one.unsaid.count = 0;
    one.last_line = now;
    ++one.lines;
  }
  std::erase_if(lasting_, [now](const Lasting& one) {
    return one.unsaid.count == 0 && now - one.last_occurrence >= kTroubleIntervals.back();
  });
  return lines;
}

}  // namespace buoyancy
