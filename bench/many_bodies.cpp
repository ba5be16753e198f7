// Cost of dry and submerged bodies: a scene of a thousand rocks of which ten cross the water surface. Each
// request goes in as bytes and its response comes out as bytes, as in the service, but without the network.
// Markdown on standard output.
//
// Every body moves at every step, so that no result is cached; in the last row all bodies are at rest. The
// counters are checked after every row: if a step evaluated too many or too few bodies, the program exits
// with 1.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/request_handler.h"
#include "markdown_table.h"
#include "median.h"

namespace buoyancy::bench {
namespace {

constexpr int kBodies = 1000;
constexpr int kCrossing = 10;
constexpr int kSteps = 600;

Expected<Scene> rocks() {
  std::string text;
  for (int id = 1; id <= kBodies; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) +
            "\nshape = { type = \"rock\", radius = 1, frequency = 16 }\n";
  }
  Expected<SceneDescription> description = parse_scene(text, "a thousand rocks", {});
  if (!description) return make_error(std::move(description.error()));
  return Scene::prepare(*description);
}

// Configuration of one row.
struct Configuration {
  unsigned threads;  // 0: all
  double height;     // [m], of the other bodies over the water
  bool moving;
};

// Request for the first `bodies` bodies of the scene at one step; the first ten cross the water surface.
std::vector<std::uint8_t> request_at(int bodies, int step, const Configuration& configuration) {
  WrenchRequest request;
  request.id = {.utime = 0, .session_id = 1, .seq = step};
  const double time = configuration.moving ? 0.01 * step : 0.0;
  for (int id = 1; id <= bodies; ++id) {
    BodyState state;
    state.body_id = id;
    const double half_angle = 0.1 * id + time;
    state.position = {0.3 * id, 0.0,
                      (id <= kCrossing ? 0.08 * id - 0.4 : configuration.height) + 1e-3 * std::sin(time)};
    state.quaternion_wxyz = {std::cos(half_angle), 0.6 * std::sin(half_angle), 0.8 * std::sin(half_angle),
                             0.0};
    request.bodies.push_back(state);
  }
  std::vector<std::uint8_t> bytes;
  encode(request, bytes);
  return bytes;
}

// Median over the steps [ns].
struct StepTimes {
  double all, crossing_only;
};

// False: the counters differ from the expected ones.
bool time_steps(const Scene& scene, const Configuration& configuration, StepTimes& times) {
  using Clock = std::chrono::steady_clock;
  RequestHandler all(scene, {.threads = configuration.threads});
  RequestHandler crossing_only(scene, {.threads = configuration.threads});
  std::vector<double> times_all;
  std::vector<double> times_crossing;
  for (int step = 0; step < kSteps; ++step) {
    const auto every_body = request_at(kBodies, step, configuration);
    const auto crossing = request_at(kCrossing, step, configuration);
    const auto start = Clock::now();
    all.handle(every_body);
    const auto between = Clock::now();
    crossing_only.handle(crossing);
    const auto end = Clock::now();
    times_all.push_back(std::chrono::duration<double, std::nano>(between - start).count());
    times_crossing.push_back(std::chrono::duration<double, std::nano>(end - between).count());
  }
  times = {median(times_all), median(times_crossing)};
  const ServiceCounters& counters = all.counters();
  const std::int64_t unchanged = configuration.moving ? 0 : std::int64_t{kBodies} * (kSteps - 1);
  const std::int64_t others = std::int64_t{kBodies - kCrossing} * kSteps;
  return counters.bodies_crossing == std::int64_t{kCrossing} * kSteps &&
         counters.bodies_dry == (configuration.height > 0.0 ? others : 0) &&
         counters.bodies_wet == (configuration.height < 0.0 ? others : 0) &&
         counters.bodies_unchanged == unchanged;
}

int run() {
  const Expected<Scene> scene = rocks();
  if (!scene) {
    std::fprintf(stderr, "many_bodies: %s\n", scene.error().message().c_str());
    return 1;
  }
  std::printf("### One thousand bodies, ten of them surface-piercing\n\n");
  std::printf(
      "Rocks of 5,120 triangles, method hierarchical, from request bytes to response bytes. Limit: 1.5\n"
      "times the time of the ten bodies alone, plus 100 ns for each other body.\n\n");
  std::printf(
      "| bodies | other bodies | threads | all, us | ten alone, us | per other body, ns | limit, us | |\n");
  std::printf("|---|---|---:|---:|---:|---:|---:|---|\n");
  for (const Configuration& row : {Configuration{1, 5.0, true}, Configuration{0, 5.0, true},
                                   Configuration{1, -5.0, true}, Configuration{1, 5.0, false}}) {
    StepTimes times{};
    if (!time_steps(*scene, row, times)) {
      std::fprintf(stderr,
                   "many_bodies: unexpected counters; expected %d crossing and %d other bodies per step\n",
                   kCrossing, kBodies - kCrossing);
      return 1;
    }
    const double others = kBodies - kCrossing;
    const double allowed = 1.5 * times.crossing_only + 100.0 * others;
    std::printf("| %s | %s | %s | %.1f | %.1f | %.0f | %.1f | %s |\n", row.moving ? "moving" : "at rest",
                row.height > 0.0 ? "above" : "below", row.threads == 1 ? "1" : "all", times.all / 1e3,
                times.crossing_only / 1e3, (times.all - times.crossing_only) / others, allowed / 1e3,
                pass_or_fail(times.all <= allowed).c_str());
  }
  return 0;
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  return buoyancy::bench::run();
}
