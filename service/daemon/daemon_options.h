// buoyancyd's command line.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "base/error.h"
#include "cli/pose_options.h"
#include "service/daemon/daemon.h"

namespace buoyancy::service {

struct DaemonOptions {
  std::filesystem::path scene;
  std::string lcm_url;  // empty: LCM's default
  ServiceMode mode = ServiceMode::kLockstep;
  ChannelNames channels;
  PoseOptions poses;
  unsigned threads = 0;               // per request; 0: number of hardware threads
  bool no_spin = false;               // sleep at once when no message is pending
  std::string log_level = "info";     // a level name of spdlog
  std::optional<std::string> inject;  // faults, see parse_faults()
  bool check = false;                 // print the scene's report and exit
  bool json = false;                  // with check
  std::vector<double> drafts;         // [m], with check
};

// Declares the options on app; parsing fills options, which must outlive app.
void add_options(CLI::App& app, DaemonOptions& options);

// Checks the options that depend on each other. Errors: an invalid LCM URL, channels that are equal or too
// long, --json without --check, faults that cannot be parsed.
Expected<void> check_options(const DaemonOptions& options);

}  // namespace buoyancy::service
