// Overhead of the live view for the observed service: round trips of a client that sends a thousand requests
// per second about a hundred bodies, with and without a view that serves a connected page, in turns, over
// UDP. Markdown on standard output.
//
//   view_overhead [--quick]
//
// Must run in a network namespace with a multicast route (scripts/measure view). Exit codes: 0 measured; 1 a
// wrong response or no network; 2 invalid arguments. A missed goal is printed and does not change the exit
// code: times depend on the machine and its load.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <time.h>
#include <unistd.h>

#include "client/client.h"
#include "markdown_table.h"
#include "median.h"
#include "quick_option.h"
#include "service_process.h"
#include "tests/support/build_paths.h"
#include "tests/view/http_peer.h"

namespace buoyancy::bench {
namespace {

using Times = std::vector<double>;  // [us]

constexpr int kBodies = 100;
constexpr double kRate = 1000.0;  // [Hz]
constexpr double kMaxChange = 0.05;
constexpr double kMinUpdates = 20.0;  // [Hz]

// A box of 1,200 triangles.
const std::string kCrate = R"(shape = { type = "box", size = [1, 1, 1], segments = [10, 10, 10] })";

// Processor time of all threads of a process [s].
double processor_time(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string field;
  std::getline(file, field, ')');  // the name may hold spaces
  for (int skipped = 0; skipped < 11; ++skipped) file >> field;
  double user = 0.0;
  double system = 0.0;
  file >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// A view with a connected page that receives every snapshot.
class ConnectedView {
 public:
  explicit ConnectedView(const std::string& scene)
      : process_({built_program("buoyancy-view"), "--scene", directory_.write("scene.toml", scene), "-l",
                  url_of_port(kServicePort), "--port", "0"}),
        reader_(view::port_from_ready_line(process_.child().standard_output())),
        thread_([this] {
          while (!stopped_) {
            if (reader_.next(0.5)) ++snapshots_;
          }
        }) {}
  ConnectedView(const ConnectedView&) = delete;
  ConnectedView& operator=(const ConnectedView&) = delete;
  ~ConnectedView() {
    stopped_ = true;
    thread_.join();
  }
  std::int64_t snapshots() const { return snapshots_; }
  double processor_time() { return bench::processor_time(process_.child().pid()); }

 private:
  TempDir directory_;
  ReadyProcess process_;
  view::EventReader reader_;
  std::atomic<std::int64_t> snapshots_{0};
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

class PacedClient {
 public:
  PacedClient() : client_(open()) {}

  // Sends `requests` requests at kRate and returns their round trips.
  Times request(std::size_t requests) {
    Times times;
    times.reserve(requests);
    auto due = Clock::now();
    for (std::size_t i = 0; i < requests; ++i) {
      std::this_thread::sleep_until(due);
      move();
      const auto start = Clock::now();
      const auto response = client_.request(++step_, states_);
      times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
      if (!response) fail(response.error().message());
      if ((*response)->bodies.back().force[2] <= 0.0) fail("a body in the water has no buoyant force");
      due = std::max(due + std::chrono::microseconds(static_cast<int>(1e6 / kRate)), Clock::now());
    }
    return times;
  }

 private:
  static Client open() {
    ClientOptions options;
    options.channel.lcm_url = url_of_port(kServicePort);
    return value_or_exit(Client::open(options));
  }

  // Every body crosses the water surface and turns, so that no result is cached.
  void move() {
    for (int i = 0; i < kBodies; ++i) {
      const double angle = 0.1 * i + 1e-3 * static_cast<double>(step_);
      states_[static_cast<std::size_t>(i)] = {.body_id = i + 1,
                                              .position = {3.0 * i, 0.0, 0.2 * std::sin(angle)},
                                              .quaternion_wxyz = {std::cos(angle), 0.0, std::sin(angle), 0.0},
                                              .linear_velocity = {},
                                              .angular_velocity = {}};
    }
  }

  Client client_;
  std::vector<BodyState> states_{kBodies};
  std::int64_t step_ = 0;
};

void run(bool quick) {
  constexpr std::size_t kRequests = 1'000;  // for one second, so that both see the same load of the machine
  constexpr std::size_t kWarmUp = 300;
  const std::size_t rounds = quick ? 20 : 100;
  const std::string scene = bodies_of(kBodies, kCrate);
  const ServiceProcess service(scene);
  PacedClient client;
  client.request(kRequests);
  Times without_p50, with_p50, without_p99, with_p99, changes, updates, processor;
  for (std::size_t round = 0; round < rounds; ++round) {
    const auto with = [&] {
      ConnectedView view(scene);
      client.request(kWarmUp);  // until the view has started up
      const std::int64_t snapshots = view.snapshots();
      const double used = view.processor_time();
      const auto start = Clock::now();
      const Times times = client.request(kRequests);
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      updates.push_back(static_cast<double>(view.snapshots() - snapshots) / seconds);
      processor.push_back(100.0 * (view.processor_time() - used) / seconds);
      with_p50.push_back(percentile(times, 0.5));
      with_p99.push_back(percentile(times, 0.99));
    };
    const auto without = [&] {
      client.request(kWarmUp);
      const Times times = client.request(kRequests);
      without_p50.push_back(percentile(times, 0.5));
      without_p99.push_back(percentile(times, 0.99));
    };
    if (round % 2 == 0) {
      without();
      with();
    } else {
      with();
      without();
    }
    changes.push_back(with_p50.back() / without_p50.back() - 1.0);
  }
  const double change = median(changes);
  std::printf(
      "### Overhead of a live view\n\n"
      "%d surface-piercing bodies of 1,200 triangles, %.0f requests per second in lock-step, with and\n"
      "without a `buoyancy-view` whose events a client reads, in turns: medians of %zu rounds of %zu\n"
      "requests each.\n\n",
      kBodies, kRate, rounds, kRequests);
  MarkdownTable table({"", "without", "with", "change", "required", ""});
  table.add({"round trip, p50, us", format_cell("%.1f", median(without_p50)),
             format_cell("%.1f", median(with_p50)), format_cell("%+.1f %%", 100.0 * change), "below 5 %",
             pass_or_fail(change < kMaxChange)});
  table.add({"round trip, p99, us", format_cell("%.1f", median(without_p99)),
             format_cell("%.1f", median(with_p99)),
             format_cell("%+.1f %%", 100.0 * (median(with_p99) / median(without_p99) - 1.0)), "", ""});
  const double mean_updates =
      std::accumulate(updates.begin(), updates.end(), 0.0) / static_cast<double>(updates.size());
  table.add({"snapshots per second, mean", "", format_cell("%.1f", mean_updates), "", "20 or more",
             pass_or_fail(mean_updates >= kMinUpdates)});
  table.add({"snapshots per second, minimum of a round", "",
             format_cell("%.1f", *std::min_element(updates.begin(), updates.end())), "", "", ""});
  table.add({"processor time of the view, % of one", "", format_cell("%.1f", median(processor)), "", "", ""});
  table.print(stdout, 1);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  return buoyancy::bench::run_with_quick_option(
      argc, argv, "Measure the overhead of a live view for the observed service",
      "Use fewer requests and rounds", buoyancy::bench::run);
}
