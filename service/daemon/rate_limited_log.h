// Keeps a trouble that lasts from filling the log: it is said at once, then with the number of its
// occurrences since, at intervals that grow.
//
// The law, per trouble: what occurs for the first time is said by the next take(). What occurs after the n-th
// line is said by the first take() that is at least the n-th of kRepeatIntervals after it, the last of them
// from then on. A trouble that has not occurred for the longest interval, all of it said, is forgotten: it
// starts afresh. A trouble of a day comes to less than 150 lines.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace buoyancy {

inline constexpr std::array<double, 4> kRepeatIntervals{1.0, 10.0, 60.0, 600.0};  // s

struct LogEvent {
  std::string what;        // names it: equal for all that is counted together; few different ones
  std::int64_t count = 0;  // of occurrences
  std::string detail;      // of the newest occurrence; empty: what says it all
};

class RateLimitedLog {
 public:
  // count of 0: nothing happened.
  void add(const LogEvent& warning, double now);

  // The lines that are due: "what: 12; detail", later "what: 3400 in 60 s; detail". now: s, of any
  // clock that does not go back; the same as add()'s.
  std::vector<std::string> drain(double now);

 private:
  struct ActiveEvent {
    LogEvent pending;
    std::size_t lines = 0;  // said so far
    double last_line = 0.0;
    double last_occurrence = 0.0;
  };
  std::vector<ActiveEvent> lasting_;
};

}  // namespace buoyancy
