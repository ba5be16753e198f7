// Speed of a replay compared with reading, decoding, encoding and writing the same log without a solver: with
// LCM's own log files and types, and with the replay's own reader and writer. The log holds one body, a box
// that crosses the water surface. Markdown on standard output.
//
//   replay_speed DIRECTORY [LARGE_LOG_MB]
//
// The responses are checked before anything is timed. Finally a log of LARGE_LOG_MB (default 2048) is
// replayed to measure the growth of the process's memory, and with the program as a whole and in parts, to
// measure what the division costs. Exits with 1 if a response is wrong, if the joined parts differ from the
// whole or if the disk is full.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <fcntl.h>
#include <lcm/lcm-cpp.hpp>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fail.h"
#include "median.h"
#include "service/replay/range_hash.h"
#include "service/replay/replay.h"

namespace buoyancy::bench {
namespace {

constexpr int kRuns = 5;
constexpr std::int64_t kEvents = 300'000;
constexpr double kMinSpeedRatio = 0.5;
constexpr int kParts = 7;
constexpr int kPartRuns = 3;
constexpr double kMaxPartsRatio = 1.1;
const std::string kScene = "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, 2] }\n";

double height_at(std::int64_t event) {
  return 0.9 * std::sin(1e-3 * static_cast<double>(event));
}

void write_log(const std::string& path, std::int64_t events) {
  RecordWriter file = value_or_exit(RecordWriter::create(path));
  WrenchRequest request;
  request.bodies.resize(1);
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> event;
  for (std::int64_t i = 0; i < events; ++i) {
    request.id = {.utime = i, .session_id = 1, .seq = i};
    const double half_angle = 1e-4 * static_cast<double>(i);
    request.bodies[0] = {.body_id = 1,
                         .position = {0.0, 0.0, height_at(i)},
                         .quaternion_wxyz = {std::cos(half_angle), 0.0, 0.0, std::sin(half_angle)}};
    encode(request, bytes);
    encode_event(i, i, kStatesChannel, bytes, event);
    value_or_exit(file.append(event));
  }
  value_or_exit(file.flush());
}

void read_and_write(const std::string& input, const std::string& output) {
  EventLogReader reader =
      value_or_exit(EventLogReader::open(input, only_channel(std::string(kStatesChannel))));
  RecordWriter file = value_or_exit(RecordWriter::create(output));
  WrenchRequest request;
  WrenchResponse response;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> event;
  std::int64_t number = 0;
  while (true) {
    const LogItem item = reader.next();
    const auto* recorded = std::get_if<RecordedEvent>(&item);
    if (recorded == nullptr) break;
    if (decode(recorded->bytes, request)) fail("not a request");
    response.id = request.id;
    response.bodies.resize(request.bodies.size());
    for (std::size_t i = 0; i < response.bodies.size(); ++i)
      response.bodies[i].body_id = request.bodies[i].body_id;
    encode(response, bytes);
    encode_event(number++, recorded->timestamp, kWrenchesChannel, bytes, event);
    value_or_exit(file.append(event));
  }
  value_or_exit(file.flush());
}

// The same with LCM's own log files and generated types.
void read_and_write_with_lcm(const std::string& input, const std::string& output) {
  lcm::LogFile reader(input, "r");
  lcm::LogFile writer(output, "w");
  if (!reader.good() || !writer.good()) fail("LCM could not open the logs");
  body_states_t request{};
  body_wrenches_t response{};
  std::vector<std::uint8_t> bytes;
  while (const lcm::LogEvent* event = reader.readNextEvent()) {
    if (request.decode(event->data, 0, event->datalen) < 0) fail("not a request");
    response.utime = request.utime;
    response.session_id = request.session_id;
    response.seq = request.seq;
    response.num_bodies = request.num_bodies;
    response.bodies.resize(request.bodies.size());
    for (std::size_t i = 0; i < response.bodies.size(); ++i)
      response.bodies[i].body_id = request.bodies[i].body_id;
    bytes.resize(static_cast<std::size_t>(response.getEncodedSize()));
    response.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    lcm::LogEvent written{};
    written.timestamp = event->timestamp;
    written.channel = std::string(kWrenchesChannel);
    written.datalen = static_cast<std::int32_t>(bytes.size());
    written.data = bytes.data();
    if (writer.writeEvent(&written) != 0) fail("LCM could not write the log");
  }
}

void replay_log(const Scene& scene, const std::string& input, const std::string& output, unsigned jobs) {
  service::ReplayChannels channels = value_or_exit(service::ReplayChannels::make(
      {.states = std::string(kStatesChannel), .sea = "", .condition = "", .water_points = ""}, {}, {}, {}));
  PoseRequestAdapter poses({}, 1);
  service::ReplayInput reader = value_or_exit(service::ReplayInput::open(
      input, service::FileFormat::kLcmLog, only_channel(std::string(kStatesChannel))));
  service::ReplayOutput writer =
      value_or_exit(service::ReplayOutput::create(output, service::FileFormat::kLcmLog));
  TerminationSignals signals;
  const service::ReplaySummary summary = value_or_exit(
      service::replay({.scene = scene,
                       .input = reader,
                       .channels = channels,
                       .poses = poses,
                       .output = writer,
                       .layout = {service::FileFormat::kLcmLog, std::string(kWrenchesChannel),
                                  std::string(kHydrostaticsChannel), std::string(kLoadsChannel),
                                  std::string(kWaterSamplesChannel)},
                       .jobs = jobs},
                      signals, {[](const std::string&) {}, [](std::int64_t, std::int64_t, std::int64_t) {}}));
  if (!summary.complete()) fail("the replay was not complete");
}

void check_responses(const std::string& path) {
  EventLogReader reader =
      value_or_exit(EventLogReader::open(path, only_channel(std::string(kWrenchesChannel))));
  WrenchResponse response;
  for (std::int64_t i = 0; i < kEvents; ++i) {
    const LogItem item = reader.next();
    const auto* recorded = std::get_if<RecordedEvent>(&item);
    if (recorded == nullptr || decode(recorded->bytes, response)) fail("a response is missing");
    const double volume = 2.0 * 3.0 * (1.0 - height_at(i));
    if (!(std::abs(response.bodies.at(0).submerged_volume - volume) < 1e-12)) {
      fail("response " + std::to_string(i) + " is wrong");
    }
  }
}

struct Seconds {
  double wall, processor;  // processor: sum over all threads
};

Seconds seconds_of(const std::function<void()>& task) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::clock_t processor_start = std::clock();
  task();
  return {std::chrono::duration<double>(Clock::now() - start).count(),
          static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC};
}

// Times of several runs of the same task [s].
struct Times {
  std::vector<double> wall, processor;

  void add(const Seconds& seconds) {
    wall.push_back(seconds.wall);
    processor.push_back(seconds.processor);
  }
};

double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Runs buoyancy-replay and returns its processor time [s].
double program_seconds(std::vector<std::string> arguments) {
  std::string program = BUOYANCY_REPLAY;
  std::vector<char*> argv{program.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t pid = -1;
  if (::posix_spawn(&pid, program.c_str(), &actions, nullptr, argv.data(), environ) != 0) {
    fail("buoyancy-replay could not be started");
  }
  ::posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  if (::wait4(pid, &status, 0, &usage) != pid || status != 0) fail("buoyancy-replay failed");
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::string hash_of(const std::string& path) {
  FileWindow file = value_or_exit(FileWindow::open(path));
  const std::int64_t size = file.size();
  service::RangeHash hash(std::move(file), 0);
  value_or_exit(hash.extend_to(size));
  return hash.hash();
}

// Compares the processor time of a replay in parts with that of the whole, and their outputs.
void measure_parts(const std::string& directory, const std::string& input) {
  const std::string scene = directory + "/scene.toml";
  std::ofstream(scene) << kScene;
  const std::string output = directory + "/out.lcmlog";
  const std::vector<std::string> arguments{"--scene", scene, "--jobs", "1", input, output};
  double whole = std::numeric_limits<double>::infinity();
  double parts = whole;
  double join = whole;
  for (int run = 0; run < kPartRuns; ++run) {
    whole = std::min(whole, program_seconds(arguments));
    const std::string hash = hash_of(output);
    std::filesystem::remove(output);
    double sum = 0.0;
    for (int number = 1; number <= kParts; ++number) {
      std::vector<std::string> part{"--part", std::to_string(number) + "/" + std::to_string(kParts)};
      part.insert(part.end(), arguments.begin(), arguments.end());
      sum += program_seconds(part);
    }
    parts = std::min(parts, sum);
    join = std::min(join, program_seconds({"--join", std::to_string(kParts), input, output}));
    if (hash_of(output) != hash) fail("the joined parts differ from the whole");
    for (int number = 1; number <= kParts; ++number) {
      std::filesystem::remove(service::part_path(output, {number, kParts}));
    }
  }
  std::printf(
      "\nThe same log in %d parts took %.2f times the processor time of the whole (at most %.1f: %s), and "
      "joining them %.2f times. The joined output is the same.\n",
      kParts, parts / whole, kMaxPartsRatio, parts / whole <= kMaxPartsRatio ? "met" : "MISSED",
      join / whole);
}

void run(const std::string& directory, std::int64_t large_megabytes) {
  SceneDescription description = value_or_exit(parse_scene(kScene, "a box", directory));
  const Scene scene = value_or_exit(Scene::prepare(description));
  const std::string input = directory + "/in.lcmlog";
  const std::string output = directory + "/out.lcmlog";
  write_log(input, kEvents);
  replay_log(scene, input, output, 0);
  check_responses(output);

  Times with_lcm;
  Times no_solver;
  Times one_job;
  Times all_jobs;
  for (int i = 0; i < kRuns; ++i) {
    with_lcm.add(seconds_of([&] { read_and_write_with_lcm(input, output); }));
    no_solver.add(seconds_of([&] { read_and_write(input, output); }));
    one_job.add(seconds_of([&] { replay_log(scene, input, output, 1); }));
    all_jobs.add(seconds_of([&] { replay_log(scene, input, output, 0); }));
  }
  std::printf(
      "| %lld requests about a box | per second | processor time each, us | speed / first row | speed / "
      "second "
      "row |  |\n",
      static_cast<long long>(kEvents));
  std::printf("|---|---:|---:|---:|---:|---|\n");
  const auto print_row = [&](const char* name, const Times& times, bool has_limit) {
    const double events = static_cast<double>(kEvents);
    const double relative_to_lcm = median(with_lcm.wall) / median(times.wall);
    const double relative_to_no_solver = median(no_solver.wall) / median(times.wall);
    const char* verdict = "";
    if (has_limit && relative_to_no_solver >= kMinSpeedRatio) verdict = "at least 0.5 of both: met";
    if (has_limit && relative_to_no_solver < kMinSpeedRatio)
      verdict = "at least 0.5 of the first: met; of the second: MISSED";
    if (has_limit && relative_to_lcm < kMinSpeedRatio) verdict = "at least 0.5: MISSED";
    std::printf("| %s | %.0f | %.2f | %.2f | %.2f | %s |\n", name, events / median(times.wall),
                1e6 * median(times.processor) / events, relative_to_lcm, relative_to_no_solver, verdict);
  };
  print_row("read, decode, encode and write with LCM's own log files and types; no solver", with_lcm, false);
  print_row("the same with the replay's reader and writer; no solver", no_solver, false);
  print_row("replay, one job", one_job, true);
  print_row("replay, all processors", all_jobs, true);

  const double before = peak_megabytes();
  constexpr std::int64_t kBytesPerEvent = 207;  // written by write_log()
  write_log(input, large_megabytes * 1'048'576 / kBytesPerEvent);
  const double large = seconds_of([&] { replay_log(scene, input, output, 0); }).wall;
  std::printf("\nA log of %lld MB took %.0f s; the peak memory use grew from %.1f to %.1f MB.\n",
              static_cast<long long>(large_megabytes), large, before, peak_megabytes());
  measure_parts(directory, input);
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: replay_speed DIRECTORY [LARGE_LOG_MB]\n");
    return 2;
  }
  buoyancy::bench::run(argv[1], argc > 2 ? std::atoll(argv[2]) : 2048);
  return 0;
}
