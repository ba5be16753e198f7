// The two ways in which a question gets its answer over LCM.
//
//   LockstepAsker     one question at a time: the same bytes are sent again after each timeout until the
//                     answer with the question's (session_id, seq) is there. Whoever asks waits, so what the
//                     network loses or refuses costs time and changes no result.
//   FreeRunningAsker  one question per interval of wall-clock time, answered with the newest answer that has
//                     arrived before the interval is over: never waits longer, counts how late its answers
//                     are, and gives up when the service has been quiet for too long.
//
// What both promise: an answer holds as many bodies as its question, in the same order, and is valid until
// the next call. Errors of both: no answer in time, the transport's (in lock-step: when patience is over), an
// answer about other bodies than asked, stop raised while waiting.
#pragma once

#include <cstdint>
#include <deque>

#include "client/lcm_request_channel.h"
#include "messages/latency_histogram.h"

namespace buoyancy {

struct AskerStatistics {
  LatencyHistogram round_trip;  // s: from a question's first sending to its answer's arrival
  std::int64_t questions = 0;   // repeats not counted
  std::int64_t retries = 0;     // repeats
  std::int64_t lost = 0;        // questions that never got their answer
  std::int64_t late = 0;        // questions that were answered with the answer to an earlier one
  std::int64_t latest = 0;      // largest number of questions by which an answer was late
};

// A question is sent at most 1 + retries times, `timeout` apart.
struct Patience {
  double timeout = 0.1;       // s, > 0
  std::int64_t retries = 50;  // >= 0

  double total() const { return timeout * static_cast<double>(1 + retries); }  // s
};

class LockstepAsker {
 public:
  LockstepAsker(AnswerLink link, Patience patience);

  Expected<const Answer*> ask(const Question& question);
  const AskerStatistics& statistics() const { return statistics_; }

 private:
  AnswerLink link_;
  Patience patience_;
  AskerStatistics statistics_;
};

class FreeRunningAsker {
 public:
  // interval: s, > 0.
  FreeRunningAsker(AnswerLink link, Patience patience, double interval);

  // Waits for the question's turn, sends it and returns the newest answer when it is the question's own or
  // the interval is over. The first question is asked in lock-step, since there is nothing older to use.
  Expected<const Answer*> ask(const Question& question);
  AskerStatistics statistics() const;

 private:
  struct Sent {
    std::int64_t seq = 0;
    Clock::time_point at;
  };

  bool wait_for(std::int64_t seq, Clock::time_point deadline);

  AnswerLink link_;
  Patience patience_;
  Clock::duration interval_;
  Clock::time_point next_turn_;
  std::deque<Sent> unanswered_;    // ascending by seq, none older than the patience
  Clock::time_point quiet_since_;  // when the first question after the last arrival was sent
  bool quiet_ = false;             // a question was sent after the last arrival
  AskerStatistics statistics_;
};

}  // namespace buoyancy
