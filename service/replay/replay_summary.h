// What a replay says at its end, for people and for programs.
#pragma once

#include <string>

#include "service/replay/replay.h"
#include "service/replay/replay_comparison.h"

namespace buoyancy {

// comparison: nullptr where there was none. Lines for a terminal, with a final newline.
std::string summary_text(const ReplaySummary& summary, const ReplayComparison* comparison);
// One JSON object, with a final newline. A difference over bounds of 0 is null.
std::string summary_json(const ReplaySummary& summary, const ReplayComparison* comparison);

}  // namespace buoyancy
