// systemd's journal as the reader of standard error.
#pragma once

namespace buoyancy {

// Is what is written to standard error read by the journal? It then wants a line's level in front ("<4>",
// sd-daemon(3)) and has the time itself.
bool stderr_is_journal();

}  // namespace buoyancy
