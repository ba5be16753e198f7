// A scene with a hull that has a part, two compartments and two tanks, and a box that has none.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "messages/condition_change.h"
#include "messages/request.h"
#include "tests/service/one_box_scene.h"
#include "tests/support/recorded_log.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::view {

// A square ring: 2 x 2 x 1 m, with a hole of 1 x 1 m from top to bottom.
inline const std::string kRing = R"(
v -1 -1 -0.5
v 1 -1 -0.5
v 1 1 -0.5
v -1 1 -0.5
v -0.5 -0.5 -0.5
v 0.5 -0.5 -0.5
v 0.5 0.5 -0.5
v -0.5 0.5 -0.5
v -1 -1 0.5
v 1 -1 0.5
v 1 1 0.5
v -1 1 0.5
v -0.5 -0.5 0.5
v 0.5 -0.5 0.5
v 0.5 0.5 0.5
v -0.5 0.5 0.5
f 1 2 10 9
f 2 3 11 10
f 3 4 12 11
f 4 1 9 12
f 6 5 13 14
f 7 6 14 15
f 8 7 15 16
f 5 8 16 13
f 2 1 5 6
f 3 2 6 7
f 4 3 7 8
f 1 4 8 5
f 9 10 14 13
f 10 11 15 14
f 11 12 16 15
f 12 9 13 16
)";

// The hull is 4 x 3 x 4 m, its wide tank 3 x 2 x 2 m and half full. second: the mesh or shape of the second
// tank, of 3 m^3.
inline std::string subdivided_hull(
    const std::string& second = "shape = { type = \"box\", size = [2, 1.5, 1] }") {
  return kTestWater + R"([[body]]
id = 1
name = "hull"
shape = { type = "box", size = [4, 3, 4] }
outputs = ["wrench", "hydrostatics"]
[[body.part]]
shape = { type = "box", size = [1, 1, 1] }
position = [0, 0, 2.5]
[[body.compartment]]
name = "engine room"
shape = { type = "box", size = [1, 2, 1] }
position = [-1, 0, -1.4]
permeability = 0.85
flooded = 0.25
[[body.compartment]]
name = "hold"
shape = { type = "box", size = [1, 2, 1] }
position = [1, 0, -1.4]
flooded = 0
[[body.tank]]
name = "wide"
shape = { type = "box", size = [3, 2, 2] }
position = [0, 0, 0.9]
fill = 0.5
[[body.tank]]
name = "ring"
)" + second +
         R"(
position = [0.5, -0.25, 0.25]
liquid_volume = 1.25
density = 850
[body.client]
mass = 12000
center_of_mass = [0, 0, -1]
[[body]]
id = 2
name = "box"
shape = { type = "box", size = [1, 1, 1] }
)";
}

// Writes this scene with a ring as its second tank, and returns its path.
inline std::string write_subdivided_hull(const TempDir& directory) {
  directory.write("ring.obj", kRing);
  return directory.write("hull.toml", subdivided_hull("mesh = \"ring.obj\""));
}

// A log as lcm-logger records it, of requests about body 1 at rest, without responses.
class ConditionLog {
 public:
  void add(std::string_view channel, Bytes bytes) { log_.add(log_.events(), channel, bytes); }
  void add_request(std::int64_t utime, double height) {
    WrenchRequest request;
    request.id = {.utime = utime, .session_id = 1, .seq = ++requests_};
    request.bodies.push_back(
        {.body_id = 1, .position = {0.0, 0.0, height}, .quaternion_wxyz = {1.0, 0.0, 0.0, 0.0}});
    add(kStatesChannel, encoded(request));
  }
  void add_condition(const ConditionChange& change) { add(kConditionChannel, encoded(change)); }

  const std::string& text() const { return log_.text(); }

 private:
  RecordedLog log_;
  std::int64_t requests_ = 0;
};

// Seconds 0 to 3: the condition of the scene; the wide tank full; the engine room open altogether, too; and a
// tank that cannot hold what it is said to.
inline std::string log_of_conditions() {
  ConditionLog log;
  log.add_request(0, 1.0);
  log.add_condition(
      {.utime = 500'000, .body_id = 1, .kind = ConditionKind::kTank, .index = 0, .liquid_volume = 12.0});
  log.add_request(1'000'000, 1.0);
  log.add_condition(
      {.utime = 1'500'000, .body_id = 1, .kind = ConditionKind::kCompartment, .index = 0, .flooded = 1.0});
  log.add_request(2'000'000, 1.0);
  log.add_condition(
      {.utime = 2'500'000, .body_id = 1, .kind = ConditionKind::kTank, .index = 1, .liquid_volume = 99.0});
  log.add_request(3'000'000, 1.0);
  return log.text();
}

}  // namespace buoyancy::view
