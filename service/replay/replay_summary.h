// Formats the summary of a replay as text and as JSON.
#pragma once

#include <string>

#include "base/json.h"
#include "service/replay/replay.h"
#include "service/replay/replay_comparison.h"

namespace buoyancy::service {

// Lines for a terminal, with a final newline. comparison: nullptr without --compare.
std::string summary_text(const ReplaySummary& summary, const ReplayComparison* comparison);
// One JSON object, with a final newline. The ratio of a difference to a bound of 0 is null.
std::string summary_json(const ReplaySummary& summary, const ReplayComparison* comparison);

// The same object without the comparison, and back. Reading it throws nlohmann::json::exception if a field is
// missing or of another type; stopped_by is not read.
Json summary_to_json(const ReplaySummary& summary);
ReplaySummary summary_from_json(const Json& json);

}  // namespace buoyancy::service
