#include "cli/signal_fd.h"

#include <csignal>

#include <poll.h>
#include <sys/signalfd.h>

namespace buoyancy {

SignalFd::SignalFd(std::initializer_list<int> signals) {
  sigemptyset(&set_);
  for (const int signal : signals) sigaddset(&set_, signal);
  ::pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  descriptor_ = UniqueFd(::signalfd(-1, &set_, SFD_NONBLOCK | SFD_CLOEXEC));
}

bool SignalFd::pending() const {
  pollfd waiting{fileno(), POLLIN, 0};
  return ::poll(&waiting, 1, 0) > 0;
}

std::optional<int> SignalFd::consume() {
  signalfd_siginfo info{};
  if (::read(fileno(), &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return std::nullopt;
  return static_cast<int>(info.ssi_signo);
}

void SignalFd::unblock() {
  while (consume()) {
  }
  ::pthread_sigmask(SIG_UNBLOCK, &set_, nullptr);
}

}  // namespace buoyancy
