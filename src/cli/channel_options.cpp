#include "cli/channel_options.h"

#include <array>
#include <charconv>
#include <cstdio>

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

CLI::Option* add_sea_grid_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--sea-grid-channel", channel,
                  "LCM channel for grids of the sea (sea_grid_t), received where the scene says waves = "
                  "\"grid\"")
      ->capture_default_str();
}

CLI::Option* add_condition_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--condition-channel", channel,
                  "LCM channel for changes of compartments and tanks (body_condition_t), received for scenes "
                  "that have some")
      ->capture_default_str();
}

CLI::Option* add_water_points_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--water-points-channel", channel,
                  "LCM channel for requests for the water at points (water_points_t)")
      ->capture_default_str();
}

CLI::Option* add_water_samples_channel_option(CLI::App& app, std::string& channel) {
  return app
      .add_option("--water-samples-channel", channel, "LCM channel for their responses (water_samples_t)")
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

CLI::Option* add_timeout_option(CLI::App& app, double& seconds) {
  return app.add_option("--timeout", seconds, "Response timeout in seconds before resending")
      ->check(number_in(0.0, 1e6, "S"))
      ->capture_default_str();
}

CLI::Option* add_retries_option(CLI::App& app, std::int64_t& retries, const std::string& otherwise) {
  constexpr std::int64_t kMaxRetries = std::int64_t{1} << 40U;
  return app.add_option("--retries", retries, "Maximum number of resends of a request before " + otherwise)
      ->check(CLI::Range(std::int64_t{0}, kMaxRetries, "N"))
      ->capture_default_str();
}

CLI::Validator number_in(double low, double high, const std::string& unit) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc{} && end == text.data() + text.size();
    if (is_number && value > low && value <= high) return "";
    std::array<char, 128> message{};
    std::snprintf(message.data(), message.size(), "%.40s is not a number above %g and at most %g",
                  text.c_str(), low, high);
    return message.data();
  };
  return {check, unit};
}

}  // namespace buoyancy
