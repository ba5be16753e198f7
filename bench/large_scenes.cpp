// Scenes of ten thousand and more bodies over the network: steps per second of a lock-step client with the
// real buoyancyd, one message for all bodies of a step, compared in the same run with a process that only
// echoes messages of the same size (lcm_echo), over UDP. Markdown on standard output.
//
//   large_scenes [--quick]
//
// Must run in a network namespace with a multicast route (scripts/measure round_trip). The service's response
// is compared with that of a handler in this process, bit for bit, before anything is timed. Exit codes: 0
// measured; 1 a wrong response or no network; 2 invalid arguments. A missed goal is printed and does not
// change the exit code: times depend on the machine and its load.
#include <chrono>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

#include "markdown_table.h"
#include "median.h"
#include "quick_option.h"
#include "service_requests.h"
#include "tests/support/process_memory.h"

namespace buoyancy::bench {
namespace {

constexpr std::size_t kBlock = 5;    // number of requests before switching between service and echo
constexpr double kGoalSteps = 60.0;  // per second
constexpr double kFarAway = 10.0;    // [m], of a dry or fully submerged body from the surface

struct LargeScene {
  std::string name;
  int bodies;
  std::size_t piercing_every;  // one body in so many crosses the surface; of the others half are dry
};

enum class Place { kPiercing, kDry, kSubmerged };

Place place_of(std::size_t index, const LargeScene& large) {
  if (index % large.piercing_every == 0) return Place::kPiercing;
  return index % 2 == 0 ? Place::kDry : Place::kSubmerged;
}

States states_at(const Scene& scene, const LargeScene& large, std::size_t step) {
  States states;
  states.reserve(scene.bodies().size());
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Place place = place_of(i, large);
    const double sink = place == Place::kPiercing ? 0.0 : place == Place::kDry ? -kFarAway : kFarAway;
    states.push_back(state_at(scene.bodies()[i], step, sink));
  }
  return states;
}

void check_response(Client& client, const Scene& scene, const LargeScene& large) {
  const States states = states_at(scene, large, 0);
  const WrenchResponse response = send_request(client, 0, states);
  check_equals_handler(response, states, scene);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Place place = place_of(i, large);
    if (place == Place::kDry && response.bodies[i].force[2] != 0.0) fail("a force on a dry body");
    if (place == Place::kSubmerged) {
      check_submerged_force(scene.bodies()[i], scene.water(), response.bodies[i]);
    }
    if (place == Place::kPiercing) {
      check_piercing_force(scene.bodies()[i], scene.water(), response.bodies[i]);
    }
  }
}

// Mean times of one run [us].
struct Run {
  double service, echo, handler;
};

struct Clients {
  Client service, echo;
  RequestHandler handler;
  std::size_t step = 1;
};

double time_requests(Client& client, const std::vector<States>& block, std::size_t first) {
  double total = 0.0;
  for (std::size_t i = 0; i < block.size(); ++i) {
    const auto start = Clock::now();
    const auto response = client.request(static_cast<std::int64_t>(first + i), block[i]);
    total += microseconds(Clock::now() - start);
    if (!response) fail(response.error().message());
  }
  return total;
}

Run time_run(Clients& clients, const LargeScene& large, std::size_t requests) {
  Run run{};
  std::vector<std::uint8_t> bytes;
  std::size_t done = 0;
  for (; done < requests; done += kBlock, clients.step += kBlock) {
    std::vector<States> block;
    for (std::size_t i = 0; i < kBlock; ++i) {
      block.push_back(states_at(clients.handler.scene(), large, clients.step + i));
    }
    run.service += time_requests(clients.service, block, clients.step);
    run.echo += time_requests(clients.echo, block, clients.step);
    for (std::size_t i = 0; i < kBlock; ++i) {
      const auto seq = static_cast<std::int64_t>(clients.step + i);
      encode(WrenchRequest{.id = {seq, 1, seq}, .lead_time = 0.0, .bodies = block[i]}, bytes);
      const auto start = Clock::now();
      clients.handler.handle(bytes);
      run.handler += microseconds(Clock::now() - start);
    }
  }
  const auto count = static_cast<double>(done);
  return {run.service / count, run.echo / count, run.handler / count};
}

struct Figures {
  double service, echo, handler;  // [us] per step, medians of the runs
  std::int64_t service_retries, echo_retries;
  double memory;  // [MB], of the service
};

Figures measure(const LargeScene& large, std::size_t runs, std::size_t requests) {
  const std::string text = bodies_of(large.bodies, kCrate);
  ServiceProcess service(text);
  const EchoProcess echo(large.bodies);
  const Scene scene = scene_of(text);
  const RetryPolicy retry_policy{.timeout = 0.5, .max_retries = 20};
  Clients clients{client_at(kServicePort, retry_policy), client_at(kEchoPort, retry_policy),
                  RequestHandler(scene)};
  check_response(clients.service, scene, large);
  time_run(clients, large, kBlock);  // warm-up
  const std::int64_t service_before = clients.service.statistics().retries;
  const std::int64_t echo_before = clients.echo.statistics().retries;
  std::vector<double> service_times;
  std::vector<double> echo_times;
  std::vector<double> handler_times;
  for (std::size_t i = 0; i < runs; ++i) {
    const Run run = time_run(clients, large, requests);
    service_times.push_back(run.service);
    echo_times.push_back(run.echo);
    handler_times.push_back(run.handler);
  }
  return {median(service_times),
          median(echo_times),
          median(handler_times),
          clients.service.statistics().retries - service_before,
          clients.echo.statistics().retries - echo_before,
          1e-3 * static_cast<double>(resident_kb(service.child().pid()))};
}

template <typename Message>
double megabytes(int bodies) {
  Message message;
  message.bodies.resize(static_cast<std::size_t>(bodies));
  std::vector<std::uint8_t> bytes;
  encode(message, bytes);
  return 1e-6 * static_cast<double>(bytes.size());
}

void run(bool quick) {
  const std::size_t runs = quick ? 3 : 5;
  std::printf(
      "### One message for all bodies\n\n"
      "Crates of 1,200 triangles that move at every step, in lock-step, one request for all of them; those\n"
      "that do not cross the surface are half dry, half fully submerged. The echo replies with messages of\n"
      "the same size. Medians of %zu runs, in which service and echo take turns; the time of a step is that\n"
      "of one call of the client library, from states to wrenches. The handler's time is that of the same\n"
      "requests in the client's own process, from bytes to bytes. Resent: requests that got no response\n"
      "within 0.5 s. Goal: %.0f steps per second.\n\n",
      runs, kGoalSteps);
  MarkdownTable table({"bodies", "surface-piercing", "request, MB", "response, MB", "steps/s", "step, ms",
                       "echo, steps/s", "echo, ms", "handler, ms", "resent, service / echo",
                       "service's memory, MB", "goal"});
  for (const LargeScene& large : {LargeScene{"10,000", 10'000, 1}, LargeScene{"100,000", 100'000, 100}}) {
    const std::size_t requests = large.bodies > 10'000 ? 20 : 60;
    const Figures figures = measure(large, runs, quick ? requests / 4 : requests);
    table.add({large.name, large.piercing_every == 1 ? "all" : "1 %",
               format_cell("%.2f", megabytes<WrenchRequest>(large.bodies)),
               format_cell("%.2f", megabytes<WrenchResponse>(large.bodies)),
               format_cell("%.0f", 1e6 / figures.service), format_cell("%.2f", 1e-3 * figures.service),
               format_cell("%.0f", 1e6 / figures.echo), format_cell("%.2f", 1e-3 * figures.echo),
               format_cell("%.2f", 1e-3 * figures.handler),
               std::to_string(figures.service_retries) + " / " + std::to_string(figures.echo_retries),
               format_cell("%.0f", figures.memory), pass_or_fail(1e6 / figures.service >= kGoalSteps)});
  }
  table.print(stdout, 2);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run_with_quick_option(argc, argv,
                                                "Measure scenes of ten thousand and more bodies over LCM",
                                                "Send fewer requests", buoyancy::bench::run);
}
