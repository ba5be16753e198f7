// The two ways in which a request gets its response over LCM.
//
//   LockstepClient     one request at a time: the same bytes are sent again after each timeout until the
//                     answer with the request's (session_id, seq) is there. Whoever asks waits, so what the
//                     network loses or refuses costs time and changes no result.
//   FreeRunningClient  one request per interval of wall-clock time, answered with the newest response that
//   has
//                     arrived before the interval is over: never waits longer, counts how late its responses
//                     are, and gives up when the service has been quiet for too long.
//
// What both promise: a response holds as many bodies as its request, in the same order, and is valid until
// the next call. Errors of both: no response in time, the transport's (in lock-step: when retry_policy is
// over), an answer about other bodies than asked, stop raised while waiting.
#pragma once

#include <cstdint>
#include <deque>

#include "client/lcm_request_channel.h"
#include "messages/latency_histogram.h"

namespace buoyancy {

struct ClientStats {
  LatencyHistogram round_trip;  // s: from a request's first sending to its response's arrival
  std::int64_t requests = 0;    // repeats not counted
  std::int64_t retries = 0;     // repeats
  std::int64_t unanswered = 0;  // requests that never got their response
  std::int64_t late = 0;        // requests that were answered with the response to an earlier one
  std::int64_t max_lag = 0;     // largest number of requests by which a response was late
};

// A request is sent at most 1 + retries times, `timeout` apart.
struct RetryPolicy {
  double timeout = 0.1;           // s, > 0
  std::int64_t max_retries = 50;  // >= 0

  double total_timeout() const { return timeout * static_cast<double>(1 + max_retries); }  // s
};

class LockstepClient {
 public:
  LockstepClient(LcmRequestChannel channel, RetryPolicy retry_policy);

  Expected<const WrenchResponse*> request(const WrenchRequest& request);
  const ClientStats& statistics() const { return statistics_; }

 private:
  LcmRequestChannel channel_;
  RetryPolicy retry_policy_;
  ClientStats statistics_;
};

class FreeRunningClient {
 public:
  // interval: s, > 0.
  FreeRunningClient(LcmRequestChannel channel, RetryPolicy retry_policy, double interval);

  // Waits for the request's turn, sends it and returns the newest response when it is the request's own or
  // the interval is over. The first request is asked in lock-step, since there is nothing older to use.
  Expected<const WrenchResponse*> request(const WrenchRequest& request);
  ClientStats statistics() const;

 private:
  struct Sent {
    std::int64_t seq = 0;
    Clock::time_point at;
  };

  bool wait_for(std::int64_t seq, Clock::time_point deadline);

  LcmRequestChannel channel_;
  RetryPolicy retry_policy_;
  Clock::duration interval_;
  Clock::time_point next_turn_;
  std::deque<Sent> unanswered_;    // ascending by seq, none older than the retry_policy
  Clock::time_point quiet_since_;  // when the first request after the last arrival was sent
  bool quiet_ = false;             // a request was sent after the last arrival
  ClientStats statistics_;
};

}  // namespace buoyancy
