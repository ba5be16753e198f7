#include "view/live/request_tracker.h"

#include <algorithm>

namespace buoyancy::view {

bool RequestTracker::on_request(const RequestId& id, std::int64_t utime, double now, SeqPolicy policy) {
  const Key request{id.session_id, id.seq};
  const bool is_new = update_session(id, now, policy);
  if (requests_.contains(request)) {
    ++counts_.requests_repeated;
    return false;
  }
  if (requests_.size() == kMaxPending) drop_oldest();
  requests_.emplace(request, TrackedRequest{utime, now, false});
  order_.push_back(request);
  ++(is_new ? counts_.requests : counts_.requests_repeated);
  return is_new;
}

bool RequestTracker::update_session(const RequestId& id, double now, SeqPolicy policy) {
  const auto found = sessions_.find(id.session_id);
  if (found == sessions_.end()) {
    if (sessions_.size() == kMaxSessions) {
      sessions_.erase(std::ranges::min_element(
          sessions_, {}, [](const auto& session) { return session.second.last_active; }));
    }
    sessions_.emplace(id.session_id, Session{id.seq, now});
    ++counts_.sessions;
    return true;
  }
  Session& session = found->second;
  session.last_active = now;
  // Unsigned, so that the distance of any two numbers is representable.
  const std::uint64_t ahead =
      static_cast<std::uint64_t>(id.seq) - static_cast<std::uint64_t>(session.latest_seq);
  const bool is_repeat = ahead == 0;
  if (policy == SeqPolicy::kConsecutive && id.seq > session.latest_seq && ahead <= kMaxSeqGap) {
    counts_.requests_missed += static_cast<std::int64_t>(ahead) - 1;
  }
  session.latest_seq = id.seq;
  return !is_repeat;
}

std::optional<double> RequestTracker::on_response(const RequestId& id, std::int64_t utime) {
  const auto found = requests_.find({id.session_id, id.seq});
  if (found == requests_.end()) {
    ++counts_.responses_without_request;
    return std::nullopt;
  }
  TrackedRequest& request = found->second;
  if (request.has_response) {
    ++counts_.responses_repeated;
    return std::nullopt;
  }
  request.has_response = true;
  ++counts_.responses;
  constexpr double kSecondsPerMicrosecond = 1e-6;
  return kSecondsPerMicrosecond * static_cast<double>(std::max<std::int64_t>(utime - request.utime, 0));
}

void RequestTracker::expire(double now) {
  while (!order_.empty() && requests_.at(order_.front()).received + kTimeout < now) drop_oldest();
}

void RequestTracker::drop_oldest() {
  const auto oldest = requests_.find(order_.front());
  if (!oldest->second.has_response) ++counts_.unanswered;
  requests_.erase(oldest);
  order_.pop_front();
}

}  // namespace buoyancy::view
