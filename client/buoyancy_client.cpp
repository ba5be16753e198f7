// buoyancy-client: simulates the bodies of a scene that have a [body.client] and asks a buoyancy service, or
// the same handler in its own process, for the wrenches on them. Exit codes: 0 the run is complete, 1 it
// failed or was interrupted, 2 wrong arguments, scene or mesh.

#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <signal.h>

#include "cli/command_line.h"
#include "cli/progress_bar.h"
#include "client/client.h"
#include "simulation/run_csv_writer.h"
#include "simulation/run_summary.h"
#include "simulation/run_warnings.h"
#include "simulation/simulation.h"

namespace buoyancy {
namespace {

constexpr double kMaxSteps = 1e15;  // whole numbers up to here are exact as doubles
constexpr std::int64_t kMaxCount = std::int64_t{1} << 40U;
constexpr std::int64_t kMaxLateSteps = 10000;  // so many answers are kept

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler writes it");

void request_stop(int /*signal*/) {
  stop_requested.store(true);
}

struct Arguments {
  std::string scene;
  ChannelOptions channel;
  RetryPolicy retry_policy;
  bool embedded = false;
  bool no_spin = false;
  double duration = 10.0;  // s
  std::optional<double> step;
  std::optional<double> rate;  // Hz
  std::string csv;
  std::int64_t csv_every = 1;
  std::string integrator{to_string(Integrator::kVelocityVerlet)};
  double lead_time = 0.0;
  std::int64_t delay_steps = 0;
  std::optional<std::int64_t> session;
  bool json = false;
};

// A number above `low` and at most `high`; CLI::Range would let NaN pass.
CLI::Validator number_in(double low, double high, const std::string& unit) {
  const auto check = [low, high](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc{} && end == text.data() + text.size();
    if (is_number && value > low && value <= high) return "";
    std::array<char, 128> wrong{};
    std::snprintf(wrong.data(), wrong.size(), "%.40s is not a number above %g and at most %g", text.c_str(),
                  low, high);
    return wrong.data();
  };
  return {check, unit};
}

void add_options(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", "buoyancy-client " BUOYANCY_VERSION);
  app.add_option("--scene", arguments.scene, "Scene file")->required();
  auto* url = app.add_option("-l,--lcm-url", arguments.channel.lcm_url,
                             "LCM URL (default: $LCM_DEFAULT_URL, else LCM's own)");
  auto* embedded = app.add_flag("--embedded", arguments.embedded,
                                "Answer in this process, without a network and without buoyancyd");
  embedded->excludes(url);
  app.add_option("--duration", arguments.duration, "Simulated time, s")
      ->check(number_in(0.0, 1e9, "S"))
      ->capture_default_str();
  app.add_option("--step", arguments.step, "Time step, s (default: 0.001; with --rate: its inverse)")
      ->check(number_in(0.0, 1e6, "S"));
  auto* rate =
      app.add_option(
             "--rate", arguments.rate,
             "Run freely at this many steps per second of wall-clock time, with the newest response there is "
             "(default: lock-step, as fast as responses come)")
          ->check(number_in(0.0, 1e6, "HZ"))
          ->excludes(embedded);
  app.add_option("--csv", arguments.csv, "Write states and wrenches to this file");
  app.add_option("--csv-every", arguments.csv_every, "Write only every Nth step")
      ->check(CLI::Range(std::int64_t{1}, kMaxCount, "N"))
      ->capture_default_str();
  app.add_option("--integrator", arguments.integrator, "How bodies are moved")
      ->check(CLI::IsMember({std::string(to_string(Integrator::kSemiImplicitEuler)),
                             std::string(to_string(Integrator::kVelocityVerlet))}))
      ->capture_default_str();
  app.add_option("--lead-time", arguments.lead_time,
                 "Have the wrench evaluated at the pose extrapolated by this many seconds")
      ->check(number_in(-1e3, 1e3, "S"))
      ->capture_default_str();
  app.add_option(
         "--late", arguments.delay_steps,
         "Use every response this many steps late: what a simulator that does not wait would see, but "
         "the same in every run")
      ->check(CLI::Range(std::int64_t{0}, kMaxLateSteps, "STEPS"))
      ->excludes(rate)
      ->capture_default_str();
  app.add_option("--timeout", arguments.retry_policy.timeout, "Ask again after this many seconds")
      ->check(number_in(0.0, 1e6, "S"))
      ->capture_default_str();
  app.add_option("--retries", arguments.retry_policy.max_retries,
                 "Ask again at most this often before giving up")
      ->check(CLI::Range(std::int64_t{0}, kMaxCount, "N"))
      ->capture_default_str();
  app.add_option("--states-channel", arguments.channel.states_channel, "Channel of the requests")
      ->capture_default_str();
  app.add_option("--wrenches-channel", arguments.channel.wrenches_channel, "Channel of the responses")
      ->capture_default_str();
  app.add_flag(
         "--no-spin", arguments.no_spin,
         "Sleep as soon as no response is there, instead of looking for it for up to 50 us while they come "
         "quickly: takes less of the processor, and longer for each step")
      ->excludes(embedded);
  app.add_option("--session", arguments.session, "Session id (default: drawn anew by every run)");
  app.add_flag("--json", arguments.json, "Print the table at the end as JSON");
}

// What no single option shows.
Expected<void> check_arguments(const Arguments& arguments, double steps) {
  if (steps > kMaxSteps) {
    return make_error({"--duration and --step", std::to_string(steps) + " steps", "at most 1e15", "", ""});
  }
  const ChannelOptions& channel = arguments.channel;
  for (const std::string& name : {channel.states_channel, channel.wrenches_channel}) {
    if (Expected<void> checked = check_channel(name); !checked) return checked;
  }
  if (channel.states_channel == channel.wrenches_channel) {
    return make_error({"channels", "both are " + channel.states_channel, "two different names",
                       "requests would be taken for answers", ""});
  }
  return check_lcm_url(channel.lcm_url);
}

int report(const Error& error, int exit_code) {
  std::fprintf(stderr, "buoyancy-client: %s\n", error.message().c_str());
  return exit_code;
}

Expected<RequestClient> make_client(const Arguments& arguments, const Scene& scene) {
  if (arguments.embedded) return RequestClient(InProcessClient(scene));
  Expected<LcmRequestChannel> channel = LcmRequestChannel::open(arguments.channel);
  if (!channel) return make_error(channel.error());
  if (!arguments.rate) return RequestClient(LockstepClient(std::move(*channel), arguments.retry_policy));
  return RequestClient(FreeRunningClient(std::move(*channel), arguments.retry_policy, 1.0 / *arguments.rate));
}

int simulate(Arguments arguments) {
  arguments.channel.cancelled = &stop_requested;
  arguments.channel.spin = !arguments.no_spin;
  SimulationOptions options;
  options.step = arguments.step.value_or(arguments.rate ? 1.0 / *arguments.rate : options.step);
  options.integrator = *integrator_from_name(arguments.integrator);
  options.lead_time = arguments.lead_time;
  options.delay_steps = arguments.delay_steps;
  options.session_id = arguments.session.value_or(make_session_id());
  const double steps_requested = std::round(arguments.duration / options.step);
  if (const Expected<void> checked = check_arguments(arguments, steps_requested); !checked) {
    return report(checked.error(), kUsageError);
  }
  const auto steps = static_cast<std::int64_t>(steps_requested);

  const Expected<Scene> scene = Scene::load(arguments.scene);
  if (!scene) return report(scene.error(), kUsageError);
  Expected<Simulation> simulation = Simulation::make(*scene, options);
  if (!simulation) return report(simulation.error(), kUsageError);
  std::optional<RunCsv> csv;
  if (!arguments.csv.empty()) {
    const Expected<void> own = check_output_is_its_own(arguments.csv, {arguments.scene});
    if (!own) return report(own.error(), kUsageError);
    Expected<RunCsv> created = RunCsv::create(arguments.csv, arguments.csv_every);
    if (!created) return report(created.error(), kFailure);
    csv = std::move(*created);
  }
  Expected<RequestClient> client = make_client(arguments, *scene);
  if (!client) return report(client.error(), kFailure);

  RunSummary summary;
  const auto warn = [&summary](std::optional<Error> warning) {
    if (!warning) return;
    std::fprintf(stderr, "buoyancy-client: warning: %s\n", warning->message().c_str());
    summary.warnings.push_back(std::move(*warning));
  };
  warn(step_warning(*simulation));
  warn(latency_warning(*simulation, static_cast<double>(options.delay_steps) * options.step));
  LatencyMonitor latency;

  const Clock::time_point start = Clock::now();
  Expected<RunOutcome> end = RunOutcome::kCompleted;
  {
    ProgressBar progress("steps");
    end = run(*simulation, *client, steps, stop_requested, [&](const Simulation& now) -> Expected<void> {
      progress.update(now.step_number(), steps, now.step_number());
      if (arguments.rate) {
        if (std::optional<Error> late = latency.update(now)) {
          progress.clear();
          warn(std::move(late));
        }
      }
      return csv ? csv->write(now) : Expected<void>{};
    });
  }
  const double wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  const Expected<void> closed = csv ? csv->close() : Expected<void>{};
  if (!end) return report(end.error(), kFailure);
  if (!closed) return report(closed.error(), kFailure);

  warn(energy_warning(*simulation));
  summary.steps = simulation->completed_steps();
  summary.steps_requested = steps;
  summary.interrupted = *end == RunOutcome::kInterrupted;
  summary.time = static_cast<double>(summary.steps) * options.step;
  summary.wall_time = wall_time;
  summary.options = options;
  for (const SimulatedBody& body : simulation->bodies()) {
    summary.bodies.push_back(summarize(body, simulation->water()));
  }
  summary.client = statistics(*client);
  const std::string text = arguments.json ? to_json(summary) : to_text(summary);
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    return report({"standard output", "cannot be written", "a place for the table", "", ""}, kFailure);
  }
  return summary.interrupted ? kFailure : kSuccess;
}

int client_main(int argc, char** argv) {
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  CLI::App app(
      "Simulates the bodies of a scene that have a [body.client] and asks buoyancyd for the wrenches on "
      "them.\n"
      "Exit codes: 0 done, 1 it ran and failed or was interrupted (SIGINT, SIGTERM: the table and the CSV "
      "are of\n"
      "the steps done), 2 wrong arguments, scene or mesh.",
      "buoyancy-client");
  Arguments arguments;
  add_options(app, arguments);
  if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
  return simulate(std::move(arguments));
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  return buoyancy::client_main(argc, argv);
}
