// SIGINT and SIGTERM, which end a program between two messages.
#pragma once

#include <csignal>

#include "cli/signal_fd.h"

namespace buoyancy {

class TerminationSignals {
 public:
  TerminationSignals() : signals_({SIGINT, SIGTERM}) {}  // as SignalFd

  int fileno() const { return signals_.fileno(); }  // readable once a signal has come
  bool pending() const { return signals_.pending(); }
  const char* consume();                  // its name; nullptr: none has come
  void unblock() { signals_.unblock(); }  // as SignalFd: they end the program at once again

 private:
  SignalFd signals_;
};

}  // namespace buoyancy
