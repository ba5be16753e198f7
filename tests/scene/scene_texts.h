// Scene texts for tests.
#pragma once

#include <string>

#include "scene/scene_file.h"

namespace buoyancy {

// Returns a scene of one body on lines 1 to 3, followed by `more` from line 4.
inline std::string scene_with_crate(const std::string& more = "") {
  return "[[body]]\nid = 7\nshape = { type = \"box\" }\n" + more;
}

// A small underwater vehicle that floats, with a current.
inline constexpr const char* kVehicleScene = R"(
[water.current]
velocity = [0.5, 0, 0]
[[body]]
id = 1
name = "ROV"
shape = { type = "box", size = [0.46, 0.34, 0.25] }
outputs = ["wrench", "loads"]
[body.drag]
linear = [4, 6.2, 5.2, 0.07, 0.07, 0.07]
quadratic = [18.2, 21.7, 37, 1.5, 1.5, 1.5]
center = [0, 0, 0.01]
[body.added_mass]
matrix = [5.5, 12.7, 60, 0.12, 0.12, 0.12]
immersion = "wetted_area"
[body.client]
density = 900
)";

inline Expected<SceneDescription> parse(const std::string& text) {
  return parse_scene(text, "pool.toml", "scenes");
}

// Returns the error message for the text, or "accepted".
inline std::string parse_error(const std::string& text) {
  const Expected<SceneDescription> scene = parse(text);
  return scene ? "accepted" : scene.error().message();
}

}  // namespace buoyancy
