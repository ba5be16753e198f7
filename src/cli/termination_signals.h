// Lets SIGINT and SIGTERM end a program between two messages.
#pragma once

#include <csignal>

#include "cli/signal_fd.h"

namespace buoyancy {

class TerminationSignals {
 public:
  TerminationSignals() : signals_({SIGINT, SIGTERM}) {}  // see SignalFd

  int fileno() const { return signals_.fileno(); }  // readable once a signal is pending
  bool pending() const { return signals_.pending(); }
  const char* consume();                  // the signal's name, or nullptr if none is pending
  void unblock() { signals_.unblock(); }  // see SignalFd: the signals end the program at once again

 private:
  SignalFd signals_;
};

}  // namespace buoyancy
