// What a service manager is told of the daemon, systemd above all: by datagrams to $NOTIFY_SOCKET
// (sd_notify(3)), through libsystemd where it was there at build time. Where nobody listens, or without
// libsystemd, nothing is done and nothing fails: a service that answers does not end for want of somebody to
// tell.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace buoyancy {

class SystemdNotifier {
 public:
  void ready();      // requests are answered from here on; ends what reloading() began
  void reloading();  // a new scene is being loaded
  void stopping();
  void status(const std::string& line);  // for `systemctl status`

  // How often ping_watchdog() is wanted: half the time after which the manager takes us for hung
  // ($WATCHDOG_USEC). nullopt: never.
  static std::optional<std::chrono::microseconds> watchdog_interval();
  // From the loop that does the work and from nowhere else: that it comes round is what is said.
  void ping_watchdog();

 private:
  std::string last_status_;  // the last status line, which is not said twice
};

}  // namespace buoyancy
