// Computes the buoyancy of a half-submerged cube with the installed libraries, through the solver and through
// the request handler, whose request is encoded by the installed message types. It also opens a client with
// an invalid URL. Exits with 0 if both results are correct and the client returns an error.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <buoyancy/client/client.h>
#include <buoyancy/engine/request_handler.h>
#include <buoyancy/hydrostatics/buoyancy.h>
#include <buoyancy/scene/scene.h>

namespace {

constexpr const char* kScene = R"(
[water]
density = 1000.0
[[body]]
id = 7
method = "exact"
shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
)";

constexpr double kExpected = 1000.0 * buoyancy::kStandardGravity * 0.5;  // N

bool is_correct(const char* path, double force) {
  std::printf("%s: %.17g N, expected %.17g N\n", path, force, kExpected);
  return std::abs(force - kExpected) <= 1e-12 * kExpected;
}

}  // namespace

int main() {
  const auto description = buoyancy::parse_scene(kScene, "consumer", ".");
  if (!description) return std::fprintf(stderr, "%s\n", description.error().message().c_str()), 1;
  const auto scene = buoyancy::Scene::prepare(*description);
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message().c_str()), 1;

  const buoyancy::Body* body = scene->find(7);
  if (body == nullptr) return 1;
  const auto direct = buoyancy::buoyancy(body->solver, buoyancy::Pose{}, scene->water(), body->reference_B);

  buoyancy::body_states_t states{};
  states.session_id = 1;
  states.num_bodies = 1;
  states.bodies.resize(1);
  states.bodies[0] = {};
  states.bodies[0].body_id = 7;
  states.bodies[0].quaternion_wxyz[0] = 1.0;
  std::vector<std::uint8_t> request(static_cast<std::size_t>(states.getEncodedSize()));
  states.encode(request.data(), 0, static_cast<int>(request.size()));

  buoyancy::RequestHandler handler(*scene);
  const buoyancy::Bytes response = handler.handle(request);
  buoyancy::body_wrenches_t wrenches{};
  if (wrenches.decode(response.data(), 0, static_cast<int>(response.size())) < 0) return 1;
  if (wrenches.num_bodies != 1) return 1;

  const bool both =
      is_correct("solver", direct.force_W.z()) & is_correct("handler", wrenches.bodies[0].force[2]);

  buoyancy::ClientOptions invalid;
  invalid.channel.lcm_url = "nowhere://";
  const auto client = buoyancy::Client::open(invalid);
  if (client) return 1;
  std::printf("client: %s\n", client.error().message().c_str());
  return both ? 0 : 1;
}
