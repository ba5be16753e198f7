// buoyancy-replay: the program around replay().
#include <csignal>

#include <CLI/App.hpp>
#include <poll.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "cli/termination_signals.h"
#include "recording/file_window.h"
#include "scene/mesh_warnings.h"
#include "scene/scene.h"
#include "service/replay/channel_list.h"
#include "service/replay/earlier_conditions.h"
#include "service/replay/part_output.h"
#include "service/replay/replay.h"
#include "service/replay/replay_join.h"
#include "service/replay/replay_options.h"
#include "service/replay/replay_summary.h"

namespace buoyancy::service {
namespace {

constexpr std::size_t kMaxErrorsShown = 20;
// A constant, so that every replay writes the same bytes: "pose" in ASCII, which no client is likely to draw.
constexpr std::int64_t kFirstPoseSession = 0x706f736500000000;

// After a termination signal the program must not block on a reader of its standard output.
bool stdout_is_writable() {
  constexpr int kTimeoutMs = 1'000;
  pollfd writable{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&writable, 1, kTimeoutMs) != 0;
}

// Prints the first input errors and keeps them for a manifest.
class InputErrors {
 public:
  InputErrors(const CLI::App& app, const std::filesystem::path& input) : app_(&app), input_(input.string()) {}

  void add(const std::string& error) {
    if (first_.size() == kMaxErrorsShown) return;
    first_.push_back(error);
    print_error(*app_, input_ + ": " + error);
    if (first_.size() == kMaxErrorsShown) print_error(*app_, "further errors are counted but not shown");
  }
  bool shows_next() const { return first_.size() < kMaxErrorsShown; }
  const std::vector<std::string>& first() const { return first_; }

 private:
  const CLI::App* app_;
  std::string input_;
  std::vector<std::string> first_;
};

void warn_of_unseen(const CLI::App& app, const ReplayOptions& options,
                    const std::vector<std::string>& channels) {
  if (channels.empty()) return;
  const Expected<ChannelList> list = list_channels(options.input, FileFormat::kLcmLog, {});
  const std::string held = list ? ". The log has " + list_line(*list) : "";
  for (const std::string& channel : channels) {
    print_error(app, Warning{"warning: channel " + channel, "no events in " + options.input.string(),
                             "requests or poses", "the channel has another name in the log",
                             "See --states-channel and --pose" + held});
  }
}

void warn_of_missing_velocities(const CLI::App& app, const ReplayOptions& options, const ReplayTask& task) {
  const std::vector<PoseChannel>& channels = task.poses.channels();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const Body* const body = task.scene.find(channels[i].body_id);
    if (task.poses.without_velocities(i) == 0 || body->hydrodynamics == nullptr) continue;
    print_warning(app, Warning{"channel " + channels[i].channel,
                               std::to_string(task.poses.without_velocities(i)) + " poses in " +
                                   options.input.string() + " without velocities",
                               "velocities, since body '" + body->name + "' has drag or added mass", "",
                               kMissingVelocitiesRemedy});
  }
}

// part: nullptr for a replay of the whole.
int run_replay(const CLI::App& app, const ReplayOptions& options, const ReplayTask& task, PartOutput* part) {
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes a write error with a message
  ProgressBar progress("requests");
  InputErrors errors(app, options.input);
  const ReplayCallbacks callbacks{[&](const std::string& error) {
                                    if (errors.shows_next()) progress.clear();
                                    errors.add(error);
                                  },
                                  [&](std::int64_t done, std::int64_t total, std::int64_t requests) {
                                    progress.update(done, total, requests);
                                  }};
  const Expected<ReplaySummary> summary = replay(task, signals, callbacks);
  progress.clear();
  const bool stopped = summary && *summary->stopped_by != '\0';
  Expected<void> completed;
  if (part != nullptr && summary && !stopped) completed = part->complete(task, *summary, errors.first());
  signals.unblock();  // writing the summary may block on its reader
  if (!summary || !completed) {
    print_error(app, summary ? completed.error() : summary.error());
    return kFailure;
  }
  if (stopped) {
    print_error(app, std::string("terminated by ") + summary->stopped_by +
                         (part != nullptr
                              ? "; nothing was kept of part " + options.part + ": run it again"
                              : "; " + options.output.string() + " holds the responses written until then"));
  }
  if (!stopped) warn_of_missing_velocities(app, options, task);
  for (const std::string& doubt : summary->doubts) print_error(app, "warning: " + doubt);
  // A channel without events in one part may have some in another: the join warns if there are none in any.
  if (!stopped && part == nullptr && task.input.format() == FileFormat::kLcmLog)
    warn_of_unseen(app, options, task.channels.unseen_channels());
  const std::string text =
      options.json ? summary_json(*summary, task.comparison) : summary_text(*summary, task.comparison);
  if (stopped && !stdout_is_writable()) return kFailure;
  if (!print_output(app, text)) return kFailure;
  // A part need not be run again for errors of its input, which the join reports: it succeeds once complete.
  if (part != nullptr) return stopped ? kFailure : kSuccess;
  const bool agrees = task.comparison == nullptr || task.comparison->agrees();
  return summary->complete() && agrees ? kSuccess : kFailure;
}

int run_list(const CLI::App& app, const ReplayOptions& options) {
  if (const Expected<void> checked = check_list(app, options); !checked) {
    print_error(app, checked.error());
    return kUsageError;
  }
  const Expected<ChannelList> list =
      list_channels(options.input, input_format(options), table_options(options));
  if (!list) {
    print_error(app, list.error());
    return kUsageError;
  }
  if (!print_output(app, options.json ? list_json(*list) : list_text(*list))) return kFailure;
  return list->corrupt_sections == 0 ? kSuccess : kFailure;
}

// Says which format was found in a file of another program's poses, and whose poses they are.
void print_table(const CLI::App& app, const ReplayOptions& options, const Scene& scene,
                 const ReplayInput& input) {
  if (!input.body()) return;
  const Body& body = *scene.find(*input.body());
  print_error(app, options.input.string() + ": " + input.table()->description() + "; poses of body '" +
                       body.name + "' (id " + std::to_string(body.id) + ")");
}

int run_join(const CLI::App& app, const ReplayOptions& options) {
  if (const Expected<void> checked = check_join(app, options); !checked) {
    print_error(app, checked.error());
    return kUsageError;
  }
  Expected<FileWindow> input = FileWindow::open(options.input);
  if (!input) {
    print_error(app, input.error());
    return kUsageError;
  }
  ProgressBar progress("MB");
  const Expected<JoinResult> joined = join_parts(
      options.join, std::move(*input), options.output,
      [&progress](std::int64_t done, std::int64_t total) { progress.update(done, total, done / 1'000'000); });
  progress.clear();
  if (!joined) {
    print_error(app, joined.error());
    return kFailure;
  }
  InputErrors errors(app, options.input);
  for (const std::string& error : joined->input_errors) errors.add(error);
  warn_of_unseen(app, options, joined->unseen_channels);
  const ReplaySummary& summary = joined->summary;
  if (!print_output(app, options.json ? summary_json(summary, nullptr) : summary_text(summary, nullptr))) {
    return kFailure;
  }
  return summary.complete() ? kSuccess : kFailure;
}

// Restricts the input to a part. Returns the conditions of compartments and tanks where it begins. The
// channels that are read to find them, and to find the beginning of the part, are not seen in it.
Expected<ConditionTimeline> restrict_input(const ReplayOptions& options, const Part& part,
                                           const ReplayFacts& facts, const Scene& scene, ReplayInput& input,
                                           ReplayChannels& channels) {
  const ReplayChannels unseen = channels;
  const Expected<void> restricted = input.restrict_to(part, end_of_part_before(part, options.output, facts));
  if (!restricted) return make_error(restricted.error());
  Expected<ConditionTimeline> conditions(scene);
  if (input.begin() > 0 && input.format() == FileFormat::kLcmLog && scene.bodies_with_subdivision() > 0) {
    conditions = conditions_before(input.begin(), options.input, channels, scene);
  }
  channels = unseen;
  return conditions;
}

int run(int argc, char** argv) {
  CLI::App app("", "buoyancy-replay");
  ReplayOptions options;
  add_options(app, options);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  if (options.list) return run_list(app, options);
  if (options.join > 0) return run_join(app, options);
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  const Expected<ReplayPlan> plan = plan_replay(options);
  if (!plan) return fail(plan.error(), kUsageError);
  const Expected<Scene> scene =
      plan->single_mesh ? Scene::prepare(*plan->single_mesh) : Scene::load(options.scene);
  if (!scene) return fail(scene.error(), kUsageError);
  const UpAxisCheck up{.remedy = plan->single_mesh ? UpRemedy::kOption : UpRemedy::kNone};
  for (const Warning& warning : mesh_warnings(*scene, up)) print_warning(app, warning);
  Expected<ReplayRoutes> routes = plan_routes(options, *scene);
  if (!routes) return fail(routes.error(), kUsageError);
  ReplayChannels& channels = routes->channels;
  PoseRequestAdapter poses(std::move(routes->poses), kFirstPoseSession);
  Expected<ReplayInput> input = ReplayInput::open(
      options.input, plan->input_format,
      [&channels](std::string_view channel) { return channels.role_of(channel).any(); },
      table_options(options));
  if (!input) return fail(input.error(), kUsageError);
  if (const Expected<void> chosen = choose_body(options, *scene, *input); !chosen) {
    return fail(chosen.error(), kUsageError);
  }
  if (const Expected<void> checked = check_velocity_columns(*input, options, *scene); !checked) {
    return fail(checked.error(), kUsageError);
  }
  print_table(app, options, *scene, *input);
  const OutputLayout layout{plan->output_format,           options.wrenches_channel,
                            options.hydrostatics_channel,  options.loads_channel,
                            options.water_samples_channel, !options.loads.empty()};
  std::optional<ReplayComparison> comparison;
  if (!options.baseline.empty()) {
    Expected<ReplayComparison> opened = ReplayComparison::open(options.baseline, layout, *scene);
    if (!opened) return fail(opened.error(), kUsageError);
    comparison = *std::move(opened);
  }
  ConditionTimeline conditions(*scene);
  const auto run_with = [&](ReplayOutput& output, ReplayOutput* loads, PartOutput* part) {
    return run_replay(app, options,
                      {.scene = *scene,
                       .input = *input,
                       .channels = channels,
                       .poses = poses,
                       .output = output,
                       .layout = layout,
                       .loads = loads,
                       .comparison = comparison ? &*comparison : nullptr,
                       .jobs = options.jobs,
                       .conditions = &conditions},
                      part);
  };
  if (plan->part) {
    const Expected<ReplayFacts> facts = replay_facts(options, *scene, poses.channels(), input->size());
    if (!facts) return fail(facts.error(), kUsageError);
    Expected<ConditionTimeline> earlier =
        restrict_input(options, *plan->part, *facts, *scene, *input, channels);
    if (!earlier) return fail(earlier.error(), kUsageError);
    conditions = *std::move(earlier);
    Expected<PartOutput> part = PartOutput::create(options.output, plan->output_format, *plan->part, *facts);
    if (!part) return fail(part.error(), kFailure);
    return run_with(part->responses(), nullptr, &*part);
  }
  Expected<ReplayOutput> output = ReplayOutput::create(options.output, plan->output_format);
  if (!output) return fail(output.error(), kFailure);
  if (options.loads.empty()) return run_with(*output, nullptr, nullptr);
  Expected<ReplayOutput> loads = ReplayOutput::create_loads(options.loads);
  if (!loads) return fail(loads.error(), kFailure);
  return run_with(*output, &*loads, nullptr);
}

}  // namespace
}  // namespace buoyancy::service

int main(int argc, char** argv) {
  return buoyancy::service::run(argc, argv);
}
