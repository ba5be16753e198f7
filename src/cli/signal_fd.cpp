#include "cli/signal_fd.h"

#include <csignal>

#include <poll.h>
#include <sys/signalfd.h>

namespace buoyancy {

BlockedSignals::BlockedSignals(std::initializer_list<int> signals) {
  sigemptyset(&set_);
  for (const int signal : signals) sigaddset(&set_, signal);
  ::pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  descriptor_ = FileDescriptor(::signalfd(-1, &set_, SFD_NONBLOCK | SFD_CLOEXEC));
}

bool BlockedSignals::pending() const {
  pollfd waiting{fileno(), POLLIN, 0};
  return ::poll(&waiting, 1, 0) > 0;
}

std::optional<int> BlockedSignals::take() {
  signalfd_siginfo info{};
  if (::read(fileno(), &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return std::nullopt;
  return static_cast<int>(info.ssi_signo);
}

void BlockedSignals::unblock() {
  while (take()) {
  }
  ::pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
}

}  // namespace buoyancy
