// A replay's answers beside those of an earlier one: what changed since then, body by body.
//
// Every answer says how far it can be from the truth. Two right ones are never farther from each other than
// both bounds together; so that is what a difference is held to, and no tolerance has to be chosen.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>

#include "geometry/error.h"
#include "messages/question.h"
#include "messages/wire.h"
#include "recording/event_log.h"

namespace buoyancy {

// The largest differences of one body.
struct BodyDifferences {
  std::int64_t answers = 0;         // compared
  std::int64_t status_changes = 0;  // of them, where one is OK and the other is not, or not in the same way
  double force = 0.0;               // N
  double torque = 0.0;              // N m
  double volume = 0.0;              // m^3
  double force_in_bounds = 0.0;     // difference over the sum of both bounds: at most 1 where both are right
  double torque_in_bounds = 0.0;
  std::int64_t worst_utime = 0;  // us: of the answer with the largest of these two

  bool within_bounds() const {
    return status_changes == 0 && force_in_bounds <= 1.0 && torque_in_bounds <= 1.0;
  }
};

class Comparison {
 public:
  // earlier: an LCM log with body_wrenches_t on wrenches_channel. Errors: not readable.
  static Expected<Comparison> open(const std::filesystem::path& earlier, const std::string& wrenches_channel);

  // The replay's next answer: bytes of a body_wrenches_t. Its counterpart has the same utime, session_id and
  // seq, and is looked for among the earlier log's next kReach answers.
  void take(Bytes answer);
  // After the last one.
  void finish();

  const std::map<std::int32_t, BodyDifferences>& bodies() const { return bodies_; }  // by id
  std::int64_t only_now() const { return only_now_; }          // answers without counterpart
  std::int64_t only_earlier() const { return only_earlier_; }  // likewise, of the earlier log
  std::int64_t unreadable() const { return unreadable_; }      // places and messages of the earlier log
  // Nothing lost, nothing new, and no body beyond its bounds.
  bool agrees() const;

 private:
  static constexpr std::size_t kReach = 4096;

  explicit Comparison(EventLogReader earlier) : earlier_(std::move(earlier)) {}
  bool read_one();  // into ahead_; false: the log has ended
  void compare(const Answer& now, const Answer& earlier);

  EventLogReader earlier_;
  std::deque<Answer> ahead_;  // read, not yet matched; at most kReach
  Answer now_;                // reused
  std::map<std::int32_t, BodyDifferences> bodies_;
  std::int64_t only_now_ = 0;
  std::int64_t only_earlier_ = 0;
  std::int64_t unreadable_ = 0;
};

}  // namespace buoyancy
