// Finds out what a recording lacks: numbers (seq) of a session's messages that were never seen, in whatever
// order and however often the others came.
//
// A session counts from the first number that was seen. A lower one later belongs to a client that started
// over with the same session_id: it is ignored. Of more than kMaxSessions sessions the least recently used
// one is closed; what it lacks stays counted. While kMaxGaps gaps of a session are stored, further ones, and
// what a late message cuts off the end of a gap, are only counted: messages that arrive late for them stay
// counted as missing.
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

  // O(log(sessions) + log(gaps)), and O(sessions) when a session is closed.
  void add(std::int64_t session_id, std::int64_t seq);

  // Returns whether the number was not seen, though lower and higher ones of this session were.
  // O(log(sessions) + log(gaps)).
  bool is_missing(std::int64_t session_id, std::int64_t seq) const;

  // Returns how many numbers all sessions together lack; at most the largest std::int64_t.
  std::int64_t missing() const { return missing_; }

  struct Gap {
    std::int64_t first = 0;  // both are missing, and all between them
    std::int64_t last = 0;
  };
  struct Session {
    std::int64_t session_id = 0;
    std::vector<Gap> gaps;  // ascending
  };
  // Returns the sessions that lack something and are not closed, ascending by session_id.
  std::vector<Session> incomplete_sessions() const;

 private:
  struct State {
    std::int64_t first = 0;
    std::int64_t newest = 0;
    std::uint64_t used = 0;                     // clock_ at its last use
    std::map<std::int64_t, std::int64_t> gaps;  // first to last
  };

  void fill(State& session, std::int64_t seq);

  std::map<std::int64_t, State> sessions_;
  std::uint64_t clock_ = 0;
  std::int64_t missing_ = 0;
};

// Returns a line for each session that lacks something, with its first gaps: "session 5: 3 requests missing,
// seq 17, 20 to 21". what: the kind of message, "requests".
std::vector<std::string> gap_lines(const SequenceGaps& gaps, const std::string& what);

}  // namespace buoyancy
