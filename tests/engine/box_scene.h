// A scene of unit boxes for tests of the request handling, and requests about its bodies.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "messages/wire.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {

inline constexpr double kWeight = 1000.0 * 10.0;     // [N/m^3], density times gravity of box_scene()
inline constexpr std::int32_t kBox = 1;              // unit box about B's origin
inline constexpr std::int32_t kOffsetBox = 2;        // same, torque about a corner
inline constexpr std::int32_t kFastBox = -3;         // same, with an approximate method
inline constexpr std::int32_t kHierarchicalBox = 5;  // same, with the default method
inline constexpr std::int32_t kHydrostaticBox = 6;   // like kOffsetBox, but fast; with hydrostatics
inline constexpr std::int32_t kNoBody = 4;           // no body of box_scene() has this id

inline Scene box_scene() {
  return scene_of(R"(
    [world]
    gravity = 10.0
    [water]
    density = 1000.0
    [[body]]
    id = 1
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    method = "exact"
    [[body]]
    id = 2
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    method = "exact"
    reference_point = [0.5, 0.5, -0.5]
    [[body]]
    id = -3
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    method = "fast"
    [[body]]
    id = 5
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    [[body]]
    id = 6
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    method = "fast"
    reference_point = [0.5, 0.5, -0.5]
    outputs = ["wrench", "hydrostatics"]
    [body.client]
    density = 500
  )");
}

// The same box_scene() at every call, for tests that need no scene of their own.
inline const Scene& shared_box_scene() {
  static const Scene scene = box_scene();
  return scene;
}

// An upright body at rest, its centre at this height over the water [m].
inline BodyState upright(std::int32_t id, double height) {
  BodyState state;
  state.body_id = id;
  state.position = {3.0, -2.0, height};
  state.quaternion_wxyz = {1.0, 0.0, 0.0, 0.0};
  return state;
}

inline ByteVector request_bytes(const RequestId& id, std::vector<BodyState> bodies, double lead_time = 0.0) {
  return encoded(WrenchRequest{.id = id, .lead_time = lead_time, .bodies = std::move(bodies)});
}

}  // namespace buoyancy
