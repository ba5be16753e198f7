// buoyancy-replay: the program around replay().
#include <csignal>

#include <CLI/App.hpp>
#include <poll.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "cli/termination_signals.h"
#include "scene/scene.h"
#include "service/replay/replay.h"
#include "service/replay/replay_options.h"
#include "service/replay/replay_summary.h"

namespace buoyancy::service {
namespace {

constexpr int kMaxErrorsShown = 20;
// A constant, so that every replay writes the same bytes: "pose" in ASCII, which no client is likely to draw.
constexpr std::int64_t kFirstPoseSession = 0x706f736500000000;

// After a termination signal the program must not block on a reader of its standard output.
bool stdout_is_writable() {
  constexpr int kTimeoutMs = 1'000;
  pollfd writable{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&writable, 1, kTimeoutMs) != 0;
}

int run_replay(const CLI::App& app, const ReplayOptions& options, const ReplayTask& task) {
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes a write error with a message
  ProgressBar progress("requests");
  int errors = 0;
  const ReplayCallbacks callbacks{[&](const std::string& error) {
                                    ++errors;
                                    if (errors > kMaxErrorsShown) return;
                                    progress.clear();
                                    print_error(app, options.input.string() + ": " + error);
                                    if (errors == kMaxErrorsShown)
                                      print_error(app, "further errors are counted but not shown");
                                  },
                                  [&](std::int64_t done, std::int64_t total, std::int64_t requests) {
                                    progress.update(done, total, requests);
                                  }};
  const Expected<ReplaySummary> summary = replay(task, signals, callbacks);
  progress.clear();
  signals.unblock();  // writing the summary may block on its reader
  if (!summary) {
    print_error(app, summary.error());
    return kFailure;
  }
  if (*summary->stopped_by != '\0') {
    print_error(app, std::string("terminated by ") + summary->stopped_by + "; " + options.output.string() +
                         " holds the responses written until then");
  }
  if (*summary->stopped_by == '\0' && options.input.extension() == ".lcmlog") {
    for (const std::string& channel : task.channels.unseen_channels()) {
      print_error(app, Warning{"warning: channel " + channel, "no events in " + options.input.string(),
                               "requests or poses", "the channel has another name in the log",
                               "See --states-channel and --pose"});
    }
  }
  const std::string text =
      options.json ? summary_json(*summary, task.comparison) : summary_text(*summary, task.comparison);
  if (*summary->stopped_by != '\0' && !stdout_is_writable()) return kFailure;
  if (!print_output(app, text)) return kFailure;
  const bool agrees = task.comparison == nullptr || task.comparison->agrees();
  return summary->complete() && agrees ? kSuccess : kFailure;
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-replay");
  ReplayOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<ReplayPlan> plan = plan_replay(options);
  if (!plan) return fail(plan.error(), kUsageError);
  const Expected<Scene> scene =
      plan->single_mesh ? Scene::prepare(*plan->single_mesh) : Scene::load(options.scene);
  if (!scene) return fail(scene.error(), kUsageError);
  Expected<ReplayRoutes> routes = plan_routes(options, *scene);
  if (!routes) return fail(routes.error(), kUsageError);
  ReplayChannels& channels = routes->channels;
  PoseRequestAdapter poses(std::move(routes->poses), kFirstPoseSession);
  Expected<ReplayInput> input =
      ReplayInput::open(options.input, plan->input_format,
                        [&channels](std::string_view channel) { return channels.role_of(channel).any(); });
  if (!input) return fail(input.error(), kUsageError);
  std::optional<ReplayComparison> comparison;
  if (!options.baseline.empty()) {
    Expected<ReplayComparison> opened = ReplayComparison::open(options.baseline, options.wrenches_channel,
                                                               options.hydrostatics_channel, *scene);
    if (!opened) return fail(opened.error(), kUsageError);
    comparison = *std::move(opened);
  }
  Expected<ReplayOutput> output = ReplayOutput::create(options.output, plan->output_format);
  if (!output) return fail(output.error(), kFailure);
  return run_replay(app, options,
                    {.scene = *scene,
                     .input = *input,
                     .channels = channels,
                     .poses = poses,
                     .output = *output,
                     .layout = {plan->output_format, options.wrenches_channel, options.hydrostatics_channel},
                     .comparison = comparison ? &*comparison : nullptr,
                     .jobs = options.jobs});
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
