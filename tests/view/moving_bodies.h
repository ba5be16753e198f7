// A scene of bodies with loads for tests of pages, and their states.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "messages/request.h"
#include "tests/service/one_box_scene.h"

namespace buoyancy::view {

// kOneBoxScene's water with a current. Body 1 publishes its loads, about a corner, and has a mass; body 2 has
// drag alone and does not publish it; body 3 publishes its loads and has neither drag nor added mass; body 4
// has no loads.
inline std::string moving_bodies(const std::string& waves = {}) {
  const std::string box = "shape = { type = \"box\", size = [1, 1, 2], segments = [2, 2, 2] }\n";
  return kTestWater + waves + "[water.current]\nvelocity = [0.5, -0.25, 0.125]\n[[body]]\nid = 1\n" + box +
         R"(reference_point = [0.5, 0.5, -0.5]
outputs = ["wrench", "loads"]
[body.drag]
linear = [200, 300, 400, 50, 60, 70]
quadratic = [500, 600, 700, 80, 90, 100]
center = [0.1, 0.0, -0.2]
[body.added_mass]
matrix = [400, 500, 600, 70, 80, 90]
[body.client]
mass = 1200
center_of_mass = [0.0, 0.1, -0.3]
position = [0, 0, 0.5]
linear_velocity = [0.0, 0.0, -1.0]
angular_velocity = [0.3, 0.2, 0.1]
[[body]]
id = 2
)" + box +
         "[body.drag]\nlinear = [20, 30, 40, 5, 6, 7]\n[[body]]\nid = 3\n" + box +
         "outputs = [\"wrench\", \"loads\"]\n[[body]]\nid = 4\n" + box;
}

// A body near the surface, in any attitude, that moves.
inline BodyState random_motion(std::int32_t id, std::mt19937_64& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  BodyState state{.body_id = id, .position = {number(random), number(random), 2.0 * number(random)}};
  double norm = 0.0;
  for (double& component : state.quaternion_wxyz) norm = std::hypot(norm, component = number(random));
  for (double& component : state.quaternion_wxyz) component /= norm;
  for (auto* velocity : {&state.linear_velocity, &state.angular_velocity}) {
    for (double& component : *velocity) component = number(random);
  }
  return state;
}

}  // namespace buoyancy::view
