#include "client/ping/ping_options.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "client/client.h"
#include "messages/sea_state.h"
#include "scene/scene_file.h"
#include "transport/lcm_connection.h"

namespace buoyancy::ping {

void add_options(CLI::App& app, PingOptions& options) {
  app.description(
      "Check a running buoyancyd: send known poses of the scene's bodies, compare every response with\n"
      "this program's own within the published error bounds, and measure the round trips. The scene file\n"
      "must describe the same scene as that of the service.\n" +
      exit_status_help(
          {.success = "if every response agrees",
           .failure = "if a response differs or is missing, on a runtime error, or on an interruption by "
                      "SIGINT or SIGTERM (the table then covers the requests so far)"}));
  app.set_version_flag("--version", "buoyancy-ping " BUOYANCY_VERSION);
  app.add_option("--scene", options.scene, "Scene file (TOML): water and bodies")->required();
  add_lcm_url_option(app, options.link.lcm_url);
  app.add_option("--count", options.count, "Number of requests; each has one pose of every body")
      ->check(CLI::Range(std::int64_t{1}, kMaxCount, "N"))
      ->capture_default_str();
  app.add_option("--rate", options.rate,
                 "Requests per second; without this option as fast as responses arrive")
      ->check(number_in(0.0, 1e6, "HZ"));
  app.add_option("--seed", options.seed, "Seed of the poses: the same seed and scene give the same poses")
      ->capture_default_str();
  add_timeout_option(app, options.retry_policy.timeout);
  add_retries_option(app, options.retry_policy.max_retries, "it counts as unanswered");
  app.add_option("--sea", options.sea,
                 "For a scene with waves = \"received\": publish the sea of this scene file (TOML), which "
                 "replaces the sea that the service has")
      ->type_name("FILE");
  app.add_flag(
      "--identical", options.identical,
      "Fail unless every reply is identical to the last bit, as it is from the same scene, version and\n"
      "instruction set: this finds differences that are smaller than the error bounds, as in waves");
  add_states_channel_option(app, options.link.states_channel);
  add_wrenches_channel_option(app, options.link.wrenches_channel);
  add_hydrostatics_channel_option(app, options.link.hydrostatics_channel);
  add_loads_channel_option(app, options.link.loads_channel);
  add_sea_channel_option(app, options.link.sea_channel);
  add_status_channel_option(app, options.link.status_channel);
  app.add_flag("--json", options.json, "Print the results as JSON");
  app.add_option("--junit", options.junit, "Write the checks to this file as JUnit XML, for CI systems")
      ->type_name("FILE");
}

Expected<void> check_options(const PingOptions& options) {
  const LinkOptions& link = options.link;
  if (Expected<void> checked =
          check_channels_distinct({link.states_channel, link.wrenches_channel, link.hydrostatics_channel,
                                   link.loads_channel, link.sea_channel, link.status_channel});
      !checked) {
    return checked;
  }
  if (Expected<void> checked = check_output_not_input(options.junit, {options.scene, options.sea});
      !checked) {
    return checked;
  }
  return check_lcm_url(link.lcm_url);
}

Expected<ByteVector> sea_to_publish(const PingOptions& options, const Scene& scene) {
  if (!scene.receives_sea()) {
    if (options.sea.empty()) return ByteVector{};
    return make_error({"--sea", options.sea.string(), "no --sea with this scene",
                       "the service uses a published sea only where its scene says waves = \"received\"",
                       ""});
  }
  if (scene.receives_grids()) {
    return make_error({options.scene.string(), to_string(scene.sea_messages()),
                       "a scene that describes its waves, or waves = \"received\"",
                       "this program sends no grids",
                       "Test the connection with waves = \"received\" and --sea"});
  }
  if (options.sea.empty()) {
    return make_error({options.scene.string(), "waves = \"received\" and no --sea",
                       "--sea FILE, a scene file with waves and the same up and gravity",
                       "the scene does not describe the sea that responses depend on",
                       "Give a file with the sea to publish, such as one with [[water.waves]] and a body"});
  }
  const Expected<SceneDescription> description = read_scene_file(options.sea);
  if (!description) return make_error(description.error());
  if (description->sea_messages != SeaMessages::kNone || description->sea.systems.empty()) {
    return make_error(
        {"--sea " + options.sea.string(), "describes no waves", "a scene file with [[water.waves]]", "", ""});
  }
  Expected<Sea> sea = Sea::make(description->sea, description->water);
  if (!sea) return make_error(sea.error());
  SeaState state = to_sea_state(*sea, make_session_id());
  // The scene must be able to use it, else the service rejects it.
  if (const Expected<Sea> usable = to_sea(state, scene.water(), scene.current_W()); !usable)
    return make_error(usable.error());
  ByteVector bytes;
  encode(state, bytes);
  return bytes;
}

}  // namespace buoyancy::ping
