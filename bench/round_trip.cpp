// What a request costs over the network: round trips of a lock-step client against the real buoyancyd,
// beside a process that only echoes as many bytes (lcm_echo), in the same run, over UDP. Markdown on standard
// output.
//
//   round_trip [--quick]
//
// To be run in a network namespace with a multicast route (scripts/measure_round_trip). Answers are checked
// before they are timed. Exit codes: 0 measured; 1 a wrong response or no network; 2 wrong arguments. A goal
// that is missed is printed and changes no exit code: times depend on the machine and on what else it does.
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

#include "client/client.h"
#include "engine/request_handler.h"
#include "markdown_table.h"
#include "median.h"
#include "quick_option.h"
#include "service_process.h"

namespace buoyancy::bench {
namespace {

using Times = std::vector<double>;  // us
using States = std::vector<BodyState>;

constexpr std::size_t kRuns = 5;
constexpr std::size_t kBlock = 250;  // requests to one of the two before the other's turn
constexpr double kMaxP50 = 1.25;     // of the echo's
constexpr double kMaxP99 = 1.5;
constexpr double kMaxOfMany = 1.5;
constexpr double kStepsNeeded = 20'000.0;  // per second
constexpr double kRealTime = 1000.0;       // steps per second

// A box of 1,200 triangles.
const std::string kCrate = R"(shape = { type = "box", size = [1, 1, 1], segments = [10, 10, 10] })";
const std::string kRock = R"(shape = { type = "rock", radius = 1, frequency = 39 })";  // 30,420 triangles

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

Client client_at(int port) {
  ClientOptions options;
  options.channel.lcm_url = url_of_port(port);
  return value_or_exit(Client::open(options));
}

// Every body crosses the water at every step, turning; no two steps are alike, so that none is answered from
// memory. sink: m, added to every height.
States states_at(const Scene& scene, std::size_t step, double sink = 0.0) {
  States states;
  for (const Body& body : scene.bodies()) {
    const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
    const double angle = 0.1 * body.id + 1e-3 * static_cast<double>(step);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, Vec3(0.6, 0.8, std::sin(angle)).normalized()));
    Vec3 position = Vec3(5.0 * body.id, 0.0, 0.1 * mesh.box_max.minCoeff() * std::sin(7.0 * angle) - sink);
    position -= q * mesh.center_B;
    states.push_back({.body_id = body.id,
                      .position = {position.x(), position.y(), position.z()},
                      .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
                      .linear_velocity = {},
                      .angular_velocity = {}});
  }
  return states;
}

WrenchResponse send_request(Client& client, std::size_t step, const States& states) {
  return *value_or_exit(client.request(static_cast<std::int64_t>(step), states));
}

// Wholly under water the known force, rho g V upwards; at the surface what the handler says in this process,
// bit for bit, and neither nothing nor the whole.
void check_responses(Client& client, const Scene& scene) {
  constexpr double kRelative = 1e-12;
  const WrenchResponse deep = send_request(client, 0, states_at(scene, 0, 1000.0));
  const States states = states_at(scene, 1);
  const WrenchResponse crossing = send_request(client, 1, states);
  std::vector<std::uint8_t> request;
  encode(WrenchRequest{.key = crossing.key, .lead_time = 0.0, .bodies = states}, request);
  RequestHandler handler(scene, {.threads = 1});
  const Bytes expected = handler.handle(request);
  std::vector<std::uint8_t> found;
  encode(crossing, found);
  if (!std::equal(found.begin(), found.end(), expected.begin(), expected.end())) {
    fail("the service's response is not the handler's");
  }
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Water& water = scene.water();
    const double whole =
        water.density * water.gravity * scene.bodies()[i].prepared_mesh->mass_properties.volume;
    const double force = crossing.bodies[i].force[2];
    if (std::abs(deep.bodies[i].force[2] - whole) > kRelative * whole) fail("a wrong force under water");
    if (force <= 0.0 || force >= whole) fail("a body does not cross the surface");
  }
}

// The requests of one run, asked of the service and of the echo in turns; and in this process, without any
// network, for the solver's own time.
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
      encode(WrenchRequest{.key = {seq, 1, seq}, .lead_time = 0.0, .bodies = block[i]}, bytes);
      const auto start = Clock::now();
      pair.handler.handle(bytes);
      run.solver.push_back(microseconds(Clock::now() - start));
    }
    pair.step += kBlock;
  }
  return run;
}

struct Figures {
  double service_p50, service_p99, echo_p50, echo_p99, solver_p50;  // us
  double ratio_p50, ratio_p99;
  double of_echo;  // what is left of the service's p50 without the solver's, over the echo's
  double steps;    // per second, of the service
};

template <typename Value>
double median_of(const std::vector<Run>& runs, Value&& value) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const Run& run : runs) values.push_back(value(run));
  return median(values);
}

// threads: that the handler in this process may use, as RequestHandlerOptions has it.
Figures measure(const Scene& scene, std::size_t requests, unsigned threads) {
  Pair pair{client_at(kServicePort), client_at(kEchoPort), RequestHandler(scene, {.threads = threads})};
  check_responses(pair.service, scene);
  time_run(pair, kBlock);  // both warm
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
  figures.of_echo =
      median_of(runs, [&](const Run& run) { return (p50(run.service) - p50(run.solver)) / p50(run.echo); });
  figures.steps = median_of(runs, [](const Run& run) {
    const double total = std::accumulate(run.service.begin(), run.service.end(), 0.0);
    return 1e6 * static_cast<double>(run.service.size()) / total;
  });
  return figures;
}

enum class Processors { kOne, kAll };

Figures measure(const std::string& scene, int bodies, std::size_t requests, Processors processors) {
  std::optional<PinToOneCpu> one;
  if (processors == Processors::kOne) one.emplace();
  const ServiceProcess service(scene);
  const EchoProcess echo(bodies);
  return measure(scene_of(scene), requests, one ? 1 : 0);
}

void add_round_trips(MarkdownTable& table, const std::string& where, Processors processors,
                     std::size_t requests) {
  const Figures one = measure(bodies_of(1, kCrate), 1, requests, processors);
  table.add({where, "1", "p50", format_cell("%.1f", one.service_p50), format_cell("%.1f", one.echo_p50),
             format_cell("%.2f", one.solver_p50), format_cell("%.2f", one.ratio_p50), format_cell("%.2f", kMaxP50),
             pass_or_fail(one.ratio_p50 <= kMaxP50)});
  table.add({where, "1", "p99", format_cell("%.1f", one.service_p99), format_cell("%.1f", one.echo_p99), "",
             format_cell("%.2f", one.ratio_p99), format_cell("%.2f", kMaxP99), pass_or_fail(one.ratio_p99 <= kMaxP99)});
  const Figures many = measure(bodies_of(100, kCrate), 100, requests / 4, processors);
  table.add({where, "100", "p50", format_cell("%.1f", many.service_p50), format_cell("%.1f", many.echo_p50),
             format_cell("%.1f", many.solver_p50), format_cell("%.2f", many.of_echo) + " *", format_cell("%.2f", kMaxOfMany),
             pass_or_fail(many.of_echo <= kMaxOfMany)});
}

void print_round_trips(std::size_t requests) {
  std::printf(
      "### Round trip beside an echo\n\n"
      "Bodies of 1,200 triangles that cross the water. The echo is a bare LCM process that answers with as "
      "many "
      "bytes. Medians of\n%zu runs of %zu requests each, of the ratios too; in every run service and echo "
      "take turns.\nThe echo is woken twice for each request, by liblcm's thread and as that thread. Where "
      "waking another processor is dear, as on\na virtual machine, it depends on the kernel's scheduler how "
      "much that costs; with one processor for all, little. The service\nlooks for the next request before "
      "it sleeps, as the client does, of both.\n\n",
      kRuns, requests);
  MarkdownTable table(
      {"processors", "bodies", "", "service, us", "echo, us", "solver, us", "ratio", "must", ""});
  add_round_trips(table, "one", Processors::kOne, requests);
  add_round_trips(table, "all", Processors::kAll, requests);
  table.print(stdout, 3);
  std::printf(
      "\\* Of what is left of the service's time without the solver's, which is that of the same "
      "requests in the client's own\nprocess.\n\n");
}

// Steps per second that bullet_crate prints at its end.
double crate_steps(int port) {
  const FinishedProcess finished = run_to_end(command_of({BULLET_CRATE, url_of_port(port)}), 120.0);
  const std::size_t end = finished.standard_output.find(" steps/s");
  if (finished.exit_code != 0 || end == std::string::npos) fail(finished.standard_error);
  const std::size_t line = finished.standard_output.rfind('\n', end) + 1;
  return std::stod(finished.standard_output.substr(line, end - line));
}

void add_steps(MarkdownTable& table, const std::string& where, std::size_t runs) {
  const ServiceProcess service(read_file(BUOYANCY_SOURCE_DIR "/scenes/box.toml"));
  const EchoProcess echo(1);
  Times of_service(runs);
  Times of_echo(runs);
  Times shares(runs);
  for (std::size_t i = 0; i < runs; ++i) {
    of_service[i] = crate_steps(kServicePort);
    of_echo[i] = crate_steps(kEchoPort);
    shares[i] = of_service[i] / of_echo[i];
  }
  table.add({where, format_cell("%.0f", median(of_service)), format_cell("%.0f", median(of_echo)),
             format_cell("%.0f %%", 100.0 * median(shares)), format_cell("%.0f", kStepsNeeded),
             pass_or_fail(median(of_service) >= kStepsNeeded)});
}

void print_steps(std::size_t runs) {
  std::printf(
      "### Steps per second of somebody else's simulator\n\n"
      "`bullet_crate`, 20,000 steps in lock-step, one request each, medians of %zu runs. One processor: as "
      "with "
      "`taskset -c 0`\nfor both programs.\n\n",
      runs);
  MarkdownTable table({"processors", "steps/s", "of the echo, steps/s", "share", "must", ""});
  {
    const PinToOneCpu one;
    add_steps(table, "one", runs);
  }
  add_steps(table, "all", runs);
  table.print(stdout, 1);
}

void print_large_scenes(std::size_t requests) {
  struct Row {
    std::string name, body;
  };
  std::vector<Row> rows{{"100 rocks of 30,420 triangles", kRock}};
  const char* const meshes = std::getenv("BUOYANCY_MESHES");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (meshes != nullptr) {
    const std::string armadillo = std::string(meshes) + "/armadillo_30000.ply";
    if (std::filesystem::exists(armadillo)) {
      rows.push_back({"100 armadillos of 30,000 triangles", "mesh = \"" + armadillo + "\""});
    }
  }
  std::printf(
      "### A hundred large bodies that cross the water\n\nIn lock-step; aim: 1,000 steps a second, real time "
      "at 1 ms.\n\n");
  MarkdownTable table({"bodies", "steps/s", "round trip p50, us", "p99, us", "solver, us", "echo, us",
                       "solver's share", "aim"});
  for (const Row& row : rows) {
    const Figures figures = measure(bodies_of(100, row.body), 100, requests, Processors::kAll);
    table.add(
        {row.name, format_cell("%.0f", figures.steps), format_cell("%.0f", figures.service_p50),
         format_cell("%.0f", figures.service_p99), format_cell("%.0f", figures.solver_p50), format_cell("%.0f", figures.echo_p50),
         format_cell("%.0f %%", 100.0 * figures.solver_p50 / figures.service_p50), pass_or_fail(figures.steps >= kRealTime)});
  }
  table.print(stdout, 1);
}

// Killed and started again while a client keeps asking.
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
    auto answered = std::async(std::launch::async, [&] {
      send_request(client, step, states_at(prepared, step));
      return Clock::now();
    });
    service.reset();
    service.emplace(scene);
    const auto ready = Clock::now();
    until_ready.push_back(1e-3 * microseconds(ready - killed));
    // Seen to be ready a moment after it said so, and by then perhaps answered.
    until_response.push_back(std::max(0.0, 1e-3 * microseconds(answered.get() - ready)));
  }
  const double worst = *std::max_element(until_response.begin(), until_response.end());
  std::printf(
      "### Killed and started again\n\n"
      "`kill -9`, then the same command again, %zu times, while a client asks every 5 ms: ready after %.0f "
      "ms "
      "(median), its request\nanswered %.1f ms later (median; at most %.1f ms, must 1000 ms: %s).\n\n",
      kRuns, median(until_ready), median(until_response), worst, pass_or_fail(worst <= 1000.0).c_str());
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
  return buoyancy::bench::run_with_quick_option(argc, argv, "Round trips against buoyancyd beside an echo",
                                         "Fewer requests", buoyancy::bench::run);
}
