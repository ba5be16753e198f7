// Scalability of buoyancy-report for long logs: processing time, memory, page size, and time until a browser
// shows the page. Markdown on standard output.
//
//   report_page_size DIRECTORY [LOG_MB]
//
// The logs of LOG_MB (default 2048) hold requests and responses about one body and about a hundred bodies
// that move in the water. Exits with 1 if a page cannot be made or does not open.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/resource.h>

#include "engine/request_handler.h"
#include "fail.h"
#include "recording/event_log.h"
#include "recording/record_writer.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/view/browser.h"

namespace buoyancy::bench {
namespace {

constexpr double kReportTimeout = 3'600.0;  // [s]
constexpr double kMegabyte = 1e6;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string write_scene(const std::string& directory, int bodies) {
  std::string text;
  for (int id = 1; id <= bodies; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) +
            "\nshape = { type = \"rock\", radius = 1.0, frequency = 8 }\n[body.client]\ndensity = 500.0\n";
  }
  std::string path = directory + "/" + std::to_string(bodies) + ".toml";
  RecordWriter file = value_or_exit(RecordWriter::create(path));
  value_or_exit(file.append({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  value_or_exit(file.flush());
  return path;
}

// Writes a thousand requests per second of simulated time, with their responses. Returns the number of rows.
std::int64_t write_log(const Scene& scene, const std::string& path, std::int64_t bytes) {
  RecordWriter file = value_or_exit(RecordWriter::create(path));
  RequestHandler handler(scene);
  WrenchRequest request;
  request.bodies.resize(scene.bodies().size());
  std::vector<std::uint8_t> request_bytes;
  std::vector<std::uint8_t> event;
  std::int64_t written = 0;
  std::int64_t seq = 0;
  for (; written < bytes; ++seq) {
    request.id = {.utime = 1'000 * seq, .session_id = 1, .seq = seq};
    const double seconds = 1e-3 * static_cast<double>(seq);
    for (std::size_t i = 0; i < request.bodies.size(); ++i) {
      const auto place = static_cast<double>(i);
      const double half_angle = 0.1 * std::sin(0.7 * seconds + place);
      request.bodies[i] = {.body_id = scene.bodies()[i].id,
                           .position = {3.0 * std::fmod(place, 10.0), 3.0 * std::floor(place / 10.0),
                                        0.4 * std::sin(seconds + place)},
                           .quaternion_wxyz = {std::cos(half_angle), std::sin(half_angle), 0.0, 0.0}};
    }
    encode(request, request_bytes);
    const Bytes response = handler.handle(request_bytes);
    encode_event(2 * seq, 1'000 * seq, kStatesChannel, request_bytes, event);
    value_or_exit(file.append(event));
    written += static_cast<std::int64_t>(event.size());
    encode_event(2 * seq + 1, 1'000 * seq + 40, kWrenchesChannel, response, event);
    value_or_exit(file.append(event));
    written += static_cast<std::int64_t>(event.size());
  }
  value_or_exit(file.flush());
  return seq * static_cast<std::int64_t>(scene.bodies().size());
}

// Peak memory of all programs that have ended so far [MB].
double max_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1'024.0 / kMegabyte;
}

struct ReportRun {
  int bodies = 0;
  std::int64_t rows = 0;
  double log_megabytes = 0.0;
  double seconds = 0.0;
  double memory = 0.0;  // [MB], maximum of this report and the smaller ones before
  std::string page;
};

ReportRun make_page(const std::string& directory, int bodies, std::int64_t megabytes) {
  const std::string scene = write_scene(directory, bodies);
  const std::string log = directory + "/run.lcmlog";
  ReportRun result{.bodies = bodies, .page = directory + "/" + std::to_string(bodies) + ".html"};
  result.rows = write_log(value_or_exit(Scene::load(scene)), log, megabytes << 20U);
  result.log_megabytes = static_cast<double>(std::filesystem::file_size(log)) / kMegabyte;
  const Clock::time_point start = Clock::now();
  const FinishedProcess finished = run_to_end(
      command_of({built_program("buoyancy-report"), "--scene", scene, log, result.page}), kReportTimeout);
  result.seconds = seconds_since(start);
  result.memory = max_memory();
  std::filesystem::remove(log);
  if (finished.exit_code != 0) fail(finished.standard_error);
  return result;
}

// Time from the start of loading to the first frame, by the page's own clock [s].
double opening_time(view::Browser& browser, const std::string& page) {
  browser.open_file(page);
  return 1e-3 * browser.wait_until("window.buoyancy_report && buoyancy_report.shown_after").get<double>();
}

void run(const std::string& directory, std::int64_t megabytes) {
  std::vector<ReportRun> reports;
  for (const int bodies : {1, 100}) reports.push_back(make_page(directory, bodies, megabytes));
  view::Browser browser;
  std::printf(
      "| log | rows | processing | memory | page | time to display "
      "|\n|---|---:|---:|---:|---:|---:|\n");
  for (const ReportRun& report : reports) {
    std::printf("| %.0f MB, %d %s | %lld | %.0f s | %.0f MB | %.1f MB | %.1f s |\n", report.log_megabytes,
                report.bodies, report.bodies == 1 ? "body" : "bodies", static_cast<long long>(report.rows),
                report.seconds, report.memory,
                static_cast<double>(std::filesystem::file_size(report.page)) / kMegabyte,
                opening_time(browser, report.page));
  }
}

}  // namespace
}  // namespace buoyancy::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: report_page_size DIRECTORY [LOG_MB]\n");
    return 2;
  }
  buoyancy::bench::run(argv[1], argc > 2 ? std::atoll(argv[2]) : 2048);
  return 0;
}
