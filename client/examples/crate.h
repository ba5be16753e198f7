// The crate of both examples, the box of scenes/box.toml and of scenes/crate.toml, and the code that does not
// depend on the engine. The service knows the mesh and the water, and in crate.toml drag and added mass; the
// simulator knows mass and gravity, and damps the crate itself where the scene has no drag.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "client/client.h"
#include "client/coupled_load.h"
#include "client/examples/heave_period.h"

namespace crate {

inline constexpr std::int32_t kBodyId = 1;                    // as in the scene
inline constexpr std::array<double, 3> kSize{1.0, 1.0, 0.5};  // [m]
inline constexpr double kMass = 256.25;                       // [kg], half the mass of water it can displace
inline constexpr double kGravity = 9.80665;                   // [m/s^2]
inline constexpr double kLinearDamping = 500.0;               // [N/(m/s)]
inline constexpr double kAngularDamping = 40.0;               // [N m/(rad/s)]
inline constexpr double kSimulatedTime = 20.0;                // [s]

// Where the crate is released, at rest.
struct Start {
  std::array<double, 3> position{0.0, 0.0, 0.75};           // [m]
  std::array<double, 4> orientation{0.98, 0.15, 0.1, 0.0};  // wxyz, not normalised
};

// Command line: [--loads] [LCM URL [STEP [RETRIES [HEIGHT]]]]. With HEIGHT, the crate is released level at
// this height above its equilibrium, and the period of its heave is printed.
struct Arguments {
  Arguments(int argc, char** argv) {
    std::vector<std::string> given(argv + 1, argv + argc);
    loads = std::erase(given, "--loads") > 0;
    if (!given.empty()) lcm_url = given[0];
    if (given.size() > 1) step = std::stod(given[1]);
    if (given.size() > 2) max_retries = std::stoll(given[2]);
    if (given.size() > 3) height = std::stod(given[3]);
  }
  Start start() const {
    return height ? Start{.position = {0.0, 0.0, *height}, .orientation = {1.0, 0.0, 0.0, 0.0}} : Start{};
  }

  bool loads = false;   // the scene has outputs = ["wrench", "loads"]
  std::string lcm_url;  // "": the default of LCM's own tools
  double step = 1e-3;   // [s]
  // One minute at 0.1 s each: a service that is started at the same time loads its scene meanwhile.
  std::int64_t max_retries = 600;
  std::optional<double> height;  // [m]
};

// The mass of a solid box, as the engines compute it.
inline buoyancy::RigidBodyMass mass() {
  const auto& [a, b, c] = kSize;
  buoyancy::RigidBodyMass box;
  box.mass = kMass;
  box.inertia_B = (kMass / 12.0 * buoyancy::Vec3(b * b + c * c, c * c + a * a, a * a + b * b)).asDiagonal();
  return box;
}

// Returns the sum of all loads, weight included, as the wrench that gives the mass of the crate alone the
// acceleration that it has together with its added mass. loads: nullptr where there are none.
inline buoyancy::Vec6 total_wrench(const buoyancy::BodyState& state, const buoyancy::BodyWrench& wrench,
                                   const buoyancy::BodyLoads* loads, double step) {
  // The scene sets no reference_point: the wrench and the matrices are about the mesh's origin.
  const buoyancy::CoupledBody body =
      coupled_body(mass(), buoyancy::Vec3::Zero(), state, loads == nullptr ? buoyancy::BodyLoads{} : *loads);
  buoyancy::Vec6 total = wrench_of(wrench) + weight_W(body, {0.0, 0.0, -kGravity});
  if (loads == nullptr) {
    total.head<3>() -= kLinearDamping * body.motion.velocity_W;
    total.tail<3>() -= kAngularDamping * body.motion.angular_velocity_W;
  }
  return compensated_wrench(body, total, step);
}

// Prints the final pose of the crate and the timing. tilt_cosine: z component of the crate's own z axis.
inline void report(const buoyancy::ClientStats& stats, double height, double tilt_cosine,
                   std::chrono::steady_clock::duration elapsed) {
  const double seconds = std::chrono::duration<double>(elapsed).count();
  std::printf("height %.6f m, tilt %.6f rad after %.3g s of simulated time\n", height,
              std::acos(std::fmin(tilt_cosine, 1.0)), kSimulatedTime);
  std::printf("%.0f steps/s, round trip p50 %.1f us, p99 %.1f us, %lld retries\n",
              static_cast<double>(stats.requests) / seconds, 1e6 * stats.round_trip.percentiles().p50,
              1e6 * stats.round_trip.percentiles().p99, static_cast<long long>(stats.retries));
}

// The complete simulation loop. World is an engine with a crate in it, whose gravity is off: state(),
// step_with(wrench about the centre of mass, step), height(), tilt_cosine(). Returns the exit code of main().
template <typename World>
int float_crate(World& world, const Arguments& arguments) {
  const double step_size = arguments.step;
  const std::int64_t steps = std::llround(kSimulatedTime / step_size);
  buoyancy::ClientOptions options;
  options.channel.lcm_url = arguments.lcm_url;
  options.channel.wait_for_loads = arguments.loads;
  options.retry_policy.max_retries = arguments.max_retries;
  buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open(options);
  if (!client) {
    std::fprintf(stderr, "%s\n", client.error().message().c_str());
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  HeavePeriod heave;
  for (std::int64_t step = 0; step < steps; ++step) {
    // Simulated time, computed from the step number: every run sends the same requests.
    const double time = step_size * static_cast<double>(step);
    const std::int64_t utime = std::llround(1e6 * time);
    // One request per step, for the pose and the velocities at the step's start: the engines then integrate
    // semi-implicitly, which keeps the energy bounded.
    const std::array states{world.state()};
    heave.add(time, states[0].linear_velocity[2]);
    const auto response = client->request(utime, states);
    if (!response) {
      std::fprintf(stderr, "%s\n", response.error().message().c_str());
      return 1;
    }
    if (const auto* failed = buoyancy::find_failed_body(**response)) {
      std::fprintf(stderr, "body %d has status %s\n", failed->body_id, to_string(failed->status));
      return 1;
    }
    const buoyancy::BodyLoads* const loads = find_loads(client->loads(), kBodyId);
    if (arguments.loads && loads == nullptr) {
      std::fprintf(stderr, "body %d has no loads: its scene needs outputs = [\"wrench\", \"loads\"]\n",
                   kBodyId);
      return 1;
    }
    world.step_with(total_wrench(states[0], (*response)->bodies[0], loads, step_size), step_size);
  }
  report(client->statistics(), world.height(), world.tilt_cosine(), std::chrono::steady_clock::now() - start);
  if (arguments.height && heave.mean()) std::printf("heave period %.6f s\n", *heave.mean());
  return 0;
}

}  // namespace crate
