// buoyancyd: the program around Daemon.
#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

#include <CLI/App.hpp>

#include "cli/command_line.h"
#include "cli/logging.h"
#include "cli/signal_fd.h"
#include "cli/termination_signals.h"
#include "scene/scene.h"
#include "scene/scene_report.h"
#include "service/daemon/daemon.h"
#include "service/daemon/daemon_options.h"
#include "service/daemon/message_sizes.h"

namespace buoyancy::service {
namespace {

int serve(const CLI::App& app, const DaemonOptions& options, Scene scene, PoseChannels poses,
          SignalFd& reload) {
  // Blocks the signals before Daemon starts the scene-loader thread, which inherits the mask.
  TerminationSignals termination;
  Expected<LcmConnection> connection =
      LcmConnection::open(options.lcm_url, {.receive_own = false, .spin = !options.no_spin});
  if (!connection) {
    print_error(app, connection.error());
    return kFailure;
  }
  Daemon daemon(std::make_unique<const Scene>(std::move(scene)), std::move(*connection), options.mode,
                options.channels, std::move(poses), options.threads);
  if (options.inject) daemon.inject_faults(parse_faults(*options.inject).value());  // as check_options() did
  ExitCode exit_code = kSuccess;
  if (const Expected<void> ended = daemon.run(termination, reload); !ended) {
    print_error(app, ended.error());
    exit_code = kFailure;
  }
  // A load is in progress: exit without joining its thread; the import child dies with it (PR_SET_PDEATHSIG).
  if (daemon.is_loading()) std::_Exit(exit_code);
  return exit_code;
}

// Reports why the scene cannot be used, with a report of each mesh that is refused.
int report_failure(const CLI::App& app, const DaemonOptions& options, const Error& error,
                   const std::vector<RefusedMesh>& refused) {
  if (refused.empty()) {
    print_error(app, error);
    return kUsageError;
  }
  print_output(app, options.json ? refused_meshes_json(refused) : refused_meshes_text(refused));
  for (const RefusedMesh& mesh : refused) print_error(app, mesh.error);
  return kUsageError;
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancyd");
  DaemonOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  if (const Expected<void> checked = check_options(options); !checked) {
    print_error(app, checked.error());
    return kUsageError;
  }
  init_logging("buoyancyd", options.log_level);

  std::optional<SignalFd> reload;
  if (!options.check) reload.emplace(std::initializer_list<int>{SIGHUP});  // kept pending during the load
  std::vector<RefusedMesh> refused;
  Expected<Scene> scene = Scene::load(options.scene, {.count_intersecting_pairs = options.check,
                                                      .refused = options.check ? &refused : nullptr});
  if (!scene) return report_failure(app, options, scene.error(), refused);
  const ChannelNames& channels = options.channels;
  Expected<PoseChannels> poses =
      resolve_pose_channels(options.poses, *scene,
                            {channels.states, channels.wrenches, channels.hydrostatics, channels.loads,
                             channels.sea, channels.sea_grid, channels.condition, channels.water_points,
                             channels.water_samples, channels.status});
  if (!poses) {
    print_error(app, poses.error());
    return kUsageError;
  }
  if (const Expected<void> checked = check_velocities_usable(*poses, *scene); !checked) {
    print_error(app, checked.error());
    return kUsageError;
  }
  if (options.check) {
    const LargestMessages messages = largest_messages(*scene, channels);
    const std::optional<ReceiveBuffer> buffer = expected_receive_buffer(messages, options.lcm_url);
    const std::string report = options.json ? check_report_json(*scene, messages, buffer, options.drafts)
                                            : check_report_text(*scene, messages, buffer, options.drafts);
    return print_output(app, report) ? kSuccess : kFailure;
  }
  return serve(app, options, std::move(*scene), std::move(*poses), *reload);
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
