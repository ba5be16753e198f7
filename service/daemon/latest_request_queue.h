// The queue of mode latest: the newest pending request of every session, and nothing else.
//
// Rules, per session: a request is newer than an earlier arrival if its seq is not lower. A restarted client
// counts from the beginning, so a request is also newer if its seq is lower by more than kRestartGap, or if
// it arrives more than kRestartIdleTime after the other. Any other request with a lower seq was reordered by
// the network and is stale. A newer request replaces the pending one and takes its place in the queue:
// otherwise a client that sends faster than it is served would never get a response.
//
// Memory is bounded: pending requests and the buffers that popped ones leave take at most max_bytes together.
// If all places are taken, the least recently used session without a pending request is evicted; only its
// newest seq is lost, by which stale requests are recognised.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "messages/wire.h"

namespace buoyancy::service {

inline constexpr std::uint64_t kRestartGap = 64;
inline constexpr double kRestartIdleTime = 0.2;  // [s]

// Is a request with seq `later` newer than one with seq `earlier` that arrived before it, by seq alone?
bool supersedes(std::int64_t later, std::int64_t earlier);

class LatestRequestQueue {
 public:
  enum class PushResult {
    kQueued,    // queued; its session had no pending request
    kReplaced,  // queued in the place of an older request of its session
    kStale,     // dropped: a newer request of its session is pending or was popped
    kFull,      // dropped: max_sessions or max_bytes are pending; pop one and push again
  };

  LatestRequestQueue(std::size_t max_sessions, std::size_t max_bytes);  // >= 1; [bytes]

  // Does not allocate once the session's buffer is as large as its largest message. arrival: [s], of any
  // monotonic clock; pop_next() returns it with the request.
  PushResult push(const RequestHeader& header, Bytes request, double arrival);

  // Removes the request that has waited longest of the sessions with may_handle(const SessionKey&), and
  // calls handle(Bytes request, double arrival), which must not call push(). False: there is none.
  template <typename Predicate, typename Handler>
  bool pop_next(Predicate&& may_handle, Handler&& handle);

  bool empty() const { return pending_.empty(); }

 private:
  struct Session {
    SessionKey key{0};
    std::int64_t newest_seq = 0;  // of the pending request, or of the last one popped
    bool pending = false;
    double arrival = 0.0;  // of the same request [s]
    std::uint64_t last_use = 0;
    std::vector<std::uint8_t> request;
  };

  Session* find(const SessionKey& key);
  Session* claim_session();  // an unused or evicted one; nullptr: every session has a pending request

  // Frees the buffers that popped requests left until there is room. False: there is none.
  bool make_room(Session& session, std::size_t bytes);

  std::size_t max_sessions_;
  std::size_t max_bytes_;
  std::size_t allocated_ = 0;  // by all sessions [bytes]
  std::vector<Session> sessions_;
  std::vector<std::size_t> pending_;  // indices into sessions_; the first has waited longest
  std::uint64_t use_ = 0;
};

template <typename Predicate, typename Handler>
bool LatestRequestQueue::pop_next(Predicate&& may_handle, Handler&& handle) {
  const auto next =
      std::ranges::find_if(pending_, [&](std::size_t index) { return may_handle(sessions_[index].key); });
  if (next == pending_.end()) return false;
  Session& session = sessions_[*next];
  pending_.erase(next);
  session.pending = false;
  handle(Bytes(session.request), session.arrival);
  return true;
}

}  // namespace buoyancy::service
