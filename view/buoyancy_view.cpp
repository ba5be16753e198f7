// buoyancy-view: shows in a browser what a buoyancy service and its clients say to each other. Exit codes: 0
// ended by SIGINT or SIGTERM, 1 it ran and failed, 2 wrong arguments, scene or mesh.

#include <string>
#include <utility>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "cli/command_line.h"
#include "cli/pose_options.h"
#include "cli/termination_signals.h"
#include "scene/scene.h"
#include "transport/lcm_connection.h"
#include "view/common/page_assets.h"
#include "view/live/live_page.h"
#include "view/live/live_view.h"
#include "view/live/page_server.h"

namespace buoyancy {
namespace {

struct Arguments {
  std::string scene;
  std::string lcm_url;
  std::string address = "127.0.0.1";
  int port = 8667;
  std::string three = kThreeJs;
  std::string scheduling = "idle";
  WatchedChannels channels;
  PoseOptions poses;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", "buoyancy-view " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "Scene file: what the service loaded")->required();
  app.add_option("-l,--lcm-url", arguments.lcm_url, "LCM URL (default: $LCM_DEFAULT_URL, else LCM's own)");
  app.add_option("--port", arguments.port, "Port of the page; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->option_text("PORT [8667]");
  app.add_option("--listen", arguments.address,
                 "Address to serve the page on. Whoever reaches another than a loopback's sees the scene and "
                 "the run: there is no password")
      ->option_text("ADDRESS [127.0.0.1]");
  app.add_option("--three", arguments.three, "three.js, which draws the bodies: a three.min.js")
      ->option_text("FILE [" + std::string(kThreeJs) + "]");
  app.add_option(
         "--scheduling", arguments.scheduling,
         "When to run. idle: only while a processor would otherwise be idle. normal: as other programs, "
         "for a machine that is never idle")
      ->check(CLI::IsMember({"idle", "normal"}))
      ->option_text("POLICY [idle]");
  app.add_option("--states-channel", arguments.channels.states, "Channel of the requests")
      ->capture_default_str();
  app.add_option("--wrenches-channel", arguments.channels.wrenches, "Channel of the responses")
      ->capture_default_str();
  app.add_option("--hydrostatics-channel", arguments.channels.hydrostatics, "Channel of the hydrostatics")
      ->capture_default_str();
  app.add_option("--status-channel", arguments.channels.status, "Channel of the service's status")
      ->capture_default_str();
  add_pose_channel_options(app, arguments.poses);
}

// What no single option shows.
Expected<void> check_arguments(const Arguments& arguments) {
  const WatchedChannels& channels = arguments.channels;
  if (Expected<void> checked = check_channels_distinct(
          {channels.states, channels.wrenches, channels.hydrostatics, channels.status});
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
  WatchedChannels channels = arguments.channels;
  Expected<PoseChannels> poses = pose_channels(
      arguments.poses, *scene, {channels.states, channels.wrenches, channels.hydrostatics, channels.status});
  if (!poses) return report(app, poses.error(), kUsageError);
  channels.poses = *std::move(poses);
  Expected<std::vector<StaticResource>> page = live_page(*scene, BUOYANCY_VERSION, arguments.three);
  if (!page) return report(app, page.error(), kFailure);
  TerminationSignals termination;  // before any thread is started, which must not get them
  if (arguments.scheduling == "idle") use_idle_scheduling();
  SnapshotBroadcaster hub;
  Expected<LiveView> view = LiveView::open(*scene, arguments.lcm_url, channels, hub);
  if (!view) return report(app, view.error(), kFailure);
  const auto server = PageServer::start(arguments.address, arguments.port, std::move(*page), hub);
  if (!server) return report(app, server.error(), kFailure);

  if (!print_output(app, "ready: " + (*server)->url() + "\n")) return kFailure;
  view->run(termination, [&server] { return (*server)->serving(); });
  if (!(*server)->serving()) {
    return report(app,
                  {(*server)->url(), "the kernel gives no more connections", "a port that lasts",
                   "memory or file descriptors are at their end", "Start the view again"},
                  kFailure);
  }
  return kSuccess;
}

int view_main(int argc, char** argv) {
  CLI::App app(
      "Shows in a browser what a buoyancy service and its clients say to each other on LCM: the bodies in "
      "the "
      "water,\n"
      "latency, counters, losses. Only listens.\n"
      "Exit codes: 0 done (SIGINT and SIGTERM end it), 1 it ran and failed, 2 wrong arguments, scene or "
      "mesh.",
      "buoyancy-view");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return show(app, arguments);
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::view_main(argc, argv);
}
