// The log of a program, written to standard error with time and level, in colour on a terminal.
//
// The journal of systemd adds the time itself: there a line is its text after its level in the form that
// sd-daemon(3) describes ("<4>"), so that `journalctl -p warning` finds it.
#pragma once

#include <string>

namespace buoyancy {

// Sets up spdlog's default logger. level: a name that spdlog knows, such as "info".
void init_logging(const std::string& program, const std::string& level);

// Returns whether standard error is connected to the journal.
bool stderr_is_journal();

}  // namespace buoyancy
