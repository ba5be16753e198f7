#include "service/daemon/daemon_options.h"

#include <string>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"

namespace buoyancy::service {

void add_options(CLI::App& app, DaemonOptions& options) {
  app.description(
      "Receive body poses over LCM and publish the buoyant force and torque on each body.\n"
      "SIGHUP reloads the scene and keeps all sessions.\n" +
      exit_status_help());
  app.set_version_flag("--version", "buoyancyd " BUOYANCY_VERSION);
  app.add_option("--scene", options.scene, "Scene file (TOML): water and bodies")->required();
  add_lcm_url_option(app, options.lcm_url);
  app.add_option_function<std::string>(
         "--mode",
         [&options](const std::string& mode) {
           options.mode =
               mode == to_string(ServiceMode::kLatest) ? ServiceMode::kLatest : ServiceMode::kLockstep;
         },
         "lockstep: handle every request in order; latest: handle only the newest pending request of each "
         "session")
      ->check(CLI::IsMember(
          {std::string(to_string(ServiceMode::kLockstep)), std::string(to_string(ServiceMode::kLatest))}))
      ->default_str(std::string(to_string(options.mode)));
  add_states_channel_option(app, options.channels.states);
  add_wrenches_channel_option(app, options.channels.wrenches);
  add_hydrostatics_channel_option(app, options.channels.hydrostatics);
  add_loads_channel_option(app, options.channels.loads);
  add_sea_channel_option(app, options.channels.sea);
  add_sea_grid_channel_option(app, options.channels.sea_grid);
  add_condition_channel_option(app, options.channels.condition);
  add_water_points_channel_option(app, options.channels.water_points);
  add_water_samples_channel_option(app, options.channels.water_samples);
  add_status_channel_option(app, options.channels.status);
  add_options(app, options.poses);
  app.add_option("--threads", options.threads,
                 "Worker threads per request (0 = number of hardware threads). Results do not depend on this "
                 "setting")
      ->check(CLI::Range(0, 1024))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag(
      "--no-spin", options.no_spin,
      "Sleep as soon as no message is pending, instead of polling for the next one for up to 50 us while "
      "messages arrive in quick succession: uses less processor time and makes each round trip longer");
  app.add_option("--log-level", options.log_level, "Minimum log level")
      ->check(CLI::IsMember({"trace", "debug", "info", "warning", "error", "critical", "off"}))
      ->type_name("LEVEL")
      ->capture_default_str();
  app.add_option(
         "--inject", options.inject,
         "Misbehave on purpose, to test clients: drop, duplicate, reorder and corrupt are "
         "probabilities, delay and jitter times, stall a time in every period, such as "
         "drop=0.1,delay=5ms,jitter=2ms,duplicate=0.05,reorder=0.05,corrupt=0.01,stall=2s/60s,seed=7; "
         "the same seed injects the same faults")
      ->type_name("FAULTS");
  app.add_flag("--check", options.check, "Print the report of the scene and its meshes, then exit");
  app.add_flag("--json", options.json, "Print the report as JSON")->needs("--check");
  app.add_option(
         "--draft", options.drafts,
         "With --check: also report each body upright at these drafts, m over its lowest point; it needs "
         "no [body.client]")
      ->needs("--check")
      ->delimiter(',')
      ->check(number_in(0.0, 1e6, "m"))
      ->option_text("T,...");
}

Expected<void> check_options(const DaemonOptions& options) {
  const ChannelNames& channels = options.channels;
  if (Expected<void> checked =
          check_channels_distinct({channels.states, channels.wrenches, channels.hydrostatics, channels.loads,
                                   channels.sea, channels.sea_grid, channels.condition, channels.water_points,
                                   channels.water_samples, channels.status});
      !checked) {
    return checked;
  }
  if (options.inject) {
    if (const auto faults = parse_faults(*options.inject); !faults) return make_error(faults.error());
  }
  return check_lcm_url(options.lcm_url);
}

}  // namespace buoyancy::service
