// What buoyancy-report makes of long logs: how long it takes, how large the page gets, how soon a browser
// shows it. Markdown on standard output.
//
//   report_page_size DIRECTORY [LOG_MB]
//
// Logs of LOG_MB (default 2048) with requests and answers, of one body and of a hundred that bob in the
// water. Exit 1 where a page cannot be made or does not open.
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
#include "tests/support/child_process.h"
#include "tests/view/browser.h"

namespace buoyancy::bench {
namespace {

constexpr double kLongest = 3'600.0;  // s
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

// A thousand requests a second of simulated time, and their responses. Returns the number of rows.
std::int64_t write_log(const Scene& scene, const std::string& path, std::int64_t bytes) {
  RecordWriter file = value_or_exit(RecordWriter::create(path));
  RequestHandler handler(scene);
  WrenchRequest request;
  request.bodies.resize(scene.bodies().size());
  std::vector<std::uint8_t> asked;
  std::vector<std::uint8_t> event;
  std::int64_t written = 0;
  std::int64_t seq = 0;
  for (; written < bytes; ++seq) {
    request.key = {.utime = 1'000 * seq, .session_id = 1, .seq = seq};
    const double seconds = 1e-3 * static_cast<double>(seq);
    for (std::size_t i = 0; i < request.bodies.size(); ++i) {
      const auto place = static_cast<double>(i);
      const double half_angle = 0.1 * std::sin(0.7 * seconds + place);
      request.bodies[i] = {.body_id = scene.bodies()[i].id,
                           .position = {3.0 * std::fmod(place, 10.0), 3.0 * std::floor(place / 10.0),
                                        0.4 * std::sin(seconds + place)},
                           .quaternion_wxyz = {std::cos(half_angle), std::sin(half_angle), 0.0, 0.0}};
    }
    encode(request, asked);
    const Bytes response = handler.handle(asked);
    encode_event(2 * seq, 1'000 * seq, kStatesChannel, asked, event);
    value_or_exit(file.append(event));
    written += static_cast<std::int64_t>(event.size());
    encode_event(2 * seq + 1, 1'000 * seq + 40, kWrenchesChannel, response, event);
    value_or_exit(file.append(event));
    written += static_cast<std::int64_t>(event.size());
  }
  value_or_exit(file.flush());
  return seq * static_cast<std::int64_t>(scene.bodies().size());
}

// MB, of any program that has run to its end.
double max_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1'024.0 / kMegabyte;
}

struct Made {
  int bodies = 0;
  std::int64_t rows = 0;
  double log_megabytes = 0.0;
  double seconds = 0.0;
  double memory = 0.0;  // MB, of this report or a smaller one before
  std::string page;
};

Made make_page(const std::string& directory, int bodies, std::int64_t megabytes) {
  const std::string scene = write_scene(directory, bodies);
  const std::string log = directory + "/run.lcmlog";
  Made made{.bodies = bodies, .page = directory + "/" + std::to_string(bodies) + ".html"};
  made.rows = write_log(value_or_exit(Scene::load(scene)), log, megabytes << 20U);
  made.log_megabytes = static_cast<double>(std::filesystem::file_size(log)) / kMegabyte;
  const Clock::time_point start = Clock::now();
  const FinishedProcess finished =
      run_to_end(command_of({BUOYANCY_REPORT, "--scene", scene, log, made.page}), kLongest);
  made.seconds = seconds_since(start);
  made.memory = max_memory();
  std::filesystem::remove(log);
  if (finished.exit_code != 0) fail(finished.standard_error);
  return made;
}

// s, from the start of loading to the first picture, by the page's own clock.
double opening_time(view::Browser& browser, const std::string& page) {
  browser.open_file(page);
  return 1e-3 * browser.wait_until("window.buoyancy_report && buoyancy_report.shown_after").get<double>();
}

void run(const std::string& directory, std::int64_t megabytes) {
  std::vector<Made> pages;
  for (const int bodies : {1, 100}) pages.push_back(make_page(directory, bodies, megabytes));
  view::Browser browser;
  std::printf(
      "| log | rows | made in | memory | page | shown in a browser after "
      "|\n|---|---:|---:|---:|---:|---:|\n");
  for (const Made& made : pages) {
    std::printf("| %.0f MB, %d %s | %lld | %.0f s | %.0f MB | %.1f MB | %.1f s |\n", made.log_megabytes,
                made.bodies, made.bodies == 1 ? "body" : "bodies", static_cast<long long>(made.rows),
                made.seconds, made.memory,
                static_cast<double>(std::filesystem::file_size(made.page)) / kMegabyte,
                opening_time(browser, made.page));
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
