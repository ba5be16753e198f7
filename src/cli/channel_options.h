// The options that several programs share, each declared and described once: the LCM URL, the channels, the
// lead time, and how long clients wait for a response.
#pragma once

#include <cstdint>
#include <string>

#include <CLI/App.hpp>

namespace buoyancy {

// Each declares its option on app. Parsing fills the second argument, which must live as long; its value at
// the call is the default that --help prints.
CLI::Option* add_lcm_url_option(CLI::App& app, std::string& url);
CLI::Option* add_states_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_wrenches_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_hydrostatics_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_loads_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_sea_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_sea_grid_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_condition_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_water_points_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_water_samples_channel_option(CLI::App& app, std::string& channel);
CLI::Option* add_status_channel_option(CLI::App& app, std::string& channel);
// poses: the poses that the option applies to, in words.
CLI::Option* add_lead_time_option(CLI::App& app, double& seconds, const std::string& poses);
CLI::Option* add_timeout_option(CLI::App& app, double& seconds);
// otherwise: what happens to a request after the last retry, in words.
CLI::Option* add_retries_option(CLI::App& app, std::int64_t& retries, const std::string& otherwise);

// Accepts numbers above `low` and at most `high`; unlike CLI::Range it rejects NaN. unit: as --help shows it.
CLI::Validator number_in(double low, double high, const std::string& unit);

}  // namespace buoyancy
