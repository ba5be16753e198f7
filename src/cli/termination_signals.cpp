#include "cli/termination_signals.h"

namespace buoyancy {

const char* TerminationSignals::consume() {
  const std::optional<int> signal = signals_.consume();
  if (!signal) return nullptr;
  return *signal == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace buoyancy
