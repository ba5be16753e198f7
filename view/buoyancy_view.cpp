// buoyancy-view: shows live LCM traffic between a buoyancy service and its clients in a browser.

#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/pose_options.h"
#include "cli/termination_signals.h"
#include "scene/mesh_warnings.h"
#include "scene/scene.h"
#include "transport/lcm_connection.h"
#include "view/live/live_page.h"
#include "view/live/live_view.h"
#include "view/live/page_server.h"
#include "view/page/page_assets.h"

namespace buoyancy::view {
namespace {

struct Arguments {
  std::string scene;
  std::string lcm_url;
  std::string address = "127.0.0.1";
  std::vector<std::string> host_names;
  int port = 8667;
  std::string three = kThreeJs;
  std::string scheduling = "idle";
  bool metrics = false;
  ObservedChannels channels;
  PoseOptions poses;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", "buoyancy-view " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "Scene file (TOML) that the service has loaded")->required();
  add_lcm_url_option(app, arguments.lcm_url);
  app.add_option("--port", arguments.port, "TCP port of the page (0 = any free port)")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--listen", arguments.address,
                 "Address to listen on. There is no authentication: anyone who can reach a non-loopback "
                 "address sees the scene and the run")
      ->capture_default_str();
  app.add_option("--host", arguments.host_names,
                 "Further name, without port, by which browsers may open the page, such as that of a proxy; "
                 "repeatable. Addresses, localhost and the machine's name are known")
      ->allow_extra_args(false)
      ->option_text("NAME");
  app.add_option("--three", arguments.three, "three.js library (three.min.js), which draws the bodies")
      ->capture_default_str();
  app.add_option("--scheduling", arguments.scheduling,
                 "Scheduling policy. idle: run only while a processor would otherwise be idle; normal: run "
                 "like other programs, for a machine that is never idle")
      ->check(CLI::IsMember({"idle", "normal"}))
      ->capture_default_str();
  app.add_flag("--metrics", arguments.metrics,
               "Serve the fields of the service's status at /metrics, in the text format of Prometheus");
  add_states_channel_option(app, arguments.channels.states);
  add_wrenches_channel_option(app, arguments.channels.wrenches);
  add_hydrostatics_channel_option(app, arguments.channels.hydrostatics);
  add_loads_channel_option(app, arguments.channels.loads);
  add_status_channel_option(app, arguments.channels.status);
  add_sea_channel_option(app, arguments.channels.sea);
  add_sea_grid_channel_option(app, arguments.channels.sea_grid);
  add_condition_channel_option(app, arguments.channels.condition);
  add_viewer_channel_options(app, arguments.poses);
}

// Checks what CLI11 cannot check per option.
Expected<void> check_arguments(const Arguments& arguments) {
  const ObservedChannels& channels = arguments.channels;
  if (Expected<void> checked =
          check_channels_distinct({channels.states, channels.wrenches, channels.hydrostatics, channels.loads,
                                   channels.status, channels.sea, channels.sea_grid, channels.condition});
      !checked) {
    return checked;
  }
  if (Expected<void> checked = check_listen_address(arguments.address); !checked) return checked;
  return check_lcm_url(arguments.lcm_url);
}

int report(const CLI::App& app, const Error& error, ExitCode exit_code) {
  print_error(app, error);
  return exit_code;
}

int show(const CLI::App& app, const Arguments& arguments) {
  if (const Expected<void> checked = check_arguments(arguments); !checked) {
    return report(app, checked.error(), kUsageError);
  }
  const Expected<Scene> scene = Scene::load(arguments.scene);
  if (!scene) return report(app, scene.error(), kUsageError);
  for (const Warning& warning : mesh_warnings(*scene)) print_warning(app, warning);
  ObservedChannels channels = arguments.channels;
  Expected<PoseChannels> poses =
      resolve_pose_channels(arguments.poses, *scene,
                            {channels.states, channels.wrenches, channels.hydrostatics, channels.loads,
                             channels.status, channels.sea, channels.sea_grid, channels.condition});
  if (!poses) return report(app, poses.error(), kUsageError);
  channels.poses = *std::move(poses);
  Expected<std::vector<StaticResource>> page = live_page(*scene, BUOYANCY_VERSION, arguments.three);
  if (!page) return report(app, page.error(), kFailure);
  TerminationSignals termination;  // blocks the signals, so it precedes the start of any thread
  if (arguments.scheduling == "idle") use_idle_scheduling();
  SnapshotBroadcaster broadcaster;
  Expected<LiveView> view = LiveView::open(*scene, arguments.lcm_url, channels, broadcaster);
  if (!view) return report(app, view.error(), kFailure);
  if (view->buffer_warning()) print_warning(app, *view->buffer_warning());
  Metrics metrics;
  if (arguments.metrics) view->keep_metrics(metrics);
  const auto server = PageServer::start(arguments.address, arguments.port, std::move(*page), broadcaster, {},
                                        arguments.host_names, arguments.metrics ? &metrics : nullptr);
  if (!server) return report(app, server.error(), kFailure);

  if (!print_output(app, "ready: " + (*server)->url() + "\n")) return kFailure;
  view->run(termination, [&server] { return (*server)->serving(); });
  if (!(*server)->serving()) {
    return report(app,
                  {(*server)->url(), "cannot accept connections", "a working listening socket",
                   "out of memory or file descriptors", "Restart the view"},
                  kFailure);
  }
  return kSuccess;
}

int view_main(int argc, char** argv) {
  CLI::App app(
      R"(Show live LCM traffic between a buoyancy service and its clients in a browser: the bodies in
the water, latency, counters and losses. Nothing is published on LCM.
)" + exit_status_help(),
      "buoyancy-view");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return show(app, arguments);
}

}  // namespace
}  // namespace buoyancy::view

int main(int argc, char** argv) {
  return buoyancy::view::view_main(argc, argv);
}
