// Limits the rate of repeated warnings: an event is logged at once, then at growing intervals with the number
// of its occurrences since the last line.
//
// Contract, per event: the first occurrence is returned by the next drain(). Occurrences after the n-th line
// are returned by the first drain() at least kRepeatIntervals[n - 1] after that line; the last interval
// repeats. An event with nothing pending that has not occurred for the longest interval is removed, so that
// its next occurrence counts as the first. An event that lasts a day produces fewer than 150 lines.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace buoyancy::service {

inline constexpr std::array<double, 4> kRepeatIntervals{1.0, 10.0, 60.0, 600.0};  // [s]

struct LogEvent {
  std::string message;     // identifies the event: occurrences with equal messages are counted together
  std::int64_t count = 0;  // occurrences
  std::string detail;      // of the newest occurrence; may be empty
};

class RateLimitedLog {
 public:
  // An event with count 0 is ignored. now: [s], of any monotonic clock, the same for drain(). The number of
  // different messages must be small: each takes memory until it is removed.
  void add(const LogEvent& event, double now);

  // The lines that are due: "message: 12; detail", later "message: 3400 in 60 s; detail".
  std::vector<std::string> drain(double now);

 private:
  struct ActiveEvent {
    LogEvent pending;
    std::size_t lines = 0;  // logged so far
    double last_line = 0.0;
    double last_occurrence = 0.0;
  };
  std::vector<ActiveEvent> active_;
};

}  // namespace buoyancy::service
