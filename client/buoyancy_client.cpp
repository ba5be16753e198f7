// buoyancy-client: simulates the bodies of a scene that have a [body.client]. The wrenches come from a
// buoyancy service or from the same request handler in this process. Exit codes: 0 the run is complete, 1 it
// failed or was interrupted, 2 invalid arguments, scene or mesh.

#include <chrono>
#include <cmath>
#include <csignal>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/channel_options.h"
#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "cli/termination_signals.h"
#include "client/client.h"
#include "scene/mesh_warnings.h"
#include "scene/scene_fingerprint.h"
#include "simulation/run_csv_writer.h"
#include "simulation/run_summary.h"
#include "simulation/run_warnings.h"
#include "simulation/simulation.h"

namespace buoyancy {
namespace {

constexpr double kMaxSteps = 1e15;  // integers up to this value are exact as doubles
constexpr std::int64_t kMaxCount = std::int64_t{1} << 40U;
constexpr std::int64_t kMaxDelaySteps = 10000;  // bounds the number of responses that are kept
// Signals are checked only this often: a check is a system call, which is slow beside a small body's step.
constexpr std::chrono::milliseconds kSignalInterval{10};

struct Arguments {
  std::string scene;
  ChannelOptions channel;
  RetryPolicy retry_policy;
  bool embedded = false;
  bool no_spin = false;
  double duration = 10.0;  // [s]
  std::optional<double> step;
  std::optional<double> rate;  // [Hz]
  std::string csv;
  std::int64_t csv_every = 1;
  std::string integrator{to_string(Integrator::kVelocityVerlet)};
  double lead_time = 0.0;
  std::int64_t delay_steps = 0;
  std::optional<std::int64_t> session;
  bool json = false;
};

void add_options(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", "buoyancy-client " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "Scene file (TOML): water and bodies")->required();
  auto* url = add_lcm_url_option(app, arguments.channel.lcm_url);
  auto* embedded = app.add_flag("--embedded", arguments.embedded,
                                "Compute wrenches in this process, without a network or buoyancyd");
  embedded->excludes(url);
  app.add_option("--duration", arguments.duration, "Simulated time in seconds")
      ->check(number_in(0.0, 1e9, "S"))
      ->capture_default_str();
  app.add_option("--step", arguments.step, "Time step in seconds")
      ->check(number_in(0.0, 1e6, "S"))
      ->default_str("0.001, or 1/HZ with --rate");
  auto* rate =
      app.add_option(
             "--rate", arguments.rate,
             "Free-running mode: steps per wall-clock second, using the newest response available; without "
             "this option lock-step mode, as fast as responses arrive")
          ->check(number_in(0.0, 1e6, "HZ"))
          ->excludes(embedded);
  app.add_option("--csv", arguments.csv, "Write states and wrenches to this CSV file");
  app.add_option("--csv-every", arguments.csv_every, "Write only every Nth step to the CSV file")
      ->check(CLI::Range(std::int64_t{1}, kMaxCount, "N"))
      ->capture_default_str();
  app.add_option("--integrator", arguments.integrator, "Integration method")
      ->check(CLI::IsMember({std::string(to_string(Integrator::kSemiImplicitEuler)),
                             std::string(to_string(Integrator::kVelocityVerlet))}))
      ->capture_default_str();
  add_lead_time_option(app, arguments.lead_time, "the requested poses")->check(number_in(-1e3, 1e3, "S"));
  const CLI::Range delay_range(std::int64_t{0}, kMaxDelaySteps, "STEPS");
  app.add_option("--delay-steps", arguments.delay_steps,
                 "Use every response this many steps late, reproducibly, to simulate a "
                 "simulator that does not wait for responses")
      ->check(delay_range)
      ->excludes(rate)
      ->capture_default_str();
  add_timeout_option(app, arguments.retry_policy.timeout);
  add_retries_option(app, arguments.retry_policy.max_retries, "the run fails");
  add_states_channel_option(app, arguments.channel.states_channel);
  add_wrenches_channel_option(app, arguments.channel.wrenches_channel);
  add_status_channel_option(app, arguments.channel.status_channel);
  add_condition_channel_option(app, arguments.channel.condition_channel)
      ->description("LCM channel for the events of the scene (body_condition_t)");
  app.add_flag("--no-spin", arguments.no_spin,
               "Block immediately while waiting for a response instead of spinning for up to 50 us first: "
               "uses less processor time, but each step takes longer")
      ->excludes(embedded);
  app.add_option("--session", arguments.session,
                 "Session id sent with every request; set it to make two runs send identical bytes")
      ->default_str("random");
  app.add_flag("--json", arguments.json, "Print the summary as JSON");
}

// Checks combinations of arguments.
Expected<void> check_arguments(const Arguments& arguments, double steps) {
  if (steps > kMaxSteps) {
    return make_error({"--duration and --step", std::to_string(steps) + " steps", "at most 1e15", "", ""});
  }
  const ChannelOptions& channel = arguments.channel;
  if (Expected<void> checked = check_channels_distinct({channel.states_channel, channel.wrenches_channel,
                                                        channel.condition_channel, channel.status_channel});
      !checked) {
    return checked;
  }
  return check_lcm_url(channel.lcm_url);
}

// bodies: number of bodies in a request. Sets warning if the responses may be lost.
Expected<SimulationClient> make_client(const Arguments& arguments, const Scene& scene, std::size_t bodies,
                                       std::optional<Warning>& warning) {
  if (arguments.embedded) return SimulationClient(InProcessClient(scene));
  ChannelOptions options = arguments.channel;
  options.scene_fingerprint = scene_fingerprint(scene);
  Expected<LcmRequestChannel> channel = LcmRequestChannel::open(options);
  if (!channel) return make_error(channel.error());
  Expected<std::optional<Warning>> reserved = channel->reserve(bodies);
  if (!reserved) return make_error(reserved.error());
  warning = std::move(*reserved);
  if (!arguments.rate) return SimulationClient(LockstepClient(std::move(*channel), arguments.retry_policy));
  return SimulationClient(
      FreeRunningClient(std::move(*channel), arguments.retry_policy, 1.0 / *arguments.rate));
}

int simulate(const CLI::App& app, Arguments arguments) {
  const auto fail = [&app](const Error& error, ExitCode exit_code) {
    print_error(app, error);
    return exit_code;
  };
  arguments.channel.spin = !arguments.no_spin;
  SimulationOptions options;
  options.step = arguments.step.value_or(arguments.rate ? 1.0 / *arguments.rate : options.step);
  options.integrator = *integrator_from_name(arguments.integrator);
  options.lead_time = arguments.lead_time;
  options.delay_steps = arguments.delay_steps;
  options.session_id = arguments.session.value_or(make_session_id());
  const double steps_requested = std::round(arguments.duration / options.step);
  if (const Expected<void> checked = check_arguments(arguments, steps_requested); !checked) {
    return fail(checked.error(), kUsageError);
  }
  const auto steps = static_cast<std::int64_t>(steps_requested);

  const Expected<Scene> scene = Scene::load(arguments.scene);
  if (!scene) return fail(scene.error(), kUsageError);
  if (arguments.embedded && scene->receives_sea()) {
    return fail({"--embedded", std::string("a scene with ") + to_string(scene->sea_messages()),
                 "a scene that describes its waves", "nothing is received without a network",
                 "Run buoyancyd, or describe the waves in the scene"},
                kUsageError);
  }
  Expected<Simulation> simulation = Simulation::make(*scene, options);
  if (!simulation) return fail(simulation.error(), kUsageError);
  std::optional<RunCsvWriter> csv;
  if (!arguments.csv.empty()) {
    const Expected<void> distinct = check_output_not_input(arguments.csv, {arguments.scene});
    if (!distinct) return fail(distinct.error(), kUsageError);
    Expected<RunCsvWriter> created = RunCsvWriter::create(arguments.csv, arguments.csv_every);
    if (!created) return fail(created.error(), kFailure);
    csv = std::move(*created);
  }
  TerminationSignals signals;
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe becomes a write error with a message
  if (csv) csv->give_up_after(signals.fileno());
  bool stopped = false;
  Clock::time_point look_at;
  const auto is_stopped = [&] {
    if (const Clock::time_point now = Clock::now(); now >= look_at) {
      stopped = signals.pending();
      look_at = now + kSignalInterval;
    }
    return stopped;
  };
  arguments.channel.is_interrupted = is_stopped;
  std::optional<Warning> size_warning;
  Expected<SimulationClient> client =
      make_client(arguments, *scene, simulation->bodies().size(), size_warning);
  if (!client) return fail(client.error(), kFailure);

  RunSummary summary;
  const auto warn = [&](std::optional<Warning> warning) {
    if (!warning) return;
    print_warning(app, *warning);
    summary.warnings.push_back(std::move(*warning));
  };
  for (Warning& warning : mesh_warnings(*scene)) warn(std::move(warning));
  warn(std::move(size_warning));
  warn(step_warning(*simulation));
  warn(latency_warning(*simulation, static_cast<double>(options.delay_steps) * options.step));
  warn(received_sea_warning(*simulation));
  LatencyMonitor latency;
  BedMonitor bed;
  bool has_other_scene = false;

  const Clock::time_point start = Clock::now();
  Expected<RunOutcome> outcome = RunOutcome::kCompleted;
  {
    ProgressBar progress("steps");
    outcome = run(*simulation, *client, steps, is_stopped, [&](const Simulation& now) -> Expected<void> {
      progress.update(now.step_number(), steps, now.step_number());
      if (arguments.rate) {
        if (std::optional<Warning> warning = latency.update(now)) {
          progress.clear();
          warn(std::move(warning));
        }
      }
      if (const Warning* const other_scene = scene_warning(*client);
          other_scene != nullptr && !has_other_scene) {
        has_other_scene = true;
        progress.clear();
        warn(*other_scene);
      }
      for (Warning& warning : bed.update(now)) {
        progress.clear();
        warn(std::move(warning));
      }
      return csv ? csv->write(now) : Expected<void>{};
    });
  }
  const double wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  const Expected<void> flushed = csv ? csv->flush() : Expected<void>{};
  signals.unblock();  // writing the summary may block on its reader
  if (!outcome) return fail(outcome.error(), kFailure);
  if (!flushed) return fail(flushed.error(), kFailure);

  warn(energy_warning(*simulation));
  summary.steps = simulation->completed_steps();
  summary.steps_requested = steps;
  summary.interrupted = *outcome == RunOutcome::kInterrupted;
  summary.time = static_cast<double>(summary.steps) * options.step;
  summary.wall_time = wall_time;
  summary.options = options;
  for (const SimulatedBody& body : simulation->bodies()) {
    summary.bodies.push_back(summarize(body, simulation->water()));
  }
  summary.client = statistics(*client);
  if (!print_output(app, arguments.json ? to_json(summary) : to_text(summary))) return kFailure;
  return summary.interrupted ? kFailure : kSuccess;
}

int client_main(int argc, char** argv) {
  CLI::App app("Simulate the bodies of a scene that have a [body.client], with wrenches from buoyancyd.\n" +
                   exit_status_help(
                       {.success = "if the run is complete",
                        .failure = "on a runtime error or an interruption by SIGINT or SIGTERM (the summary "
                                   "and the CSV then cover the completed steps)"}),
               "buoyancy-client");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return simulate(app, std::move(arguments));
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::client_main(argc, argv);
}
