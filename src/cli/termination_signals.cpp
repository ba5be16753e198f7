#include "cli/termination_signals.h"

namespace buoyancy {

const char* TerminationSignals::take() {
  const std::optional<int> signal = signals_.take();
  if (!signal) return nullptr;
  return *signal == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace buoyancy
