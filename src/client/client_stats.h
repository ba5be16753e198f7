// Statistics of a client: its requests, their responses and round trips.
#pragma once

#include <cstdint>

#include "messages/latency_histogram.h"

namespace buoyancy {

struct ClientStats {
  LatencyHistogram round_trip;  // [s], from the first sending of a request to the arrival of its response
  std::int64_t requests = 0;    // without retries
  std::int64_t retries = 0;
  std::int64_t unanswered = 0;  // requests that never got their response
  std::int64_t late = 0;        // requests for which only the response to an earlier request was available
  std::int64_t max_lag = 0;     // largest number of requests by which a response was late
  // Messages on the channels of the responses and loads that were ignored because they are not valid: cut
  // short, or of another type or version. They may have been for other clients.
  std::int64_t malformed = 0;
};

}  // namespace buoyancy
