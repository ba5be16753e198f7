// Reports the daemon's state to its service manager by datagrams to $NOTIFY_SOCKET (sd_notify(3)), through
// libsystemd if it was found at build time. Without libsystemd or a socket every call does nothing; a
// notification that cannot be sent is ignored and never stops the service.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace buoyancy::service {

class SystemdNotifier {
 public:
  void ready();      // requests are handled from now on; also ends the state of reloading()
  void reloading();  // a new scene is being loaded
  void stopping();
  void status(const std::string& line);  // for `systemctl status`

  // The interval at which ping_watchdog() has to be called: half of $WATCHDOG_USEC, the time after which the
  // manager regards the service as hung. nullopt: no watchdog.
  static std::optional<std::chrono::microseconds> watchdog_interval();
  // Call this from the event loop only: it reports that the loop still runs.
  void ping_watchdog();

 private:
  std::string last_status_;  // an unchanged status is not sent again
};

}  // namespace buoyancy::service
