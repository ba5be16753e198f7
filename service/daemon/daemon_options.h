// buoyancyd's command line.
#pragma once

#include <filesystem>
#include <string>

#include <CLI/App.hpp>

#include "base/error.h"
#include "cli/pose_options.h"
#include "service/daemon/daemon.h"

namespace buoyancy {

struct DaemonOptions {
  std::filesystem::path scene;
  std::string lcm_url;  // empty: LCM's default
  ServiceMode mode = ServiceMode::kLockstep;
  ChannelNames channels;
  PoseOptions poses;
  unsigned threads = 0;            // for the bodies of one request; 0: as many as the processor runs at once
  bool no_spin = false;            // sleep at once where no message waits
  std::string log_level = "info";  // as spdlog names them
  bool check = false;              // print the scene's report and end
  bool json = false;               // with check
};

// Declares the options on app; parsing fills options, which must live as long.
void add_options(CLI::App& app, DaemonOptions& options);

// What no single option shows. Errors: an LCM URL that is none, channels that are the same or too long,
// --json without --check.
Expected<void> check_options(const DaemonOptions& options);

}  // namespace buoyancy
