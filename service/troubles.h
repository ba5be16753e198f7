// What went wrong between two readings of the counters, in words for the log. Asked once a second, it keeps a
// flood of bad messages from becoming a flood of log lines.
#pragma once

#include <string>
#include <vector>

#include "messages/status.h"

namespace buoyancy {

// One line for each cause of rejection and each status other than OK whose counter has grown.
std::vector<std::string> describe_troubles(const Counters& before, const Counters& now);

// One line of totals: "1200 questions, 1198 answered, ...".
std::string describe_totals(const Counters& counters, const LatencyPercentiles& latency);

}  // namespace buoyancy
