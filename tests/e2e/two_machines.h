// Two machines and the switch between them, as network namespaces: the test's own is the client's machine.
// Nothing of it outlives the object but the client's end of the cable, which goes with the test's namespace.
#pragma once

#include <optional>
#include <string>

#include "tests/support/child_process.h"

namespace buoyancy {

// LCM's default but for ttl=1: as far as the next machine. Between the two of these there is no other way.
inline constexpr const char* kTwoMachinesUrl = "udpm://239.255.76.67:7667?ttl=1";

class TwoMachines {
 public:
  // Ends in trouble() where this machine cannot do it.
  TwoMachines();
  TwoMachines(const TwoMachines&) = delete;
  TwoMachines& operator=(const TwoMachines&) = delete;
  ~TwoMachines();

  // What kept it from being set up: no right to make namespaces, a kernel without veth or bridge. Later: a
  // command of those below that failed.
  const std::optional<std::string>& warning() const { return warning_; }

  // The same command on the service's machine.
  ChildCommand on_the_services(ChildCommand command) const;

  // Pulls the client's cable out of the switch, puts it back. Addresses and routes stay, as with a real one.
  void pull_cable() { on_the_switch("ip link set port0 down"); }
  void plug_cable() { on_the_switch("ip link set port0 up"); }

  // The client's interface, administratively: its routes go with it, and sending is an error until they are
  // back.
  void take_interface_down() { run("ip link set buoyancy0 down"); }
  void bring_interface_up() { run("ip link set buoyancy0 up; ip route replace 224.0.0.0/4 dev buoyancy0"); }

 private:
  void run(const std::string& script);
  void on_the_switch(const std::string& command) { run("nsenter -t $SWITCH -n " + command); }

  ChildProcess switch_;
  ChildProcess service_;
  std::optional<std::string> warning_;
  bool set_up_ = false;
};

}  // namespace buoyancy
