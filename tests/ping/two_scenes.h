// Replies of this program for one scene to requests about another, without a network.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/ping/ping_poses.h"
#include "client/ping/response_checks.h"
#include "engine/request_handler.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy::ping {

// What a service with this scene responds.
inline ExpectedReply reply_of(RequestHandler& handler, const RequestId& id,
                              const std::vector<BodyState>& states) {
  return {.wrenches = copy_of(handler.handle(encoded(BorrowedRequest(id, 0.0, states)))),
          .hydrostatics = copy_of(handler.last_hydrostatics()),
          .loads = copy_of(handler.last_loads())};
}

inline Reply received(const ExpectedReply& reply) {
  return {.wrenches = reply.wrenches,
          .hydrostatics = reply.hydrostatics,
          .loads = reply.loads,
          .wrenches_at = {}};
}

inline RequestId request_id(std::int64_t seq) {
  return {.utime = 100'000 * seq, .session_id = 5, .seq = seq};
}

// Compares the replies of a service with its own scene to `count` requests about the bodies of `here`.
inline ResponseChecks compare_scenes(const Scene& here, const Scene& of_service, std::int64_t count = 40) {
  RequestHandler handler(here, {.threads = 1});
  RequestHandler service(of_service, {.threads = 1});
  ResponseChecks checks(here);
  const double max_elevation = here.sea() == nullptr ? 0.0 : here.sea()->max_elevation();
  std::vector<BodyState> states;
  for (std::int64_t seq = 0; seq < count; ++seq) {
    make_states(here, {here.water().level, max_elevation}, 1, seq, states);
    const RequestId id = request_id(seq);
    checks.add(id, states, reply_of(handler, id, states), received(reply_of(service, id, states)));
  }
  return checks;
}

// A scene file's text with one box and one ball, of which tests change a part.
struct SceneText {
  std::string gravity = "9.80665", up = "[0, 0, 1]", level = "0", density = "1025", water;
  std::string shape = R"(type = "box", size = [1, 1, 0.5], segments = [4, 4, 4])";
  std::string reference = "[0.1, 0.2, 0]", outputs = R"(["wrench"])", method = "hierarchical",
              tolerance = "0";
  std::string id = "1", body;

  std::string text() const {
    return "[world]\ngravity = " + gravity + "\nup = " + up + "\n[water]\nlevel = " + level +
           "\ndensity = " + density + "\n" + water + "\n[[body]]\nid = " + id + "\nshape = { " + shape +
           " }\nreference_point = " + reference + "\noutputs = " + outputs + "\nmethod = \"" + method +
           "\"\ntolerance = " + tolerance + "\n" + body +
           "\n[[body]]\nid = 7\nshape = { type = \"sphere\", radius = 0.5, segments = 12 }\n";
  }
  Scene scene() const { return scene_of(text()); }
};

inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

inline const std::string kWaves =
    R"(waves = [{ type = "regular", height = 0.4, period = 5.0, direction = 0.0 }])";
inline const std::string kDrag = "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\n";
inline const std::string kWithLoads = R"(["wrench", "loads"])";
inline const std::string kWithHydrostatics = R"(["wrench", "hydrostatics"])";

}  // namespace buoyancy::ping
