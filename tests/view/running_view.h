// buoyancy-view as a separate process with normal scheduling: on a machine that is never idle, the default
// policy publishes nothing.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/service/running_service.h"
#include "tests/support/build_paths.h"
#include "tests/support/running_program.h"
#include "tests/view/http_peer.h"

namespace buoyancy::view {

// The constructor returns when the view is ready.
class RunningView {
 public:
  // port: 0 selects a free one.
  explicit RunningView(const std::string& scene, std::vector<std::string> options = {},
                       std::uint16_t port = 0)
      : child_(command(directory_.write("scene.toml", scene), std::move(options), port)),
        port_(port_from_ready_line(child_.standard_output())) {}

  ChildProcess& child() { return child_; }
  std::uint16_t port() const { return port_; }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/"; }

 private:
  static ChildCommand command(const std::string& scene, std::vector<std::string> options,
                              std::uint16_t port) {
    options.insert(options.begin(), {built_program("buoyancy-view"), "--scene", scene, "--port",
                                     std::to_string(port), "--scheduling", "normal"});
    return command_of(std::move(options));
  }

  TempDir directory_;
  RunningProgram child_;
  std::uint16_t port_;
};

}  // namespace buoyancy::view
