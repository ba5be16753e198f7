// Scene texts for tests, and what is said about them.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene.h"
#include "scene/scene_file.h"

namespace buoyancy {

// Returns a scene of one body on lines 1 to 3, followed by `more` from line 4.
inline std::string scene_with_crate(const std::string& more = "") {
  return "[[body]]\nid = 7\nshape = { type = \"box\" }\n" + more;
}

// A tetrahedron without its sloping face, as a file.
inline constexpr const char* kOpenObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

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

// Of texts that are known to be valid.
inline SceneDescription parsed(const std::string& text) {
  Expected<SceneDescription> scene = parse(text);
  if (!scene) throw std::runtime_error(scene.error().message());
  return *std::move(scene);
}
inline Scene prepared(const std::string& text) {
  return *Scene::prepare(parsed(text));
}

// Returns the error message for the text, or "accepted".
inline std::string parse_error(const std::string& text) {
  const Expected<SceneDescription> scene = parse(text);
  return scene ? "accepted" : scene.error().message();
}

// The same of reading the text and preparing the scene. directory: of its files.
inline std::string preparation_error(const std::string& text, const std::filesystem::path& directory = {}) {
  const Expected<SceneDescription> description = parse_scene(text, "pool.toml", directory);
  if (!description) return description.error().message();
  const Expected<Scene> scene = Scene::prepare(*description);
  return scene ? "accepted" : scene.error().message();
}

// Texts, each with a part of the error that parse_error() must return for it.
inline void expect_parse_errors(const std::vector<std::pair<std::string, std::string>>& wrong) {
  for (const auto& [text, expected] : wrong) {
    EXPECT_THAT(parse_error(text), testing::HasSubstr(expected)) << text;
  }
}

inline std::vector<std::string> messages_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> messages;
  for (const Warning& warning : warnings) messages.push_back(warning.message());
  return messages;
}

}  // namespace buoyancy
