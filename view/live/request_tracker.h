// Matches responses to requests that an observer receives on the bus: pairs them by (session_id, seq),
// measures the time between them, and counts those without a partner.
//
// A request is tracked for kTimeout after its first arrival. At most kMaxPending are tracked; beyond that the
// oldest is dropped early. A session is tracked only for its latest seq; of more than kMaxSessions the one
// that was inactive longest is dropped. Memory is therefore bounded whatever arrives. O(1), except for a new
// session beyond kMaxSessions: O(kMaxSessions).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <unordered_map>

#include "messages/request.h"

namespace buoyancy::view {

enum class SeqPolicy {
  kConsecutive,  // seq increases by one with each request of a session: a gap is a loss
  kArbitrary,    // gaps have no meaning
};

class RequestTracker {
 public:
  static constexpr double kTimeout = 2.0;  // [s]
  static constexpr std::size_t kMaxPending = 16'384;
  static constexpr std::size_t kMaxSessions = 256;
  static constexpr std::uint64_t kMaxSeqGap = 1'000'000;  // a larger jump of seq is a restart, not a loss

  struct Counts {
    std::int64_t requests = 0;            // distinct requests
    std::int64_t requests_repeated = 0;   // repeats of these
    std::int64_t responses = 0;           // first responses to a request
    std::int64_t responses_repeated = 0;  // further responses to it
    std::int64_t responses_without_request =
        0;                             // the request was not observed, or more than kTimeout earlier
    std::int64_t unanswered = 0;       // requests dropped without a response
    std::int64_t requests_missed = 0;  // numbers skipped between two requests of a session
    std::int64_t sessions = 0;         // started
  };

  // utime: arrival [us since 1970]; now: arrival on a monotonic clock [s]. Returns false for a repeat.
  bool on_request(const RequestId& id, std::int64_t utime, double now,
                  SeqPolicy policy = SeqPolicy::kConsecutive);
  bool contains(const RequestId& id) const { return requests_.contains({id.session_id, id.seq}); }

  // Returns the time [s] from the first arrival of the request to its first response, 0 if the clock went
  // back. nullopt: no such request is pending.
  std::optional<double> on_response(const RequestId& id, std::int64_t utime);

  // Drops the requests that are older than kTimeout.
  void expire(double now);

  const Counts& counts() const { return counts_; }
  std::size_t size() const { return requests_.size(); }

 private:
  struct Key {
    std::int64_t session_id, seq;
    bool operator==(const Key&) const = default;
  };
  struct HashKey {
    std::size_t operator()(const Key& key) const {
      return std::hash<std::int64_t>()(key.session_id) * 31 + std::hash<std::int64_t>()(key.seq);
    }
  };
  struct TrackedRequest {
    std::int64_t utime;
    double received;
    bool has_response;
  };
  struct Session {
    std::int64_t latest_seq;
    double last_active;
  };

  // Returns false if id repeats the latest request of its session.
  bool update_session(const RequestId& id, double now, SeqPolicy policy);
  void drop_oldest();

  std::unordered_map<Key, TrackedRequest, HashKey> requests_;
  std::deque<Key> order_;  // keys of requests_, the oldest first
  std::unordered_map<std::int64_t, Session> sessions_;
  Counts counts_;
};

}  // namespace buoyancy::view
