// What the counters say, in words for the log.
#pragma once

#include <string>
#include <vector>

#include "messages/status.h"
#include "service/trouble_log.h"

namespace buoyancy {

// What went wrong between two readings: each cause of rejection and each status other than OK whose counter
// has grown.
std::vector<Trouble> troubles_between(const Counters& before, const Counters& now);

// One line of totals: "1200 questions, 1198 answered, ...".
std::string describe_totals(const Counters& counters, const LatencyPercentiles& latency);

}  // namespace buoyancy
