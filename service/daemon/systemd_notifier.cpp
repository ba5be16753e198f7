#include "service/daemon/systemd_notifier.h"

#include <cstdint>

#ifdef BUOYANCY_WITH_SYSTEMD
#include <ctime>

#include <systemd/sd-daemon.h>
#endif

namespace buoyancy::service {
namespace {

#ifdef BUOYANCY_WITH_SYSTEMD
void notify(const std::string& state) {
  ::sd_notify(0, state.c_str());
}

// systemd orders reloads by this time, which is of CLOCK_MONOTONIC.
std::string monotonic_microseconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::to_string(std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000);
}
#else
void notify(const std::string& /*state*/) {}
std::string monotonic_microseconds() {
  return {};
}
#endif

}  // namespace

void SystemdNotifier::ready() {
  notify("READY=1");
}

void SystemdNotifier::reloading() {
  notify("RELOADING=1\nMONOTONIC_USEC=" + monotonic_microseconds());
}

void SystemdNotifier::stopping() {
  notify("STOPPING=1");
}

void SystemdNotifier::status(const std::string& line) {
  if (line == last_status_) return;
  notify("STATUS=" + line);
  last_status_ = line;
}

std::optional<std::chrono::microseconds> SystemdNotifier::watchdog_interval() {
#ifdef BUOYANCY_WITH_SYSTEMD
  std::uint64_t microseconds = 0;
  if (::sd_watchdog_enabled(0, &microseconds) > 0) return std::chrono::microseconds(microseconds / 2);
#endif
  return std::nullopt;
}

void SystemdNotifier::ping_watchdog() {
  notify("WATCHDOG=1");
}

}  // namespace buoyancy::service
