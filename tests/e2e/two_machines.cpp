#include "tests/e2e/two_machines.h"

#include <filesystem>
#include <system_error>

#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

// Holds a network namespace that contains only a loopback interface, which is down.
ChildCommand empty_machine() {
  return command_of({"unshare", "-n", "sleep", "infinity"});
}

std::string namespace_of(const std::string& process) {
  std::error_code gone;
  return std::filesystem::read_symlink("/proc/" + process + "/ns/net", gone);
}

// Waits until unshare has created the namespace. False: it failed.
bool has_own_namespace(ChildProcess& machine) {
  while (!machine.wait(0.005)) {
    const std::string machine_namespace = namespace_of(std::to_string(machine.pid()));
    if (!machine_namespace.empty() && machine_namespace != namespace_of("self")) return true;
  }
  return false;
}

// Connects both machines to the switch. Outside the namespace that scripts/in_network_namespace creates, the
// first line fails and nothing is changed.
constexpr const char* kSetUp = R"(
ip route del 224.0.0.0/4 dev lo
ip link add buoyancy0 type veth peer name port0 netns $SWITCH
nsenter -t $SWITCH -n ip link add port1 type veth peer name eth0 netns $SERVICE
nsenter -t $SWITCH -n ip link add switch type bridge mcast_snooping 0
for device in port0 port1; do nsenter -t $SWITCH -n ip link set $device master switch up; done
nsenter -t $SWITCH -n ip link set switch up
ip address add 10.77.0.1/24 dev buoyancy0
ip link set buoyancy0 up
ip route add 224.0.0.0/4 dev buoyancy0
nsenter -t $SERVICE -n ip address add 10.77.0.2/24 dev eth0
nsenter -t $SERVICE -n ip link set eth0 up
nsenter -t $SERVICE -n ip route add 224.0.0.0/4 dev eth0
)";
constexpr const char* kTakeDown = R"(
ip link del buoyancy0
ip route add 224.0.0.0/4 dev lo
)";

}  // namespace

TwoMachines::TwoMachines() : switch_(empty_machine()), service_(empty_machine()) {
  for (ChildProcess* machine : {&switch_, &service_}) {
    if (has_own_namespace(*machine)) continue;
    error_ = "no namespace for a second machine: " + machine->standard_error();
    return;
  }
  run(kSetUp);
  set_up_ = !error_;
}

TwoMachines::~TwoMachines() {
  if (set_up_) run(kTakeDown);
}

ChildCommand TwoMachines::on_service_machine(ChildCommand command) const {
  const std::string process = std::to_string(service_.pid());
  command.arguments.insert(command.arguments.begin(), {"nsenter", "-t", process, "-n"});
  return command;
}

void TwoMachines::run(const std::string& script) {
  ChildCommand command = command_of({"bash", "-euc", script});
  command.environment = {"SWITCH=" + std::to_string(switch_.pid()),
                         "SERVICE=" + std::to_string(service_.pid())};
  const FinishedProcess finished = run_to_end(command, kWaitTimeout);
  if (finished.exit_code != 0) error_ = script + ": " + finished.standard_error;
}

}  // namespace buoyancy
