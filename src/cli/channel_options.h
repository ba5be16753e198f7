// The options that several programs share, each declared and described once: the LCM URL, the channels and
// the lead time.
#pragma once

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
CLI::Option* add_status_channel_option(CLI::App& app, std::string& channel);
// poses: the poses that the option applies to, in words.
CLI::Option* add_lead_time_option(CLI::App& app, double& seconds, const std::string& poses);

}  // namespace buoyancy
