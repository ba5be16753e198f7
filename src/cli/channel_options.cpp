#include "cli/channel_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace buoyancy {

CLI::Option* add_lcm_url_option(CLI::App& app, std::string& url) {
  return app.add_option(
      "-l,--lcm-url", url,
      "LCM URL, such as udpm://239.255.76.67:7667?ttl=0 (default: $LCM_DEFAULT_URL, else LCM's own)");
}

CLI::Option* add_states_channel_option(CLI::App& app, std::string& channel) {
  return app.add_option("--states-channel", channel, "LCM channel for requests (body_states_t)")
      ->capture_default_str();
}

CLI::Option* add_wrenches_channel_option(CLI::App& app, std::string& channel) {
  return app.add_option("--wrenches-channel", channel, "LCM channel for responses (body_wrenches_t)")
      ->capture_default_str();
}

CLI::Option* add_hydrostatics_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--hydrostatics-channel", channel,
                  "LCM channel for hydrostatics (bodies_hydrostatics_t) of bodies whose outputs in the scene "
                  "include them")
      ->capture_default_str();
}

CLI::Option* add_loads_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--loads-channel", channel,
                  "LCM channel for loads (bodies_loads_t) of bodies whose outputs in the scene include them")
      ->capture_default_str();
}

CLI::Option* add_sea_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--sea-channel", channel,
                  "LCM channel for the sea (sea_state_t) of scenes with waves: sent, or received where the "
                  "scene says waves = \"received\"")
      ->capture_default_str();
}

CLI::Option* add_status_channel_option(CLI::App& app, std::string& channel) {
  return app.add_option("--status-channel", channel, "LCM channel for the status (service_status_t), 1 Hz")
      ->capture_default_str();
}

CLI::Option* add_lead_time_option(CLI::App& app, double& seconds, const std::string& poses) {
  return app
      .add_option(
          "--lead-time", seconds,
          "Evaluate wrenches at " + poses + " extrapolated by this many seconds using their velocities")
      ->capture_default_str();
}

}  // namespace buoyancy
