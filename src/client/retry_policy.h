// Sends one request over LCM, with retries, and checks its response: the part that LockstepClient and
// FreeRunningClient share.
//
// Contract of both clients: a response holds as many bodies as its request, in the same order, and is valid
// until the next call. Errors of both: no response in time, a failure of the transport (in lock-step mode
// only once the retries are used up), a response with other bodies than requested, cancellation while
// waiting.
#pragma once

#include <cstdint>

#include "client/client_stats.h"
#include "client/lcm_request_channel.h"

namespace buoyancy {

// A request is sent at most 1 + max_retries times, `timeout` apart.
struct RetryPolicy {
  double timeout = 0.1;           // [s], > 0
  std::int64_t max_retries = 50;  // >= 0

  double total_timeout() const { return timeout * static_cast<double>(1 + max_retries); }  // [s]
};

// Sends the request, and the same bytes again after each timeout, until its response arrives or the retries
// are used up. A failed sending counts as a lost request, since network interfaces may come back.
Expected<const WrenchResponse*> request_with_retries(LcmRequestChannel& channel, const WrenchRequest& request,
                                                     const RetryPolicy& retry_policy,
                                                     ClientStats& statistics);

// Returns the response, or an error if it does not hold the request's bodies in the request's order.
Expected<const WrenchResponse*> check_response(const LcmRequestChannel& channel, const WrenchRequest& request,
                                               const WrenchResponse& response);

// waited: time without a response [s].
tl::unexpected<Error> no_response_error(const LcmRequestChannel& channel, std::int64_t seq, double waited);
tl::unexpected<Error> cancelled_error(const LcmRequestChannel& channel, std::int64_t seq);

double to_seconds(Clock::duration duration);
Clock::duration to_duration(double seconds);

}  // namespace buoyancy
