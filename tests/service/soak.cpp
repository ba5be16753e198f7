// Lock-step requests to a real buoyancyd for as long as one likes, as fast as the responses come.
//
//   soak [--requests N] [--record DIRECTORY] [--resume]
//
// Every response is awaited and checked: a box's force is known. Prints once in a while how many requests
// there were, how fast, and what buoyancyd and this process occupy. The number done is kept in the record, so
// that with --resume a run goes on where the last one stopped, with a buoyancyd of its own.
//
// To be run in a network namespace with a multicast route (scripts/soak). Exit codes: 0 all requests
// answered and no growth; 1 not so, or interrupted; 2 wrong arguments.
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

constexpr std::int64_t kBetweenLooks = 10'000;  // requests
constexpr std::int64_t kWarmUp = 100'000;       // requests until every buffer is as large as it gets
constexpr std::int64_t kMaxGrowth = 1'024;        // kB
constexpr double kBetweenReports = 10.0;        // s

std::atomic<bool> stop_requested{false};

void request_stop(int /*signal*/) {
  stop_requested.store(true);
}

struct Memory {
  std::int64_t service = 0, client = 0;  // kB
};

class Record {
 public:
  Record(const std::filesystem::path& directory, bool resume) : path_(directory / "requests_done") {
    std::filesystem::create_directories(directory);
    if (resume) std::ifstream(path_) >> done_;
  }
  std::int64_t done() const { return done_; }

  // Whole or not at all: a run may be killed at any time.
  void keep(std::int64_t done) {
    done_ = done;
    const std::filesystem::path draft = path_.string() + ".new";
    std::ofstream(draft) << done << '\n';
    std::filesystem::rename(draft, path_);
  }

 private:
  std::filesystem::path path_;
  std::int64_t done_ = 0;
};

void ask_one(Client& client, std::int64_t number) {
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
    throw std::runtime_error("request " + std::to_string(number) + " was answered wrongly");
  }
}

bool run(std::int64_t requests, Record& record) {
  using Steady = std::chrono::steady_clock;
  RunningService service;
  ClientOptions options;
  options.channel.cancelled = &stop_requested;
  Expected<Client> client = Client::open(options);
  if (!client) throw std::runtime_error(client.error().message());
  const auto look = [&] { return Memory{resident_kb(service.child().pid()), resident_kb(::getpid())}; };

  const std::int64_t first = record.done();
  Memory warm;
  auto reported = Steady::now();
  std::int64_t reported_at = first;
  std::printf("%12s %10s %14s %14s\n", "requests", "per second", "buoyancyd, kB", "client, kB");
  for (std::int64_t number = first; number < requests && !stop_requested;) {
    ask_one(*client, number++);
    if (number % kBetweenLooks != 0 && number != requests) continue;
    record.keep(number);
    if (warm.service == 0 && number - first >= std::min(kWarmUp, (requests - first) / 2)) warm = look();
    const double since = std::chrono::duration<double>(Steady::now() - reported).count();
    if (since < kBetweenReports && number != requests) continue;
    const Memory now = look();
    std::printf("%12" PRId64 " %10.0f %14" PRId64 " %14" PRId64 "\n", number,
                static_cast<double>(number - reported_at) / since, now.service, now.client);
    std::fflush(stdout);
    reported = Steady::now();
    reported_at = number;
  }
  const Memory last = look();
  const ClientStats asked = client->statistics();
  const bool complete = record.done() >= requests;
  const bool flat =
      warm.service > 0 && last.service - warm.service <= kMaxGrowth && last.client - warm.client <= kMaxGrowth;
  std::printf("%" PRId64 " of %" PRId64 " requests, %" PRId64 " of them in this run; %" PRId64
              " asked again, %" PRId64 " not answered; round trip p50 %.1f us, p99 %.1f us, max %.0f us\n",
              record.done(), requests, asked.requests, asked.retries, asked.unanswered,
              1e6 * asked.round_trip.percentiles().p50, 1e6 * asked.round_trip.percentiles().p99,
              1e6 * asked.round_trip.percentiles().max);
  std::printf("memory (VmRSS) from after the warm-up to the end: buoyancyd %" PRId64 " to %" PRId64
              " kB, client %" PRId64 " to %" PRId64 " kB%s\n",
              warm.service, last.service, warm.client, last.client,
              flat ? "" : ": GROWS, or too short a run to say");
  if (asked.requests == 0) return complete;
  return complete && flat && asked.unanswered == 0;
}

}  // namespace
}  // namespace buoyancy

int main(int argc, char** argv) {
  buoyancy::ToolCommandLine command_line("Lock-step requests to a real buoyancyd", "soak");
  std::int64_t requests = 1'000'000;
  std::string record = "build/soak";
  bool resume = false;
  command_line.add_number("--requests", requests, std::int64_t{1}, std::int64_t{1} << 40U,
                          "Until so many are done");
  command_line.add_option("--record", record, "Directory that keeps how many are done");
  command_line.add_flag("--resume", resume, "Go on where the last run stopped");
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  std::signal(SIGINT, buoyancy::request_stop);
  std::signal(SIGTERM, buoyancy::request_stop);
  try {
    buoyancy::Record kept(record, resume);
    return buoyancy::run(requests, kept) ? 0 : 1;
  } catch (const std::exception& failed) {
    std::fprintf(stderr, "soak: %s\n", failed.what());
    return 1;
  }
}
