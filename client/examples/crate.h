// The crate of both examples, the box of scenes/box.toml, and the code that does not depend on the engine.
// The service knows the mesh and the water; the simulator knows mass, gravity and damping.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "client/client.h"

namespace crate {

inline constexpr std::int32_t kBodyId = 1;                    // as in the scene
inline constexpr std::array<double, 3> kSize{1.0, 1.0, 0.5};  // [m]
inline constexpr double kMass = 256.25;                       // [kg], half the mass of water it can displace
inline constexpr double kGravity = 9.80665;                   // [m/s^2]
inline constexpr double kLinearDamping = 500.0;               // [N/(m/s)]
inline constexpr double kAngularDamping = 40.0;               // [N m/(rad/s)]
inline constexpr std::array<double, 3> kInitialPosition{0.0, 0.0, 0.75};           // [m]
inline constexpr std::array<double, 4> kInitialOrientation{0.98, 0.15, 0.1, 0.0};  // wxyz, not normalised
inline constexpr double kSimulatedTime = 20.0;                                     // [s]

// Command line: [LCM URL [STEP [RETRIES]]].
struct Arguments {
  Arguments(int argc, char** argv) {
    if (argc > 1) lcm_url = argv[1];
    if (argc > 2) step = std::stod(argv[2]);
    if (argc > 3) max_retries = std::stoll(argv[3]);
  }
  std::string lcm_url;  // "": the default of LCM's own tools
  double step = 1e-3;   // [s]
  // One minute at 0.1 s each: a service that is started at the same time loads its scene meanwhile.
  std::int64_t max_retries = 600;
};

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

// The complete simulation loop. World is an engine with a crate in it: state(), step_with(wrench, step),
// height(), tilt_cosine(). Returns the exit code of main().
template <typename World>
int float_crate(World& world, const Arguments& arguments) {
  const double step_size = arguments.step;
  const std::int64_t steps = std::llround(kSimulatedTime / step_size);
  buoyancy::ClientOptions options;
  options.channel.lcm_url = arguments.lcm_url;
  options.retry_policy.max_retries = arguments.max_retries;
  buoyancy::Expected<buoyancy::Client> client = buoyancy::Client::open(options);
  if (!client) {
    std::fprintf(stderr, "%s\n", client.error().message().c_str());
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  for (std::int64_t step = 0; step < steps; ++step) {
    // Simulated time, computed from the step number: every run sends the same requests.
    const std::int64_t utime = std::llround(1e6 * step_size * static_cast<double>(step));
    // One request per step, for the pose at the step's start: the engines then integrate semi-implicitly,
    // which keeps the energy bounded.
    const std::array states{world.state()};
    const auto response = client->request(utime, states);
    if (!response) {
      std::fprintf(stderr, "%s\n", response.error().message().c_str());
      return 1;
    }
    if (const auto* failed = buoyancy::find_failed_body(**response)) {
      std::fprintf(stderr, "body %d has status %s\n", failed->body_id, to_string(failed->status));
      return 1;
    }
    world.step_with((*response)->bodies[0], step_size);
  }
  report(client->statistics(), world.height(), world.tilt_cosine(), std::chrono::steady_clock::now() - start);
  return 0;
}

}  // namespace crate
