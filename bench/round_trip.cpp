// Latency over the network: round trips of a lock-step client with the real buoyancyd, compared in the same
// run with a process that only echoes messages of the same size (lcm_echo), over UDP. Markdown on standard
// output.
//
//   round_trip [--quick]
//
// Must run in a network namespace with a multicast route (scripts/measure round_trip). Responses are checked
// before they are timed. Exit codes: 0 measured; 1 a wrong response or no network; 2 invalid arguments. A
// missed goal is printed and does not change the exit code: times depend on the machine and its load.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "markdown_table.h"
#include "median.h"
#include "quick_option.h"
#include "service_requests.h"
#include "tests/support/build_paths.h"

namespace buoyancy::bench {
namespace {

using Times = std::vector<double>;  // [us]

constexpr std::size_t kRuns = 5;
constexpr std::size_t kBlock = 250;    // number of requests before switching between service and echo
constexpr double kMaxP50Ratio = 1.25;  // service / echo
constexpr double kMaxP99Ratio = 1.5;
constexpr double kMaxOverheadRatio = 1.5;    // with 100 bodies, without the solver's time
constexpr double kRequiredSteps = 20'000.0;  // per second
constexpr double kRealTimeSteps = 1000.0;    // per second

const std::string kRock = R"(shape = { type = "rock", radius = 1, frequency = 39 })";  // 30,420 triangles

// The states of all bodies, see state_at().
States states_at(const Scene& scene, std::size_t step, double sink = 0.0) {
  States states;
  for (const Body& body : scene.bodies()) states.push_back(state_at(body, step, sink));
  return states;
}

// Fully submerged bodies must have the force rho g V upwards, surface-piercing bodies a force between 0 and
// rho g V and the handler's bits.
void check_responses(Client& client, const Scene& scene) {
  const WrenchResponse deep = send_request(client, 0, states_at(scene, 0, 1000.0));
  const States states = states_at(scene, 1);
  const WrenchResponse crossing = send_request(client, 1, states);
  check_equals_handler(crossing, states, scene);
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    check_submerged_force(scene.bodies()[i], scene.water(), deep.bodies[i]);
    check_piercing_force(scene.bodies()[i], scene.water(), crossing.bodies[i]);
  }
}

// Times of one run: requests to the service and to the echo in turns, and requests to the handler in this
// process, without a network, for the solver's own time.
struct Run {
  Times service, echo, solver;
};

struct Pair {
  Client service, echo;
  RequestHandler handler;
  std::size_t step = 2;
};

void time_block(Client& client, const std::vector<States>& block, std::size_t first, Times& times) {
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto start = Clock::now();
    const auto response = client.request(static_cast<std::int64_t>(first + i), block[i]);
    times.push_back(microseconds(Clock::now() - start));
    if (!response) fail(response.error().message());
  }
}

Run time_run(Pair& pair, std::size_t requests) {
  Run run;
  std::vector<std::uint8_t> bytes;
  while (run.service.size() < requests) {
    std::vector<States> block;
    for (std::size_t i = 0; i < kBlock; ++i) {
      block.push_back(states_at(pair.handler.scene(), pair.step + i));
    }
    time_block(pair.service, block, pair.step, run.service);
    time_block(pair.echo, block, pair.step, run.echo);
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto seq = static_cast<std::int64_t>(pair.step + i);
      encode(WrenchRequest{.id = {seq, 1, seq}, .lead_time = 0.0, .bodies = block[i]}, bytes);
      const auto start = Clock::now();
      pair.handler.handle(bytes);
      run.solver.push_back(microseconds(Clock::now() - start));
    }
    pair.step += kBlock;
  }
  return run;
}

struct Figures {
  double service_p50, service_p99, echo_p50, echo_p99, solver_p50;  // [us]
  double ratio_p50, ratio_p99;
  double overhead_ratio;  // (service p50 - solver p50) / echo p50
  double steps;           // of the service, per second
};

template <typename Value>
double median_of(const std::vector<Run>& runs, Value&& value) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const Run& run : runs) values.push_back(value(run));
  return median(values);
}

// threads: of the handler in this process, see RequestHandlerOptions.
Figures measure(const Scene& scene, std::size_t requests, unsigned threads) {
  Pair pair{client_at(kServicePort), client_at(kEchoPort), RequestHandler(scene, {.threads = threads})};
  check_responses(pair.service, scene);
  time_run(pair, kBlock);  // warm-up
  std::vector<Run> runs;
  for (std::size_t i = 0; i < kRuns; ++i) runs.push_back(time_run(pair, requests));
  const auto p50 = [](const Times& times) { return percentile(times, 0.5); };
  const auto p99 = [](const Times& times) { return percentile(times, 0.99); };
  Figures figures{};
  figures.service_p50 = median_of(runs, [&](const Run& run) { return p50(run.service); });
  figures.service_p99 = median_of(runs, [&](const Run& run) { return p99(run.service); });
  figures.echo_p50 = median_of(runs, [&](const Run& run) { return p50(run.echo); });
  figures.echo_p99 = median_of(runs, [&](const Run& run) { return p99(run.echo); });
  figures.solver_p50 = median_of(runs, [&](const Run& run) { return p50(run.solver); });
  figures.ratio_p50 = median_of(runs, [&](const Run& run) { return p50(run.service) / p50(run.echo); });
  figures.ratio_p99 = median_of(runs, [&](const Run& run) { return p99(run.service) / p99(run.echo); });
  figures.overhead_ratio =
      median_of(runs, [&](const Run& run) { return (p50(run.service) - p50(run.solver)) / p50(run.echo); });
  figures.steps = median_of(runs, [](const Run& run) {
    const double total = std::accumulate(run.service.begin(), run.service.end(), 0.0);
    return 1e6 * static_cast<double>(run.service.size()) / total;
  });
  return figures;
}

enum class Processors { kOne, kAll };

Figures measure(const std::string& scene, int bodies, std::size_t requests, Processors processors) {
  std::optional<PinToOneCpu> pinned;
  if (processors == Processors::kOne) pinned.emplace();
  const ServiceProcess service(scene);
  const EchoProcess echo(bodies);
  return measure(scene_of(scene), requests, pinned ? 1 : 0);
}

void add_round_trips(MarkdownTable& table, const std::string& name, Processors processors,
                     std::size_t requests) {
  const Figures one = measure(bodies_of(1, kCrate), 1, requests, processors);
  table.add({name, "1", "p50", format_cell("%.1f", one.service_p50), format_cell("%.1f", one.echo_p50),
             format_cell("%.2f", one.solver_p50), format_cell("%.2f", one.ratio_p50),
             format_cell("%.2f", kMaxP50Ratio), pass_or_fail(one.ratio_p50 <= kMaxP50Ratio)});
  table.add({name, "1", "p99", format_cell("%.1f", one.service_p99), format_cell("%.1f", one.echo_p99), "",
             format_cell("%.2f", one.ratio_p99), format_cell("%.2f", kMaxP99Ratio),
             pass_or_fail(one.ratio_p99 <= kMaxP99Ratio)});
  const Figures many = measure(bodies_of(100, kCrate), 100, requests / 4, processors);
  table.add({name, "100", "p50", format_cell("%.1f", many.service_p50), format_cell("%.1f", many.echo_p50),
             format_cell("%.1f", many.solver_p50), format_cell("%.2f", many.overhead_ratio) + " *",
             format_cell("%.2f", kMaxOverheadRatio), pass_or_fail(many.overhead_ratio <= kMaxOverheadRatio)});
}

void print_round_trips(std::size_t requests) {
  std::printf(
      "### Round trip compared with an echo\n\n"
      "Surface-piercing bodies of 1,200 triangles. The echo is a bare LCM process that replies with\n"
      "messages of the same size. Medians of %zu runs of %zu requests each, also of the ratios; in every\n"
      "run service and echo take turns. The echo needs two wake-ups per request, one of liblcm's thread\n"
      "and one by that thread. Where waking another processor is expensive, as on a virtual machine, the\n"
      "cost depends on the kernel's scheduler; with one processor for all it is low. The service spins for\n"
      "the next request before it sleeps, and so does the client of both.\n\n",
      kRuns, requests);
  MarkdownTable table(
      {"processors", "bodies", "", "service, us", "echo, us", "solver, us", "ratio", "limit", ""});
  add_round_trips(table, "one", Processors::kOne, requests);
  add_round_trips(table, "all", Processors::kAll, requests);
  table.print(stdout, 3);
  std::printf(
      "\\* Ratio of the service's time without the solver's time to the echo's time. The solver's time is\n"
      "measured with the same requests in the client's own process.\n\n");
}

// Parses the steps per second that bullet_crate prints.
double crate_steps(int port) {
  const FinishedProcess finished =
      run_to_end(command_of({built_program("bullet_crate"), url_of_port(port)}), 120.0);
  const std::size_t end = finished.standard_output.find(" steps/s");
  if (finished.exit_code != 0 || end == std::string::npos) fail(finished.standard_error);
  const std::size_t line = finished.standard_output.rfind('\n', end) + 1;
  return std::stod(finished.standard_output.substr(line, end - line));
}

void add_steps(MarkdownTable& table, const std::string& name, std::size_t runs) {
  const ServiceProcess service(read_file(source_dir() / "scenes/box.toml"));
  const EchoProcess echo(1);
  std::vector<double> service_steps(runs);
  std::vector<double> echo_steps(runs);
  std::vector<double> ratios(runs);
  for (std::size_t i = 0; i < runs; ++i) {
    service_steps[i] = crate_steps(kServicePort);
    echo_steps[i] = crate_steps(kEchoPort);
    ratios[i] = service_steps[i] / echo_steps[i];
  }
  table.add({name, format_cell("%.0f", median(service_steps)), format_cell("%.0f", median(echo_steps)),
             format_cell("%.0f %%", 100.0 * median(ratios)), format_cell("%.0f", kRequiredSteps),
             pass_or_fail(median(service_steps) >= kRequiredSteps)});
}

void print_steps(std::size_t runs) {
  std::printf(
      "### Steps per second of an external simulator\n\n"
      "`bullet_crate`, 20,000 steps in lock-step, one request each, medians of %zu runs. One processor: as\n"
      "with `taskset -c 0` for both programs.\n\n",
      runs);
  MarkdownTable table({"processors", "steps/s", "echo, steps/s", "ratio", "required", ""});
  {
    const PinToOneCpu pinned;
    add_steps(table, "one", runs);
  }
  add_steps(table, "all", runs);
  table.print(stdout, 1);
}

void print_large_scenes(std::size_t requests) {
  struct LargeScene {
    std::string name, body;
  };
  std::vector<LargeScene> scenes{{"100 rocks of 30,420 triangles", kRock}};
  const char* const meshes =
      std::getenv("BUOYANCY_MESHES");  // NOLINT(concurrency-mt-unsafe): no thread sets it
  if (meshes != nullptr) {
    const std::string armadillo = std::string(meshes) + "/armadillo_30000.ply";
    if (std::filesystem::exists(armadillo)) {
      scenes.push_back({"100 armadillos of 30,000 triangles", "mesh = \"" + armadillo + "\""});
    }
  }
  std::printf(
      "### One hundred large surface-piercing bodies\n\n"
      "In lock-step; goal: 1,000 steps per second, which is real time for steps of 1 ms.\n\n");
  MarkdownTable table({"bodies", "steps/s", "round trip p50, us", "p99, us", "solver, us", "echo, us",
                       "solver's share", "goal"});
  for (const LargeScene& large : scenes) {
    const Figures figures = measure(bodies_of(100, large.body), 100, requests, Processors::kAll);
    table.add({large.name, format_cell("%.0f", figures.steps), format_cell("%.0f", figures.service_p50),
               format_cell("%.0f", figures.service_p99), format_cell("%.0f", figures.solver_p50),
               format_cell("%.0f", figures.echo_p50),
               format_cell("%.0f %%", 100.0 * figures.solver_p50 / figures.service_p50),
               pass_or_fail(figures.steps >= kRealTimeSteps)});
  }
  table.print(stdout, 1);
}

// Kills and restarts the service while a client keeps resending its request.
void print_restart() {
  const std::string scene = bodies_of(1, kCrate);
  const Scene prepared = scene_of(scene);
  std::optional<ServiceProcess> service(std::in_place, scene);
  ClientOptions options;
  options.channel.lcm_url = url_of_port(kServicePort);
  options.retry_policy = {.timeout = 0.005, .max_retries = 10'000};
  Client client = value_or_exit(Client::open(options));
  check_responses(client, prepared);
  Times until_ready;
  Times until_response;
  for (std::size_t step = 2; step < 2 + kRuns; ++step) {
    const auto killed = Clock::now();
    service->child().send_signal(SIGKILL);
    service->child().wait(10.0);
    auto response_time = std::async(std::launch::async, [&] {
      send_request(client, step, states_at(prepared, step));
      return Clock::now();
    });
    service.reset();
    service.emplace(scene);
    const auto ready = Clock::now();
    until_ready.push_back(1e-3 * microseconds(ready - killed));
    // The ready line is noticed with a delay, so that the response may arrive before.
    until_response.push_back(std::max(0.0, 1e-3 * microseconds(response_time.get() - ready)));
  }
  const double max = *std::max_element(until_response.begin(), until_response.end());
  std::printf(
      "### Restart after SIGKILL\n\n"
      "`kill -9`, then the same command again, %zu times, while a client resends its request every 5 ms:\n"
      "ready after %.0f ms (median), response %.1f ms later (median; max %.1f ms, limit 1000 ms: %s).\n\n",
      kRuns, median(until_ready), median(until_response), max, pass_or_fail(max <= 1000.0).c_str());
}

void run(bool quick) {
  print_round_trips(quick ? 2'000 : 20'000);
  print_steps(quick ? 3 : kRuns);
  print_large_scenes(quick ? 250 : 2'000);
  print_restart();
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run_with_quick_option(argc, argv,
                                                "Measure round trips with buoyancyd and with an echo",
                                                "Send fewer requests", buoyancy::bench::run);
}
