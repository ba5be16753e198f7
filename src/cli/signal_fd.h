// Signals as something to wait for, instead of something that strikes in the middle of a message.
#pragma once

#include <csignal>
#include <initializer_list>
#include <optional>

#include "base/unique_fd.h"

namespace buoyancy {

class SignalFd {
 public:
  // Blocks them from here on, in this thread and in those it starts: construct it before anything that starts
  // threads (a Daemon does).
  explicit SignalFd(std::initializer_list<int> signals);

  int fileno() const { return descriptor_.value(); }  // readable once one of them has come
  bool pending() const;                               // has one come?
  std::optional<int> consume();  // its number; nullopt: none has come. The same one several times comes once

  // Drops those that have come; from here on they do again in this thread what they did before.
  void unblock();

 private:
  sigset_t set_{};
  UniqueFd descriptor_;
};

}  // namespace buoyancy
