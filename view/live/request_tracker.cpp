#include "view/live/request_tracker.h"

#include <algorithm>

namespace buoyancy {

bool RequestTracker::on_request(const RequestId& key, std::int64_t utime, double now, Seq seq) {
  const Key request{key.session_id, key.seq};
  const bool is_new = note_in_session(key, now, seq);
  if (requests_.contains(request)) {
    ++counts_.requests_repeated;
    return false;
  }
  if (requests_.size() == kMaxPending) forget_oldest();
  requests_.emplace(request, CachedResult{utime, now, false});
  order_.push_back(request);
  ++(is_new ? counts_.requests : counts_.requests_repeated);
  return is_new;
}

bool RequestTracker::note_in_session(const RequestId& key, double now, Seq seq) {
  const auto found = sessions_.find(key.session_id);
  if (found == sessions_.end()) {
    if (sessions_.size() == kMaxSessions) {
      sessions_.erase(
          std::ranges::min_element(sessions_, {}, [](const auto& session) { return session.second.heard; }));
    }
    sessions_.emplace(key.session_id, Session{key.seq, now});
    ++counts_.sessions;
    return true;
  }
  Session& session = found->second;
  session.heard = now;
  // Without a sign: the distance of any two numbers is one.
  const std::uint64_t ahead =
      static_cast<std::uint64_t>(key.seq) - static_cast<std::uint64_t>(session.newest_seq);
  const bool is_repeat = ahead == 0;
  if (seq == Seq::kConsecutive && key.seq > session.newest_seq && ahead <= kMaxSeqGap) {
    counts_.requests_missed += static_cast<std::int64_t>(ahead) - 1;
  }
  session.newest_seq = key.seq;
  return !is_repeat;
}

std::optional<double> RequestTracker::on_response(const RequestId& key, std::int64_t utime) {
  const auto found = requests_.find({key.session_id, key.seq});
  if (found == requests_.end()) {
    ++counts_.responses_without_request;
    return std::nullopt;
  }
  CachedResult& request = found->second;
  if (request.answered) {
    ++counts_.responses_repeated;
    return std::nullopt;
  }
  request.answered = true;
  ++counts_.responses;
  constexpr double kSecondsPerMicrosecond = 1e-6;
  return kSecondsPerMicrosecond * static_cast<double>(std::max<std::int64_t>(utime - request.utime, 0));
}

void RequestTracker::expire(double now) {
  while (!order_.empty() && requests_.at(order_.front()).heard + kPatience < now) forget_oldest();
}

void RequestTracker::forget_oldest() {
  const auto oldest = requests_.find(order_.front());
  if (!oldest->second.answered) ++counts_.unanswered;
  requests_.erase(oldest);
  order_.pop_front();
}

}  // namespace buoyancy
