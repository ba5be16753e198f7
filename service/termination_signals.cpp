#include "service/termination_signals.h"

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>

namespace buoyancy {
namespace {

sigset_t termination_set() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

TerminationSignals::TerminationSignals() {
  const sigset_t set = termination_set();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  descriptor_ = FileDescriptor(::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
}

bool TerminationSignals::pending() const {
  pollfd waiting{fileno(), POLLIN, 0};
  return ::poll(&waiting, 1, 0) > 0;
}

const char* TerminationSignals::take() {
  signalfd_siginfo info{};
  if (::read(fileno(), &info, sizeof info) != static_cast<ssize_t>(sizeof info)) return nullptr;
  return info.ssi_signo == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace buoyancy
