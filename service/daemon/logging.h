// Where the log goes and how its lines look: standard error, with time and level, in colour on a terminal.
// Where standard error is systemd's journal, which has the time itself, a line is its text with its level in
// front as sd-daemon(3) wants it ("<4>"), so that `journalctl -p warning` finds it.
#pragma once

#include <string>

namespace buoyancy {

// level: as spdlog names them.
void init_logging(const std::string& program, const std::string& level);

}  // namespace buoyancy
