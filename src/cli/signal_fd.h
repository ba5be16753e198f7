// Delivers signals through a file descriptor (signalfd), so that an event loop can poll for them.
#pragma once

#include <csignal>
#include <initializer_list>
#include <optional>

#include "base/unique_fd.h"

namespace buoyancy {

class SignalFd {
 public:
  // Blocks the signals in this thread and in those that it starts from here on: construct it before anything
  // that starts threads (Daemon does).
  explicit SignalFd(std::initializer_list<int> signals);

  int fileno() const { return descriptor_.value(); }  // readable once a signal is pending
  bool pending() const;
  // Takes one pending signal and returns its number, or nullopt if none is pending. Repeated arrivals of one
  // signal are merged.
  std::optional<int> consume();

  // Discards pending signals and restores their usual effect in this thread.
  void unblock();

 private:
  sigset_t set_{};
  UniqueFd descriptor_;
};

}  // namespace buoyancy
