// Scene texts for tests.
#pragma once

#include <string>

#include "scene/scene_file.h"

namespace buoyancy {

// Returns a scene of one body on lines 1 to 3, followed by `more` from line 4.
inline std::string scene_with_crate(const std::string& more = "") {
  return "[[body]]\nid = 7\nshape = { type = \"box\" }\n" + more;
}

inline Expected<SceneDescription> parse(const std::string& text) {
  return parse_scene(text, "pool.toml", "scenes");
}

// Returns the error message for the text, or "accepted".
inline std::string parse_error(const std::string& text) {
  const Expected<SceneDescription> scene = parse(text);
  return scene ? "accepted" : scene.error().message();
}

}  // namespace buoyancy
