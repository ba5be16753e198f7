// Scenes as texts, for tests.
#pragma once

#include <string>

#include "scene/scene_file.h"

namespace buoyancy {

// One body, on lines 1 to 3; what is added begins on line 4.
inline std::string crate_and(const std::string& more = "") {
  return "[[body]]\nid = 7\nshape = { type = \"box\" }\n" + more;
}

inline Expected<SceneDescription> parsed(const std::string& text) {
  return parse_scene(text, "pool.toml", "scenes");
}

// What a person is told about the text.
inline std::string refusal_of(const std::string& text) {
  const Expected<SceneDescription> scene = parsed(text);
  return scene ? "accepted" : scene.error().message();
}

}  // namespace buoyancy
