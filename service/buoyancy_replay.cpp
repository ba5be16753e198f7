// buoyancy-replay: the program around replay().
#include <csignal>

#include <CLI/App.hpp>

#include "scene/scene.h"
#include "service/command_line.h"
#include "service/replay.h"
#include "service/replay_options.h"
#include "service/replay_summary.h"
#include "service/termination_signals.h"
#include "terminal/progress_bar.h"

namespace {

using namespace buoyancy;

constexpr int kTroublesShown = 20;

int answer_all(const CLI::App& app, const ReplayOptions& options, const Scene& scene, ReplayInput& input,
               ReplayOutput& output) {
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a reader of OUTPUT that goes away is a failed write, with its message
  ProgressBar progress("questions");
  int troubles = 0;
  const ReplayListener listener{[&](const std::string& trouble) {
                                  ++troubles;
                                  if (troubles > kTroublesShown) return;
                                  progress.clear();
                                  print_error(app, options.input.string() + ": " + trouble);
                                  if (troubles == kTroublesShown)
                                    print_error(app, "more of that is counted, not shown");
                                },
                                [&](std::int64_t done, std::int64_t total, std::int64_t questions) {
                                  progress.update(done, total, questions);
                                }};
  const Expected<ReplaySummary> summary = replay(scene, input, output, signals, listener);
  progress.clear();
  if (!summary) {
    print_error(app, summary.error());
    return kFailed;
  }
  if (*summary->ended_by != '\0') {
    print_error(app, std::string("ended by ") + summary->ended_by + "; " + options.output.string() +
                         " holds what was answered until then");
  }
  if (!print_output(app, options.json ? summary_json(*summary) : summary_text(*summary))) return kFailed;
  return summary->complete() ? kDone : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("", "buoyancy-replay");
  ReplayOptions options;
  declare_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  const auto refuse = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<ReplayPlan> plan = plan_replay(options);
  if (!plan) return refuse(plan.error(), kWrongInput);
  const Expected<Scene> scene =
      plan->single_mesh ? Scene::prepare(*plan->single_mesh) : Scene::load(options.scene);
  if (!scene) return refuse(scene.error(), kWrongInput);
  Expected<ReplayInput> input = ReplayInput::open(options.input, plan->input_format, options.states_channel);
  if (!input) return refuse(input.error(), kWrongInput);
  Expected<ReplayOutput> output = ReplayOutput::create(
      options.output, plan->output_format, {options.wrenches_channel, options.hydrostatics_channel});
  if (!output) return refuse(output.error(), kFailed);
  return answer_all(app, options, *scene, *input, *output);
}
