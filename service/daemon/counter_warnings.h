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
std::vector<Trouble> troubles_between(const Counters& before, const Counters& now);

std::vector<Trouble> troubles_between(const ReceiveLosses& before, const ReceiveLosses& now);

// One line of totals: "1200 questions, 1198 answered, ...".
std::string describe_totals(const Counters& counters, const LatencyPercentiles& latency);

}  // namespace buoyancy
