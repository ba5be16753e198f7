// Overload test in mode latest: several sessions together send ten times as many requests as the service can
// handle. Measures the age of the responses and their distribution over the sessions. Markdown on standard
// output.
//
//   overload [--quick]
//
// The age of a response is the time from sending its request to its arrival. Must run in a network namespace
// with a multicast route (scripts/measure round_trip). Exit codes: same as round_trip.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <sched.h>

#include "engine/request_handler.h"
#include "markdown_table.h"
#include "quick_option.h"
#include "service_process.h"
#include "transport/lcm_connection.h"

namespace buoyancy::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kSessions = 4;
constexpr double kOverload = 10.0;
constexpr double kAllowance = 1e-3;  // [s], beyond one service time

// A method that visits the whole mesh, so that the processor is the bottleneck, not the network.
const std::string kScene =
    "[[body]]\nid = 1\nmethod = \"exact\"\n"
    "shape = { type = \"rock\", radius = 1, frequency = 160 }\n";

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::vector<std::uint8_t> request_of(std::int64_t session, std::int64_t seq) {
  BodyState state;
  state.body_id = 1;
  state.position = {0.0, 0.0, 0.3 * std::sin(0.1 * static_cast<double>(seq) + static_cast<double>(session))};
  state.quaternion_wxyz = {1.0, 0.0, 0.0, 0.0};
  std::vector<std::uint8_t> bytes;
  encode(WrenchRequest{.id = {seq, session, seq}, .lead_time = 0.0, .bodies = {state}}, bytes);
  return bytes;
}

struct QueryTime {
  double p50, p99;  // [s]
};

// Measures the handler in this process without load: times above the p50 here are caused by the machine.
QueryTime query_time(const Scene& scene) {
  constexpr std::size_t kQueries = 1000;
  RequestHandler handler(scene);
  std::vector<double> times(kQueries);
  for (std::size_t i = 0; i < kQueries; ++i) {
    const std::vector<std::uint8_t> request = request_of(0, static_cast<std::int64_t>(i));
    const auto start = Clock::now();
    handler.handle(request);
    times[i] = seconds(Clock::now() - start);
  }
  std::sort(times.begin(), times.end());
  return {times[kQueries / 2], times[kQueries * 99 / 100]};
}

struct ReceivedResponses {
  std::vector<double> ages;  // [s]
  std::vector<std::int64_t> responses = std::vector<std::int64_t>(kSessions);
  std::vector<double> max_gap = std::vector<double>(kSessions);  // [s], between two responses
};

// Sends a request every `interval` for `duration` [s], for each session in turn.
class Clients {
 public:
  Clients() : connection_(value_or_exit(LcmConnection::open(url_of_port(kServicePort)))) {
    value_or_exit(connection_.subscribe(std::string(kWrenchesChannel),
                                        [this](Bytes bytes, std::string_view) { receive(bytes); }));
  }

  ReceivedResponses run(double duration, double interval) {
    const auto start = Clock::now();
    last_response_.assign(kSessions, start);
    for (std::int64_t number = 0; seconds(Clock::now() - start) < duration; ++number) {
      const auto due = start + std::chrono::duration_cast<Clock::duration>(
                                   std::chrono::duration<double>(interval * static_cast<double>(number)));
      receive_until(due);
      const std::size_t session = static_cast<std::size_t>(number) % kSessions;
      const auto seq = static_cast<std::int64_t>(sent_[session].size());
      const std::vector<std::uint8_t> request = request_of(static_cast<std::int64_t>(session), seq);
      sent_[session].push_back(Clock::now());
      value_or_exit(connection_.publish(std::string(kStatesChannel), request));
    }
    return received_;
  }

 private:
  // Receives without sleeping: on a virtual machine a wake-up sometimes takes milliseconds, which would be
  // counted as the service's.
  void receive_until(Clock::time_point due) {
    do {
      if (!connection_.handle_one()) ::sched_yield();
    } while (Clock::now() < due);
  }

  void receive(Bytes bytes) {
    const auto now = Clock::now();
    if (decode(bytes, response_)) fail("an invalid response");
    if (response_.bodies.size() != 1 || response_.bodies[0].force[2] <= 0.0) fail("a wrong response");
    const auto session = static_cast<std::size_t>(response_.id.session_id);
    received_.ages.push_back(seconds(now - sent_[session][static_cast<std::size_t>(response_.id.seq)]));
    ++received_.responses[session];
    received_.max_gap[session] = std::max(received_.max_gap[session], seconds(now - last_response_[session]));
    last_response_[session] = now;
  }

  LcmConnection connection_;
  std::vector<std::vector<Clock::time_point>> sent_ = std::vector<std::vector<Clock::time_point>>(kSessions);
  std::vector<Clock::time_point> last_response_;
  WrenchResponse response_;  // reused
  ReceivedResponses received_;
};

void run(bool quick) {
  ServiceProcess service(kScene, "latest");
  const QueryTime unloaded = query_time(scene_of(kScene));
  const double interval = unloaded.p50 / kOverload;
  ReceivedResponses received = Clients().run(quick ? 2.0 : 10.0, interval);
  if (received.ages.empty()) fail("no responses");
  std::sort(received.ages.begin(), received.ages.end());
  const auto age_at = [&](double share) {
    return 1e3 *
           received.ages[static_cast<std::size_t>(share * static_cast<double>(received.ages.size() - 1))];
  };
  const auto [min, max] = std::minmax_element(received.responses.begin(), received.responses.end());
  const double gap = *std::max_element(received.max_gap.begin(), received.max_gap.end());
  const double allowed = 1e3 * (unloaded.p50 + kAllowance);
  std::printf("### Overload: ten times the service's capacity\n\n");
  std::printf(
      "Mode latest, %zu sessions, %.0f requests per second; the service can handle one in ten of them: a\n"
      "query takes %.2f ms (p99 %.2f ms).\n\n",
      kSessions, 1.0 / interval, 1e3 * unloaded.p50, 1e3 * unloaded.p99);
  std::printf("| age of the response | ms |\n|---|---:|\n");
  std::printf("| p50 | %.2f |\n| p99 | %.2f |\n| largest | %.2f |\n", age_at(0.5), age_at(0.99), age_at(1.0));
  std::printf("| limit of p99 (one query and 1 ms): %s | %.2f |\n\n",
              pass_or_fail(age_at(0.99) <= allowed).c_str(), allowed);
  std::printf(
      "%zu responses, %lld to %lld per session; the longest gap between two responses of a session was\n"
      "%.1f ms.\n\n",
      received.ages.size(), static_cast<long long>(*min), static_cast<long long>(*max), 1e3 * gap);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run_with_quick_option(argc, argv,
                                                "Send ten times as many requests as buoyancyd can handle",
                                                "Run for two seconds instead of ten", buoyancy::bench::run);
}
