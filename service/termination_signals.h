// SIGINT and SIGTERM as something to wait for, instead of something that strikes in the middle of a message.
#pragma once

#include <csignal>

#include "service/file_descriptor.h"

namespace buoyancy {

class TerminationSignals {
 public:
  // Blocks both signals from here on, in this thread and in those it starts: construct it before anything
  // that starts threads (an LcmConnection does).
  TerminationSignals();

  int fileno() const { return descriptor_.value(); }  // readable once a signal has come
  bool pending() const;                               // has one come?
  const char* take();                                 // its name; nullptr: none has come

 private:
  FileDescriptor descriptor_;
};

}  // namespace buoyancy
