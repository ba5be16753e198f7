// Which answer belongs to which request, as somebody sees it who hears both pass by: pairs them by
// (session_id, seq), tells the time between them, and counts what has no partner.
//
// A request is remembered for kPatience after it was heard first, and no more than kMaxPending are: the
// oldest goes first, given up early. Sessions are remembered for the sake of their newest seq alone; the
// least recently heard of more than kMaxSessions goes. So memory is bounded whatever arrives. O(1), but for
// a new session once all places are taken: O(kMaxSessions).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <unordered_map>

#include "messages/request.h"

namespace buoyancy {

class RequestTracker {
 public:
  static constexpr double kPatience = 2.0;  // s
  static constexpr std::size_t kMaxPending = 16'384;
  static constexpr std::size_t kMaxSessions = 256;
  static constexpr std::uint64_t kMaxSeqGap = 1'000'000;  // beyond it a seq is a new beginning, not a loss

  struct Counts {
    std::int64_t requests = 0;                   // each once, however often it was heard
    std::int64_t requests_repeated = 0;          // heard again
    std::int64_t responses = 0;                  // the first to a request
    std::int64_t responses_repeated = 0;         // any further one
    std::int64_t responses_without_request = 0;  // its request was not heard, or longer ago than kPatience
    std::int64_t unanswered = 0;                 // requests given up
    std::int64_t requests_missed = 0;            // numbers left out between two requests of a session
    std::int64_t sessions = 0;                   // begun
  };

  // What seq is: counted up by one with each request of a session, so that a gap is a loss; or any number.
  enum class Seq { kConsecutive, kArbitrary };

  // utime: us since 1970, when it arrived; now: s of a clock that never jumps, for kPatience. False: a
  // repeat.
  bool on_request(const RequestId& key, std::int64_t utime, double now, Seq seq = Seq::kConsecutive);
  bool remembers(const RequestId& key) const { return requests_.contains({key.session_id, key.seq}); }

  // s: between the first hearing of its request and this first response to it; 0 where the clock went back.
  // nullopt: no such request is waiting.
  std::optional<double> on_response(const RequestId& key, std::int64_t utime);

  void expire(double now);

  const Counts& counts() const { return counts_; }
  std::size_t remembered() const { return requests_.size(); }

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
  struct CachedResult {
    std::int64_t utime;
    double heard;
    bool answered;
  };
  struct Session {
    std::int64_t newest_seq;
    double heard;
  };

  bool note_in_session(const RequestId& key, double now, Seq seq);  // false: heard before
  void forget_oldest();

  std::unordered_map<Key, CachedResult, HashKey> requests_;
  std::deque<Key> order_;  // of questions_, the oldest in front
  std::unordered_map<std::int64_t, Session> sessions_;
  Counts counts_;
};

}  // namespace buoyancy
