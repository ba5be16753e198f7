#include "recording/sequence_gaps.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "base/format.h"

namespace buoyancy {
namespace {

constexpr std::size_t kGapsPerLine = 8;

std::int64_t saturated_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  return __builtin_add_overflow(a, b, &sum) ? std::numeric_limits<std::int64_t>::max() : sum;
}

// Returns the number of integers from first to last.
std::int64_t length(std::int64_t first, std::int64_t last) {
  std::int64_t difference = 0;
  if (__builtin_sub_overflow(last, first, &difference)) return std::numeric_limits<std::int64_t>::max();
  return saturated_sum(difference, 1);
}

}  // namespace

void SequenceGaps::add(std::int64_t session_id, std::int64_t seq) {
  const auto [found, is_new] = sessions_.try_emplace(session_id);
  State& session = found->second;
  session.used = ++clock_;
  if (is_new) {
    session.first = seq;
    session.newest = seq;
    if (sessions_.size() > kMaxSessions) {
      sessions_.erase(
          std::ranges::min_element(sessions_, {}, [](const auto& entry) { return entry.second.used; }));
    }
    return;
  }
  if (seq <= session.newest) {
    if (seq >= session.first) fill(session, seq);
    return;
  }
  if (seq - 1 > session.newest) {
    missing_ = saturated_sum(missing_, length(session.newest + 1, seq - 1));
    if (session.gaps.size() < kMaxGaps) session.gaps.emplace(session.newest + 1, seq - 1);
  }
  session.newest = seq;
}

void SequenceGaps::fill(State& session, std::int64_t seq) {
  auto gap = session.gaps.upper_bound(seq);
  if (gap == session.gaps.begin()) return;
  --gap;
  const auto [first, last] = *gap;
  if (seq > last) return;
  session.gaps.erase(gap);
  if (first < seq) session.gaps.emplace(first, seq - 1);
  if (seq < last && session.gaps.size() < kMaxGaps) session.gaps.emplace(seq + 1, last);
  --missing_;
}

bool SequenceGaps::is_missing(std::int64_t session_id, std::int64_t seq) const {
  const auto session = sessions_.find(session_id);
  if (session == sessions_.end()) return false;
  const std::map<std::int64_t, std::int64_t>& gaps = session->second.gaps;
  const auto gap = gaps.upper_bound(seq);
  return gap != gaps.begin() && seq <= std::prev(gap)->second;
}

std::vector<SequenceGaps::Session> SequenceGaps::incomplete_sessions() const {
  std::vector<Session> incomplete;
  for (const auto& [session_id, state] : sessions_) {
    if (state.gaps.empty()) continue;
    Session& session = incomplete.emplace_back(Session{session_id, {}});
    for (const auto& [first, last] : state.gaps) session.gaps.push_back({first, last});
  }
  return incomplete;
}

std::vector<std::string> gap_lines(const SequenceGaps& gaps, const std::string& what) {
  std::vector<std::string> lines;
  for (const SequenceGaps::Session& session : gaps.incomplete_sessions()) {
    std::int64_t missing = 0;
    std::string places;
    for (std::size_t i = 0; i < session.gaps.size(); ++i) {
      const auto [first, last] = session.gaps[i];
      missing = saturated_sum(missing, length(first, last));
      if (i < kGapsPerLine) {
        places += (i == 0 ? " seq " : ", ") + std::to_string(first);
        if (last > first) places += " to " + std::to_string(last);
      }
    }
    const std::size_t more = session.gaps.size() - std::min(session.gaps.size(), kGapsPerLine);
    if (more > 0) places += " and " + std::to_string(more) + " more gaps";
    lines.push_back(format_text("session {}: {} {} missing,{}", session.session_id, missing, what, places));
  }
  return lines;
}

}  // namespace buoyancy
