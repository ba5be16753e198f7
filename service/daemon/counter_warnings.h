// Turns the growth of counters into warnings for the log.
#pragma once

#include <string>
#include <vector>

#include "messages/status.h"
#include "service/daemon/rate_limited_log.h"
#include "transport/udpm_receiver.h"

namespace buoyancy::service {

// One event per cause of rejection, per body status other than OK, and per warning about waves whose counter
// has grown.
std::vector<LogEvent> warnings_since(const ServiceCounters& before, const ServiceCounters& now);

// One event per kind of loss whose counter has grown.
std::vector<LogEvent> warnings_since(const DropCounts& before, const DropCounts& now,
                                     const BufferLimit& receive_buffer_limit);

// One line of totals: "1200 requests: 1198 computed, 2 retries, ...".
std::string describe_totals(const ServiceCounters& counters, const LatencyPercentiles& latency);

}  // namespace buoyancy::service
