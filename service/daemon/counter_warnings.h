// What the counters say, in words for the log.
#pragma once

#include <string>
#include <vector>

#include "messages/status.h"
#include "service/daemon/rate_limited_log.h"
#include "transport/udpm_receiver.h"

namespace buoyancy {

// What went wrong between two readings: each cause of rejection, of loss, and each status other than OK whose
// counter has grown.
std::vector<LogEvent> warnings_since(const ServiceCounters& before, const ServiceCounters& now);

std::vector<LogEvent> warnings_since(const DropCounts& before, const DropCounts& now);

// One line of totals: "1200 requests, 1198 answered, ...".
std::string describe_totals(const ServiceCounters& counters, const LatencyPercentiles& latency);

}  // namespace buoyancy
