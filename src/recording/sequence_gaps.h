// Finds out what a recording lacks: numbers (seq) of a session's messages that were never seen, in whatever
// order and however often the others came.
//
// A session counts from the first number that was seen. A lower one later belongs to a client that started
// over with the same session_id: it is ignored. Memory is bounded: of more than kMaxSessions sessions the
// least recently used is closed, and what it lacks stays counted; after kMaxGaps gaps of a session, a message
// that comes late is no longer found among the missing ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace buoyancy {

class SequenceGaps {
 public:
  static constexpr std::size_t kMaxSessions = 1024;
  static constexpr std::size_t kMaxGaps = 4096;

  // O(log(sessions) + log(gaps)); the longest of both is a scan of all sessions, when one is closed.
  void add(std::int64_t session_id, std::int64_t seq);

  // Whether the number was not seen, though lower and higher ones of this session were. O(log(sessions) +
  // log(gaps)).
  bool is_missing(std::int64_t session_id, std::int64_t seq) const;

  // Of all sessions; at most the largest std::int64_t.
  std::int64_t missing() const { return missing_; }

  struct Gap {
    std::int64_t first = 0;  // both are missing, and all between them
    std::int64_t last = 0;
  };
  struct Session {
    std::int64_t session_id = 0;
    std::vector<Gap> gaps;  // ascending
  };
  // The sessions that lack something, by session_id.
  std::vector<Session> incomplete_sessions() const;

 private:
  struct State {
    std::int64_t first = 0;
    std::int64_t newest = 0;
    std::uint64_t used = 0;                     // when
    std::map<std::int64_t, std::int64_t> gaps;  // first to last
  };

  void fill(State& session, std::int64_t seq);

  std::map<std::int64_t, State> sessions_;
  std::uint64_t clock_ = 0;
  std::int64_t missing_ = 0;
};

// "session 5: 3 missing, 17, 20 to 21": a line for each session that lacks something, with its first gaps;
// what: the kind of message, "requests".
std::vector<std::string> gap_lines(const SequenceGaps& gaps, const std::string& what);

}  // namespace buoyancy
