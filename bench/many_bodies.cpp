// A scene of a thousand rocks of which ten cross the water: what the bodies that need nothing cost. A
// request goes in as bytes and its response comes out as bytes, as in the service, without the network.
// Markdown on standard output.
//
// Every body moves at every step, so that none is answered from memory; the last row has them all at rest.
// The counters are checked after every row: a step that skipped too little, or too much, ends the program
// with 1.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/request_handler.h"
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

// What one row measures.
struct Row {
  unsigned threads;  // 0: all
  double height;     // m, of the others over the water
  bool moving;
};

// The first `bodies` of the scene at one step; the first ten cross the water.
std::vector<std::uint8_t> request_at(int bodies, int step, const Row& row) {
  WrenchRequest request;
  request.key = {.utime = 0, .session_id = 1, .seq = step};
  const double time = row.moving ? 0.01 * step : 0.0;
  for (int id = 1; id <= bodies; ++id) {
    BodyState state;
    state.body_id = id;
    const double half_angle = 0.1 * id + time;
    state.position = {0.3 * id, 0.0,
                      (id <= kCrossing ? 0.08 * id - 0.4 : row.height) + 1e-3 * std::sin(time)};
    state.quaternion_wxyz = {std::cos(half_angle), 0.6 * std::sin(half_angle), 0.8 * std::sin(half_angle),
                             0.0};
    request.bodies.push_back(state);
  }
  std::vector<std::uint8_t> bytes;
  encode(request, bytes);
  return bytes;
}

// ns, median over the steps.
struct StepTimes {
  double all, crossing_alone;
};

bool time_steps(const Scene& scene, const Row& row, StepTimes& times) {
  using Clock = std::chrono::steady_clock;
  RequestHandler all(scene, {.threads = row.threads});
  RequestHandler alone(scene, {.threads = row.threads});
  std::vector<double> of_all;
  std::vector<double> of_alone;
  for (int step = 0; step < kSteps; ++step) {
    const auto every_body = request_at(kBodies, step, row);
    const auto crossing = request_at(kCrossing, step, row);
    const auto start = Clock::now();
    all.handle(every_body);
    const auto between = Clock::now();
    alone.handle(crossing);
    const auto end = Clock::now();
    of_all.push_back(std::chrono::duration<double, std::nano>(between - start).count());
    of_alone.push_back(std::chrono::duration<double, std::nano>(end - between).count());
  }
  times = {median(of_all), median(of_alone)};
  const ServiceCounters& counters = all.counters();
  const std::int64_t unchanged = row.moving ? 0 : std::int64_t{kBodies} * (kSteps - 1);
  const std::int64_t others = std::int64_t{kBodies - kCrossing} * kSteps;
  return counters.bodies_crossing == std::int64_t{kCrossing} * kSteps &&
         counters.bodies_dry == (row.height > 0.0 ? others : 0) &&
         counters.bodies_wet == (row.height < 0.0 ? others : 0) && counters.bodies_unchanged == unchanged;
}

int run() {
  const Expected<Scene> scene = rocks();
  if (!scene) {
    std::fprintf(stderr, "many_bodies: %s\n", scene.error().message().c_str());
    return 1;
  }
  std::printf("### A thousand bodies of which ten cross the water\n\n");
  std::printf(
      "Rocks of 5,120 triangles, hierarchical, a request's bytes in, its response's bytes out. Held to 1.5 "
      "times what "
      "the\nten cost alone and 100 ns for each of the others.\n\n");
  std::printf(
      "| bodies | the others | threads | all, us | the ten alone, us | each of the others, ns | held to, us "
      "| |\n");
  std::printf("|---|---|---:|---:|---:|---:|---:|---|\n");
  for (const Row& row : {Row{1, 5.0, true}, Row{0, 5.0, true}, Row{1, -5.0, true}, Row{1, 5.0, false}}) {
    StepTimes times{};
    if (!time_steps(*scene, row, times)) {
      std::fprintf(stderr, "many_bodies: the counters do not say %d crossing and %d other bodies a step\n",
                   kCrossing, kBodies - kCrossing);
      return 1;
    }
    const double others = kBodies - kCrossing;
    const double allowed = 1.5 * times.crossing_alone + 100.0 * others;
    std::printf("| %s | %s | %s | %.1f | %.1f | %.0f | %.1f | %s |\n", row.moving ? "moving" : "at rest",
                row.height > 0.0 ? "above" : "below", row.threads == 1 ? "1" : "all", times.all / 1e3,
                times.crossing_alone / 1e3, (times.all - times.crossing_alone) / others, allowed / 1e3,
                times.all <= allowed ? "met" : "MISSED");
  }
  return 0;
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  return buoyancy::bench::run();
}
