// Mode latest: of every session the newest request that waits, and nothing else.
//
// The law, per session: a request with a seq at least as high as another's is newer (of equals the last to
// arrive). A client that starts over counts from the beginning: so is one whose seq is lower by more than
// kRestartGap, or that comes more than kRestartIdleTime after the other. What is lower by less and comes
// sooner was overtaken on the way and is stale. What waits when a newer one arrives is overtaken, and the
// newer one takes its place in the line: whoever asks fastest would else never be answered.
//
// Memory is bounded: by max_sessions times the largest message. Of sessions with nothing waiting the least
// recently used is forgotten, which costs only the knowledge of what would be stale.
#pragma once

#include <cstdint>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

inline constexpr std::uint64_t kRestartGap = 64;
inline constexpr double kRestartIdleTime = 0.2;  // s

// Is a request with seq `later`, which arrived after one with seq `earlier`, to be preferred to it?
bool supersedes(std::int64_t later, std::int64_t earlier);

class LatestRequestQueue {
 public:
  enum class PushResult {
    kQueued,    // nothing of its session waited
    kReplaced,  // waits, in the place of an older one of its session
    kStale,     // not kept: a newer one of its session waits or was taken
    kFull,      // not kept: a request waits in each of max_sessions sessions; take one and push it again
  };

  explicit LatestRequestQueue(std::size_t max_sessions);  // >= 1

  // No heap once the session's buffer is as large as its largest message. arrival: seconds, on any clock; it
  // comes back with the request.
  PushResult push(const RequestId& key, Bytes request, double arrival);

  // Hands the request of the session that has waited longest to answer(Bytes request, double arrival); it
  // waits no longer. False: none waited. answer must not call push.
  template <typename Handler>
  bool pop_next(Handler&& handle);

  bool empty() const { return waiting_.empty(); }

 private:
  struct Session {
    std::int64_t id = 0;
    std::int64_t newest_seq = 0;  // of what waits, or else of what was taken last
    bool waits = false;
    double arrival = 0.0;  // of the same
    std::uint64_t last_use = 0;
    std::vector<std::uint8_t> request;
  };

  Session* find(std::int64_t id);
  Session* place_for_new();

  std::size_t max_sessions_;
  std::vector<Session> sessions_;
  std::vector<std::size_t> waiting_;  // indices into sessions_; the first has waited longest
  std::uint64_t use_ = 0;
};

template <typename Handler>
bool LatestRequestQueue::pop_next(Handler&& handle) {
  if (waiting_.empty()) return false;
  Session& session = sessions_[waiting_.front()];
  waiting_.erase(waiting_.begin());
  session.waits = false;
  handle(Bytes(session.request), session.arrival);
  return true;
}

}  // namespace buoyancy
