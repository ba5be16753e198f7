// Requests of the network benchmarks: a client, the states of a scene's bodies at each step, and the check
// that the service's response is the right one.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "client/client.h"
#include "engine/request_handler.h"
#include "fail.h"
#include "service_process.h"

namespace buoyancy::bench {

using States = std::vector<BodyState>;

// A box of 1,200 triangles.
inline const std::string kCrate = R"(shape = { type = "box", size = [1, 1, 1], segments = [10, 10, 10] })";

inline double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

inline Client client_at(int port, const RetryPolicy& retry_policy = {}) {
  ClientOptions options;
  options.channel.lcm_url = url_of_port(port);
  options.retry_policy = retry_policy;
  return value_or_exit(Client::open(options));
}

// The body turns and heaves about the water surface, which it always crosses; no two steps are equal, so that
// no result is cached. sink [m] is subtracted from its height.
inline BodyState state_at(const Body& body, std::size_t step, double sink = 0.0) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double angle = 0.1 * body.id + 1e-3 * static_cast<double>(step);
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, Vec3(0.6, 0.8, std::sin(angle)).normalized()));
  Vec3 position = Vec3(5.0 * body.id, 0.0, 0.1 * mesh.box_max.minCoeff() * std::sin(7.0 * angle) - sink);
  position -= q * mesh.center_B;
  return {.body_id = body.id,
          .position = {position.x(), position.y(), position.z()},
          .quaternion_wxyz = {q.w(), q.x(), q.y(), q.z()},
          .linear_velocity = {},
          .angular_velocity = {}};
}

inline WrenchResponse send_request(Client& client, std::size_t step, const States& states) {
  return *value_or_exit(client.request(static_cast<std::int64_t>(step), states));
}

// The response must equal that of a handler in this process bit for bit.
inline void check_equals_handler(const WrenchResponse& response, const States& states, const Scene& scene) {
  std::vector<std::uint8_t> request;
  encode(WrenchRequest{.id = response.id, .lead_time = 0.0, .bodies = states}, request);
  RequestHandler handler(scene, {.threads = 1});
  const Bytes expected = handler.handle(request);
  std::vector<std::uint8_t> actual;
  encode(response, actual);
  if (!std::ranges::equal(actual, expected)) fail("the service's response differs from the handler's");
}

inline double weight_of_displacement(const Body& body, const Water& water) {
  return water.density * water.gravity * body.prepared_mesh->mass_properties.volume;
}

inline void check_submerged_force(const Body& body, const Water& water, const BodyWrench& wrench) {
  constexpr double kRelative = 1e-12;
  const double whole = weight_of_displacement(body, water);
  if (std::abs(wrench.force[2] - whole) > kRelative * whole) fail("a wrong force under water");
}

inline void check_piercing_force(const Body& body, const Water& water, const BodyWrench& wrench) {
  const double force = wrench.force[2];
  if (force <= 0.0 || force >= weight_of_displacement(body, water)) fail("a body does not cross the surface");
}

}  // namespace buoyancy::bench
