// Sends lock-step requests to a running buoyancyd, each as soon as the previous response has arrived.
//
//   soak [--requests N] [--record DIRECTORY] [--resume]
//
// Every response is checked against the known force on a box. Prints the number of requests, their rate and
// the memory of buoyancyd and of this process at intervals. The number of completed requests is stored in the
// record, so that --resume continues the last run with a new buoyancyd.
//
// Run it in a network namespace with a multicast route (scripts/soak). Exit status: 0 if every request got
// its response and memory did not grow; 1 if not, or interrupted; 2 on invalid arguments.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <unistd.h>

#include "cli/tool_command_line.h"
#include "client/client.h"
#include "tests/service/running_service.h"
#include "tests/support/process_memory.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kSampleInterval = 10'000;  // requests
constexpr std::int64_t kWarmUp = 100'000;         // requests until every buffer has its final size
constexpr std::int64_t kMaxGrowth = 1'024;        // [kB]
constexpr double kReportInterval = 10.0;          // [s]

std::atomic<bool> stop_requested{false};

void request_stop(int /*signal*/) {
  stop_requested.store(true);
}

struct Memory {
  std::int64_t service = 0, client = 0;  // [kB]
};

class Record {
 public:
  Record(const std::filesystem::path& directory, bool resume) : path_(directory / "requests_done") {
    std::filesystem::create_directories(directory);
    if (resume) std::ifstream(path_) >> done_;
  }
  std::int64_t done() const { return done_; }

  // Writes the file atomically: a run may be killed at any time.
  void store(std::int64_t done) {
    done_ = done;
    const std::filesystem::path draft = path_.string() + ".new";
    std::ofstream(draft) << done << '\n';
    std::filesystem::rename(draft, path_);
  }

 private:
  std::filesystem::path path_;
  std::int64_t done_ = 0;
};

void send_request(Client& client, std::int64_t number) {
  const double height = 0.001 * static_cast<double>(number % 1000);
  const BodyState state{.body_id = 1,
                        .position = {1.0, 2.0, height},
                        .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0},
                        .linear_velocity = {},
                        .angular_velocity = {}};
  const auto response = client.request(number, {&state, 1});
  if (!response)
    throw std::runtime_error("request " + std::to_string(number) + ": " + response.error().message());
  const double force = kDensity * kGravity * 6.0 * (2.0 - height);
  if (std::abs((*response)->bodies[0].force[2] - force) > 1e-9 * force) {
    throw std::runtime_error("request " + std::to_string(number) + " got a wrong response");
  }
}

bool run(std::int64_t requests, Record& record) {
  using Steady = std::chrono::steady_clock;
  RunningService service;
  ClientOptions options;
  options.channel.cancelled = &stop_requested;
  Expected<Client> client = Client::open(options);
  if (!client) throw std::runtime_error(client.error().message());
  const auto sample_memory = [&] {
    return Memory{resident_kb(service.child().pid()), resident_kb(::getpid())};
  };

  const std::int64_t first = record.done();
  Memory warm;
  auto reported = Steady::now();
  std::int64_t reported_at = first;
  std::printf("%12s %10s %14s %14s\n", "requests", "per second", "buoyancyd, kB", "client, kB");
  for (std::int64_t number = first; number < requests && !stop_requested;) {
    send_request(*client, number++);
    if (number % kSampleInterval != 0 && number != requests) continue;
    record.store(number);
    if (warm.service == 0 && number - first >= std::min(kWarmUp, (requests - first) / 2))
      warm = sample_memory();
    const double since = std::chrono::duration<double>(Steady::now() - reported).count();
    if (since < kReportInterval && number != requests) continue;
    const Memory now = sample_memory();
    std::printf("%12" PRId64 " %10.0f %14" PRId64 " %14" PRId64 "\n", number,
                static_cast<double>(number - reported_at) / since, now.service, now.client);
    std::fflush(stdout);
    reported = Steady::now();
    reported_at = number;
  }
  const Memory last = sample_memory();
  const ClientStats stats = client->statistics();
  const bool complete = record.done() >= requests;
  const bool flat = warm.service > 0 && last.service - warm.service <= kMaxGrowth &&
                    last.client - warm.client <= kMaxGrowth;
  std::printf("%" PRId64 " of %" PRId64 " requests, %" PRId64 " of them in this run; %" PRId64
              " retries, %" PRId64 " without response; round trip p50 %.1f us, p99 %.1f us, max %.0f us\n",
              record.done(), requests, stats.requests, stats.retries, stats.unanswered,
              1e6 * stats.round_trip.percentiles().p50, 1e6 * stats.round_trip.percentiles().p99,
              1e6 * stats.round_trip.percentiles().max);
  std::printf("memory (VmRSS) from after the warm-up to the end: buoyancyd %" PRId64 " to %" PRId64
              " kB, client %" PRId64 " to %" PRId64 " kB%s\n",
              warm.service, last.service, warm.client, last.client,
              flat ? "" : ": GROWS, or the run was too short");
  if (stats.requests == 0) return complete;
  return complete && flat && stats.unanswered == 0;
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Send lock-step requests to a running buoyancyd", "soak");
  std::int64_t requests = 1'000'000;
  std::string record = "build/soak";
  bool resume = false;
  command_line.add_number("--requests", requests, std::int64_t{1}, std::int64_t{1} << 40U,
                          "Total number of requests");
  command_line.add_option("--record", record, "Directory that stores the number of completed requests");
  command_line.add_flag("--resume", resume, "Continue the last run");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  std::signal(SIGINT, buoyancy::request_stop);
  std::signal(SIGTERM, buoyancy::request_stop);
  try {
    buoyancy::Record progress(record, resume);
    return buoyancy::run(requests, progress) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
  }
}
