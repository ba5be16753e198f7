// Starts the real buoyancyd for a test, on an address of its own, and stops it.
//
//   buoyancy::testing::ServiceOptions what;
//   what.scene = "scenes/box.toml";
//   auto service = buoyancy::testing::ServiceProcess::start(what);
//   if (!service) return fail(service.error().message());
//   options.channel.lcm_url = service->lcm_url();
//
// The fixture for GoogleTest is in service_test.h. Linux only. Use from one thread at a time.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"

namespace buoyancy::testing {

struct ServiceOptions {
  std::filesystem::path scene;         // a scene file
  std::string scene_text;              // or its text, in which paths of meshes are absolute
  std::vector<std::string> arguments;  // of buoyancyd, such as {"--inject", "drop=0.1"}
  std::filesystem::path program;       // empty: $BUOYANCYD, else buoyancyd in $PATH
  double ready_timeout = 60.0;         // [s], > 0; large meshes take time to load
};

class ServiceProcess {
 public:
  // Returns once the service answers requests. Its address, lcm_url(), is a port that no other service of a
  // test on this machine has, and its packets do not leave the machine. The service ends with this process,
  // however that ends. Errors: both or neither of scene and scene_text; no such program; it ended, or was not
  // ready in time, with its log; no multicast (see private_network.h).
  static Expected<ServiceProcess> start(const ServiceOptions& options);

  ServiceProcess(ServiceProcess&&) noexcept;
  ServiceProcess& operator=(ServiceProcess&&) noexcept;
  ~ServiceProcess();  // stop()

  const std::string& lcm_url() const;  // for the client, and for $LCM_DEFAULT_URL of the simulator
  int pid() const;                     // also after it has ended
  std::string log() const;             // of the service, so far
  bool is_running();

  // Waits until the log contains the text. Returns false if it does not within `seconds`, or if the service
  // ends before.
  bool wait_for_log(const std::string& text, double seconds);

  // Ends the service with SIGTERM, or with SIGKILL if that takes longer than 10 s. Returns its exit code, or
  // 128 + the signal that ended it. A second call returns the same.
  int stop();

 private:
  struct Impl;
  explicit ServiceProcess(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace buoyancy::testing
