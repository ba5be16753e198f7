#include "service/daemon/daemon_options.h"

#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace buoyancy {

void add_options(CLI::App& app, DaemonOptions& options) {
  app.description(
      "Answers body poses heard on LCM with the buoyant force and torque on each body.\n"
      "SIGHUP: reads the scene again, without dropping a session.\n"
      "Exit codes: 0 done (SIGINT and SIGTERM end it), 1 it ran and failed, 2 wrong arguments, scene or "
      "mesh.");
  app.set_version_flag("--version", "buoyancyd " BUOYANCY_VERSION);
  app.add_option("--scene", options.scene, "The scene file (TOML): water and bodies")->required();
  app.add_option(
      "-l,--lcm-url", options.lcm_url,
      "LCM URL, for example udpm://239.255.76.67:7667?ttl=0; default: $LCM_DEFAULT_URL, then LCM's own");
  app.add_option_function<std::string>(
         "--mode",
         [&options](const std::string& mode) {
           options.mode =
               mode == to_string(ServiceMode::kLatest) ? ServiceMode::kLatest : ServiceMode::kLockstep;
         },
         "lockstep: answer every request; latest: answer the newest request of each session. A request "
         "whose seq is lower than the newest by more than 64 is a client that started over")
      ->check(CLI::IsMember(
          {std::string(to_string(ServiceMode::kLockstep)), std::string(to_string(ServiceMode::kLatest))}))
      ->option_text("lockstep|latest [lockstep]");
  app.add_option("--states-channel", options.channels.states, "Channel of the requests")
      ->capture_default_str();
  app.add_option("--wrenches-channel", options.channels.wrenches, "Channel of the responses")
      ->capture_default_str();
  app.add_option("--hydrostatics-channel", options.channels.hydrostatics,
                 "Channel of the hydrostatics of bodies whose outputs in the scene name them")
      ->capture_default_str();
  app.add_option("--status-channel", options.channels.status, "Channel of the status, once a second")
      ->capture_default_str();
  add_options(app, options.poses);
  app.add_option(
         "--threads", options.threads,
         "Threads among which a request's bodies are shared, where there is enough to do; 0: as many as the "
         "processor runs at once. The responses do not depend on it")
      ->check(CLI::Range(0, 1024))
      ->option_text("N [0]");
  app.add_flag(
      "--no-spin", options.no_spin,
      "Sleep as soon as no message waits, instead of looking for the next one for up to 50 us while they "
      "come quickly: takes less of the processor, and longer for each round trip");
  app.add_option("--log-level", options.log_level,
                 "trace, debug (each session's start), info (ready, reload, end), warning (troubles), error "
                 "(a reload "
                 "that failed), critical or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}))
      ->option_text("LEVEL [info]");
  app.add_flag("--check", options.check, "Print the report of the scene and its meshes, then exit");
  app.add_flag("--json", options.json, "With --check: as JSON")->needs("--check");
}

Expected<void> check_options(const DaemonOptions& options) {
  const ChannelNames& channels = options.channels;
  if (Expected<void> checked = check_channels_distinct(
          {channels.states, channels.wrenches, channels.hydrostatics, channels.status});
      !checked) {
    return checked;
  }
  return check_lcm_url(options.lcm_url);
}

}  // namespace buoyancy
