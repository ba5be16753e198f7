#include "service/daemon/latest_request_queue.h"

#include <algorithm>
#include <cassert>

namespace buoyancy::service {

bool supersedes(std::int64_t later, std::int64_t earlier) {
  if (later >= earlier) return true;
  // The difference of two int64 may overflow an int64, so it is computed unsigned.
  return static_cast<std::uint64_t>(earlier) - static_cast<std::uint64_t>(later) > kRestartGap;
}

LatestRequestQueue::LatestRequestQueue(std::size_t max_sessions, std::size_t max_bytes)
    : max_sessions_(max_sessions), max_bytes_(max_bytes) {
  assert(max_sessions >= 1);
  sessions_.reserve(max_sessions);
  pending_.reserve(max_sessions);
}

LatestRequestQueue::PushResult LatestRequestQueue::push(const RequestHeader& header, Bytes request,
                                                        double arrival) {
  const RequestId& id = header.id;
  Session* session = find(header.session());
  if (session != nullptr && !supersedes(id.seq, session->newest_seq) &&
      arrival <= session->arrival + kRestartIdleTime) {
    return PushResult::kStale;
  }
  if (session == nullptr) session = claim_session();
  if (session == nullptr || !make_room(*session, request.size())) return PushResult::kFull;
  const std::size_t before = session->request.capacity();
  session->request.assign(request.begin(), request.end());
  allocated_ += session->request.capacity() - before;

  const bool replaces = session->pending;
  if (!replaces) pending_.push_back(static_cast<std::size_t>(session - sessions_.data()));
  session->key = header.session();
  session->newest_seq = id.seq;
  session->pending = true;
  session->arrival = arrival;
  session->last_use = ++use_;
  return replaces ? PushResult::kReplaced : PushResult::kQueued;
}

LatestRequestQueue::Session* LatestRequestQueue::find(const SessionKey& key) {
  const auto found = std::ranges::find(sessions_, key, &Session::key);
  return found == sessions_.end() ? nullptr : &*found;
}

LatestRequestQueue::Session* LatestRequestQueue::claim_session() {
  if (sessions_.size() < max_sessions_) return &sessions_.emplace_back();
  Session* oldest = nullptr;
  for (Session& session : sessions_) {
    if (!session.pending && (oldest == nullptr || session.last_use < oldest->last_use)) oldest = &session;
  }
  return oldest;
}

bool LatestRequestQueue::make_room(Session& session, std::size_t bytes) {
  const std::size_t needed = std::max(session.request.capacity(), bytes) - session.request.capacity();
  for (Session& each : sessions_) {
    if (allocated_ + needed <= max_bytes_) return true;
    if (each.pending || &each == &session) continue;
    allocated_ -= each.request.capacity();
    each.request = std::vector<std::uint8_t>();  // {} would keep the memory
  }
  return allocated_ + needed <= max_bytes_;
}

}  // namespace buoyancy::service
