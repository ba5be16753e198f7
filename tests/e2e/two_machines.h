// Two machines and a switch between them, as network namespaces; the test's own namespace is the client's
// machine. Only the client's end of the cable outlives the object, as long as the test's namespace.
#pragma once

#include <optional>
#include <string>

#include "tests/support/child_process.h"

namespace buoyancy {

// LCM's default address with ttl=1, which reaches the next machine. The two machines have no other
// connection.
inline constexpr const char* kTwoMachinesUrl = "udpm://239.255.76.67:7667?ttl=1";

class TwoMachines {
 public:
  // Sets error() if this machine does not support it.
  TwoMachines();
  TwoMachines(const TwoMachines&) = delete;
  TwoMachines& operator=(const TwoMachines&) = delete;
  ~TwoMachines();

  // Why the setup failed: no permission to create namespaces, or a kernel without veth or bridge. Later: the
  // error of a failed command below.
  const std::optional<std::string>& error() const { return error_; }

  // Returns the same command, run on the service's machine.
  ChildCommand on_service_machine(ChildCommand command) const;

  // Unplug and plug in the client's cable at the switch. Addresses and routes stay, as with a real cable.
  void unplug_cable() { run_on_switch("ip link set port0 down"); }
  void plug_in_cable() { run_on_switch("ip link set port0 up"); }

  // Set the client's interface down and up. Its routes are removed meanwhile, and sending fails until they
  // are restored.
  void take_interface_down() { run("ip link set buoyancy0 down"); }
  void bring_interface_up() { run("ip link set buoyancy0 up; ip route replace 224.0.0.0/4 dev buoyancy0"); }

 private:
  void run(const std::string& script);
  void run_on_switch(const std::string& command) { run("nsenter -t $SWITCH -n " + command); }

  ChildProcess switch_;
  ChildProcess service_;
  std::optional<std::string> error_;
  bool set_up_ = false;
};

}  // namespace buoyancy
