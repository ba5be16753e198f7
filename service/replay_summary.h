// What a replay says at its end, for people and for programs.
#pragma once

#include <string>

#include "service/replay.h"

namespace buoyancy {

std::string summary_text(const ReplaySummary& summary);  // lines for a terminal, with a final newline
std::string summary_json(const ReplaySummary& summary);  // one JSON object, with a final newline

}  // namespace buoyancy
