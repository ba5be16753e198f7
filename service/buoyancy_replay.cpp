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

namespace {

using namespace buoyancy;

constexpr int kWarningsShown = 20;
// The same in every replay: so are the bytes. "pose" in ASCII, which no client draws by any likelihood.
constexpr std::int64_t kFirstPoseSession = 0x706f736500000000;

// Of a program that a signal has ended nobody expects that it waits for a reader.
bool standard_output_has_room() {
  constexpr int kTimeoutMs = 1'000;
  pollfd writable{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&writable, 1, kTimeoutMs) != 0;
}

int response_all(const CLI::App& app, const ReplayOptions& options, const ReplayTask& task) {
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a reader of OUTPUT that goes away is a failed write, with its message
  ProgressBar progress("requests");
  int warnings = 0;
  const ReplayListener listener{[&](const std::string& warning) {
                                  ++warnings;
                                  if (warnings > kWarningsShown) return;
                                  progress.clear();
                                  print_error(app, options.input.string() + ": " + warning);
                                  if (warnings == kWarningsShown)
                                    print_error(app, "more of that is counted, not shown");
                                },
                                [&](std::int64_t done, std::int64_t total, std::int64_t requests) {
                                  progress.update(done, total, requests);
                                }};
  const Expected<ReplaySummary> summary = replay(task, signals, listener);
  progress.clear();
  signals.unblock();  // what follows may wait for a reader of the summary
  if (!summary) {
    print_error(app, summary.error());
    return kFailure;
  }
  if (*summary->stopped_by != '\0') {
    print_error(app, std::string("ended by ") + summary->stopped_by + "; " + options.output.string() +
                         " holds what was answered until then");
  }
  if (*summary->stopped_by == '\0' && options.input.extension() == ".lcmlog") {
    for (const std::string& channel : task.channels.unseen_channels()) {
      print_error(app, Error{"warning: channel " + channel, "no event of " + options.input.string(),
                             "requests or poses to answer", "the log has another name for it",
                             "See --states-channel and --pose"});
    }
  }
  const std::string text =
      options.json ? summary_json(*summary, task.comparison) : summary_text(*summary, task.comparison);
  if (*summary->stopped_by != '\0' && !standard_output_has_room()) return kFailure;
  if (!print_output(app, text)) return kFailure;
  const bool agrees = task.comparison == nullptr || task.comparison->agrees();
  return summary->complete() && agrees ? kSuccess : kFailure;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("", "buoyancy-replay");
  ReplayOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto refuse = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<ReplayPlan> plan = plan_replay(options);
  if (!plan) return refuse(plan.error(), kUsageError);
  const Expected<Scene> scene =
      plan->single_mesh ? Scene::prepare(*plan->single_mesh) : Scene::load(options.scene);
  if (!scene) return refuse(scene.error(), kUsageError);
  Expected<ReplayRoutes> routes = plan_routes(options, *scene);
  if (!routes) return refuse(routes.error(), kUsageError);
  ReplayChannels& channels = routes->channels;
  PoseRequestAdapter poses(std::move(routes->poses), kFirstPoseSession);
  Expected<ReplayInput> input =
      ReplayInput::open(options.input, plan->input_format,
                        [&channels](std::string_view channel) { return channels.use_of(channel).any(); });
  if (!input) return refuse(input.error(), kUsageError);
  std::optional<ReplayComparison> comparison;
  if (!options.earlier.empty()) {
    Expected<ReplayComparison> opened = ReplayComparison::open(options.earlier, options.wrenches_channel,
                                                               options.hydrostatics_channel, *scene);
    if (!opened) return refuse(opened.error(), kUsageError);
    comparison = *std::move(opened);
  }
  Expected<ReplayOutput> output = ReplayOutput::create(options.output, plan->output_format);
  if (!output) return refuse(output.error(), kFailure);
  return response_all(
      app, options,
      {.scene = *scene,
       .input = *input,
       .channels = channels,
       .poses = poses,
       .output = *output,
       .layout = {plan->output_format, options.wrenches_channel, options.hydrostatics_channel},
       .comparison = comparison ? &*comparison : nullptr,
       .jobs = options.jobs});
}
