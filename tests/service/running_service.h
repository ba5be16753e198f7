// Runs buoyancyd as a process on the UDP multicast of the test's network namespace, and sends requests to it.
#pragma once

#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "messages/status.h"
#include "tests/service/one_box_scene.h"
#include "tests/service/raw_lcm.h"
#include "tests/support/build_paths.h"
#include "tests/support/byte_vector.h"
#include "tests/support/running_program.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy {

// Body 1 is that of kOneBoxScene; body 2 is equal, with its torque about kReferenceInB.
inline constexpr std::array<double, 3> kReferenceInB{0.5, -0.25, 0.0};
inline const std::string kBoxScene = kOneBoxScene + R"([[body]]
id = 2
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
method = "exact"
reference_point = [0.5, -0.25, 0.0]
)";

// Two such boxes; the scene requests hydrostatics of body 2.
inline const std::string kHydrostaticBoxScene = kTestWater + R"([[body]]
id = 1
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
[[body]]
id = 2
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
outputs = ["wrench", "hydrostatics"]
[body.client]
mass = 12000
)";

// The service is ready once this is constructed.
class RunningService {
 public:
  explicit RunningService(std::vector<std::string> options = {}, const std::string& scene = kBoxScene,
                          std::vector<std::string> environment = {})
      : child_(command(std::move(options), directory_.write("scene.toml", scene), std::move(environment))) {}

  ChildProcess& child() { return child_; }
  std::string log() const { return child_.standard_error(); }

  // Stops all its threads until SIGCONT; returns once they have stopped.
  void stop() {
    child_.send_signal(SIGSTOP);
    for (std::string state; state != "T";) {
      std::string pid;
      std::string name;
      std::ifstream("/proc/" + std::to_string(child_.pid()) + "/stat") >> pid >> name >> state;
    }
  }

  // Files in the directory of the scene file, "scene.toml".
  std::string path(const std::string& name) const { return directory_.path(name); }
  void write(const std::string& name, const std::string& contents) const { directory_.write(name, contents); }

 private:
  static ChildCommand command(std::vector<std::string> options, const std::string& scene,
                              std::vector<std::string> environment) {
    options.insert(options.begin(), {built_program("buoyancyd"), "--scene", scene});
    ChildCommand result = command_of(std::move(options));
    result.environment = std::move(environment);
    return result;
  }

  TempDir directory_;
  RunningProgram child_;
};

inline WrenchRequest one_body(std::int64_t session_id, std::int64_t seq, double height) {
  return {.id = {.utime = 1'000 * seq, .session_id = session_id, .seq = seq},
          .lead_time = 0.0,
          .bodies = {{.body_id = 1,
                      .position = {1.0, 2.0, height},
                      .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0},
                      .linear_velocity = {},
                      .angular_velocity = {}}}};
}

inline void send_request(RawLcmSocket& socket, const WrenchRequest& states) {
  socket.send("BUOYANCY_STATES", encoded(states));
}

inline std::optional<RawBytes> receive_bytes(RawLcmSocket& socket, double seconds = kWaitTimeout) {
  return socket.receive("BUOYANCY_WRENCHES", seconds);
}

// Throws if no response arrives.
inline WrenchResponse receive(RawLcmSocket& socket) {
  const std::optional<RawBytes> bytes = receive_bytes(socket);
  if (!bytes) throw std::runtime_error("no response");
  return decoded<WrenchResponse>(*bytes);
}

// The first status that satisfies `wanted`; nullopt: none within kWaitTimeout.
template <typename Predicate>
std::optional<ServiceStatus> wait_for_status(RawLcmSocket& socket, Predicate&& wanted) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
  while (std::chrono::steady_clock::now() < limit) {
    const std::optional<RawBytes> bytes = socket.receive("BUOYANCY_STATUS", kWaitTimeout);
    if (!bytes) return std::nullopt;
    ServiceStatus status;
    if (!decode(*bytes, status) && wanted(status)) return status;
  }
  return std::nullopt;
}

}  // namespace buoyancy
