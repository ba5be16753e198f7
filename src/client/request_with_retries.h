// Sends one request over LCM, with retries, and checks its response: the part that LockstepClient and
// FreeRunningClient share. Contract and errors: see retry_policy.h.
#pragma once

#include <cstdint>

#include "client/client_stats.h"
#include "client/lcm_request_channel.h"
#include "client/retry_policy.h"

namespace buoyancy {

// Sends the request, and the same bytes again after each timeout, until its response arrives or the retries
// are used up. A response without a sea for the request's time (NO_SEA) is returned only then, since the sea
// may be on its way. A failed sending counts as a lost request, since network interfaces may come back.
Expected<const WrenchResponse*> request_with_retries(LcmRequestChannel& channel,
                                                     const BorrowedRequest& request,
                                                     const RetryPolicy& retry_policy,
                                                     ClientStats& statistics);

// The same for the water at points. Errors: those of retry_policy.h, with other points than requested in the
// place of other bodies.
Expected<const WaterSamples*> sample_water_with_retries(LcmRequestChannel& channel,
                                                        const BorrowedWaterPoints& request,
                                                        const RetryPolicy& retry_policy,
                                                        ClientStats& statistics);

// Returns the response, or an error if it does not hold the request's bodies in the request's order, or if
// its loads hold other bodies.
Expected<const WrenchResponse*> check_response(const LcmRequestChannel& channel,
                                               const BorrowedRequest& request,
                                               const WrenchResponse& response);

// waited: time without a response [s].
tl::unexpected<Error> no_response_error(const LcmRequestChannel& channel, std::int64_t seq, double waited);
tl::unexpected<Error> cancelled_error(const LcmRequestChannel& channel, std::int64_t seq);

double to_seconds(Clock::duration duration);
Clock::duration to_duration(double seconds);

}  // namespace buoyancy
