// Cost of drag and added mass: scenes of a thousand boxes with and without these tables, in water at rest.
// Each request goes in as bytes and its response comes out as bytes, as in the service, but without the
// network. Markdown on standard output.
//
// Every body moves at every step, so that no result is cached, and all scenes get the same requests.
// Before the time is measured, the wrenches with the tables must be those without, plus the load of
// HydrodynamicModel at the published immersion; otherwise the program exits with 1.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "engine/request_handler.h"
#include "fail.h"
#include "markdown_table.h"
#include "median.h"
#include "messages/conversions.h"
#include "messages/wire.h"

namespace buoyancy::bench {
namespace {

constexpr int kBodies = 1000;
constexpr int kSteps = 100;
constexpr int kSweeps = 12;
constexpr double kLimit = 300.0;  // [ns] per body

enum class Coefficients { kNone, kEqual, kDifferent, kFull };

// Of a small underwater vehicle. Bodies with equal ones share the memory that is read.
std::string tables(Coefficients coefficients, int id) {
  if (coefficients == Coefficients::kNone) return "";
  const std::string surge = coefficients == Coefficients::kEqual ? "4" : "4." + std::to_string(id);
  if (coefficients != Coefficients::kFull) {
    return "[body.drag]\nlinear = [" + surge +
           ", 6, 5, 0.07, 0.07, 0.07]\nquadratic = [18, 22, 37, 1.5, 1.5, 1.5]\n"
           "[body.added_mass]\nmatrix = [5.5, 12.7, 14.6, 0.12, 0.12, 0.12]\n";
  }
  const std::string rows =
      ", 0.01, 0, 0, 0.02, 0, 0.01, 6, 0, 0.02, 0, 0.01, 0, 0, 5, 0, 0, 0, 0, 0.02, 0, 0.5, 0, 0, 0.02, 0, "
      "0, "
      "0, 0.5, 0, 0, 0.01, 0, 0, 0, 0.5]\n";
  return "[body.drag]\nlinear = [" + surge + rows + "quadratic = [" + surge + rows +
         "[body.added_mass]\nmatrix = [" + surge + rows;
}

Scene boxes(const char* outputs, Coefficients coefficients) {
  std::string text;
  for (int id = 1; id <= kBodies; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) +
            "\nshape = { type = \"box\", size = [0.46, 0.34, 0.25], segments = [10, 10, 10] }\noutputs = [" +
            outputs + "]\n" + tables(coefficients, id);
  }
  const SceneDescription description = value_or_exit(parse_scene(text, "a thousand boxes", {}));
  return value_or_exit(Scene::prepare(description));
}

// height: [m], of the bodies over the water, about which they heave a little.
WrenchRequest request_at(int step, double height) {
  WrenchRequest request;
  request.id = {.utime = 0, .session_id = 1, .seq = step};
  for (int id = 1; id <= kBodies; ++id) {
    const double angle = 0.1 * id + 0.01 * step;
    BodyState state;
    state.body_id = id;
    state.position = {0.3 * id, 0.0, height + 0.05 * std::sin(7.0 * angle)};
    state.quaternion_wxyz = {std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle), 0.0};
    state.linear_velocity = {std::cos(angle), 0.5, std::sin(angle)};
    state.angular_velocity = {0.3, std::sin(angle), -0.2};
    request.bodies.push_back(state);
  }
  return request;
}

std::vector<std::uint8_t> encoded(const WrenchRequest& request) {
  std::vector<std::uint8_t> bytes;
  encode(request, bytes);
  return bytes;
}

WrenchResponse response_of(const Scene& scene, const WrenchRequest& request) {
  RequestHandler handler(scene, {.threads = 1});
  WrenchResponse response;
  if (decode(handler.handle(encoded(request)), response)) fail("a response that cannot be decoded");
  return response;
}

// The wrenches with the tables, against those without them and the formulas.
void check_loads(const Scene& without, const Scene& with, double height) {
  const WrenchRequest request = request_at(0, height);
  const WrenchResponse buoyancy = response_of(without, request);
  const WrenchResponse total = response_of(with, request);
  for (std::size_t i = 0; i < with.bodies().size(); ++i) {
    const Body& body = with.bodies()[i];
    const BodyState& state = request.bodies[i];
    const auto& q = state.quaternion_wxyz;
    HydrodynamicState motion;
    motion.motion = {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix(),
                     to_vec3(state.linear_velocity), to_vec3(state.angular_velocity)};
    const double immersion = buoyancy.bodies[i].submerged_volume / body.prepared_mesh->mesh.volume;
    motion.at_drag.immersion.value = motion.at_added_mass.immersion.value = immersion;
    const HydrodynamicLoad load = body.hydrodynamics->load(motion);
    const Vec6 expected = load.drag_W + load.added_mass_W;
    const Vec3 force = to_vec3(total.bodies[i].force) - to_vec3(buoyancy.bodies[i].force);
    const Vec3 torque = to_vec3(total.bodies[i].torque) - to_vec3(buoyancy.bodies[i].torque);
    constexpr double kRelative = 1e-10;
    const double scale = to_vec3(total.bodies[i].force).norm() + to_vec3(total.bodies[i].torque).norm();
    if (!((force - expected.head<3>()).norm() <= kRelative * scale) ||
        !((torque - expected.tail<3>()).norm() <= kRelative * scale)) {
      fail("a wrong load of body " + std::to_string(body.id));
    }
  }
}

constexpr std::size_t kScenes = 3;              // without tables, with them, and with the output "loads"
using StepTimes = std::array<double, kScenes>;  // [ns]

// The minimum over the sweeps for each step, the median over the steps. The scenes take turns, sweep by
// sweep: each finds its own data in the caches, as in a service.
StepTimes time_steps(const std::array<const Scene*, kScenes>& scenes, double height) {
  using Clock = std::chrono::steady_clock;
  std::vector<RequestHandler> handlers;
  for (const Scene* scene : scenes) handlers.emplace_back(*scene, RequestHandlerOptions{.threads = 1});
  std::array<std::vector<double>, kScenes> times;
  for (std::vector<double>& of_scene : times)
    of_scene.resize(kSteps, std::numeric_limits<double>::infinity());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::vector<std::vector<std::uint8_t>> requests;
    for (int step = 0; step < kSteps; ++step) {
      WrenchRequest request = request_at(step, height);
      request.id.seq = sweep * kSteps + step;
      requests.push_back(encoded(request));
    }
    for (std::size_t i = 0; i < kScenes; ++i) {
      for (std::size_t step = 0; step < requests.size(); ++step) {
        const auto start = Clock::now();
        handlers[i].handle(requests[step]);
        const double time = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
        times[i][step] = std::min(times[i][step], time);
      }
    }
  }
  StepTimes medians{};
  for (std::size_t i = 0; i < kScenes; ++i) medians[i] = median(times[i]);
  return medians;
}

struct Row {
  const char* bodies;
  double height;  // [m]
  Coefficients coefficients;
  const char* name;
};

int run() {
  std::printf(
      "A thousand boxes of 1,200 triangles in water at rest, all moving, method hierarchical, from request\n"
      "bytes to response bytes. Limit: 300 ns more per body with both tables. The last column is for the\n"
      "output `loads`, which also has the matrices of added mass and damping.\n\n");
  std::printf(
      "| bodies | coefficients | without, us | with both tables, us | ratio | more per body, ns | | more "
      "with "
      "loads, ns |\n");
  std::printf("|---|---|---:|---:|---:|---:|---|---:|\n");
  const Scene without = boxes("\"wrench\"", Coefficients::kNone);
  for (const Row& row : {Row{"surface-piercing", 0.0, Coefficients::kEqual, "equal"},
                         Row{"surface-piercing", 0.0, Coefficients::kDifferent, "all different"},
                         Row{"surface-piercing", 0.0, Coefficients::kFull, "all different, full matrices"},
                         Row{"fully submerged", -5.0, Coefficients::kEqual, "equal"},
                         Row{"fully submerged", -5.0, Coefficients::kFull, "all different, full matrices"},
                         Row{"dry", 5.0, Coefficients::kEqual, "equal"}}) {
    const Scene with = boxes("\"wrench\"", row.coefficients);
    const Scene published = boxes("\"wrench\", \"loads\"", row.coefficients);
    check_loads(without, with, row.height);
    const StepTimes times = time_steps({&without, &with, &published}, row.height);
    const double more = (times[1] - times[0]) / kBodies;
    std::printf("| %s | %s | %.1f | %.1f | %.2f | %.0f | %s | %.0f |\n", row.bodies, row.name, times[0] / 1e3,
                times[1] / 1e3, times[1] / times[0], more, pass_or_fail(more <= kLimit).c_str(),
                (times[2] - times[0]) / kBodies);
  }
  return 0;
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  return buoyancy::bench::run();
}
