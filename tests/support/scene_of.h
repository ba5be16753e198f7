// Prepares scenes for tests from text.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scene/scene.h"
#include "scene/scene_file.h"

namespace buoyancy {

// Returns the prepared scene of a scene file's text. directory: resolves relative mesh paths. Throws
// std::runtime_error with the error's message if the text or a mesh is invalid.
inline Scene scene_of(std::string_view text, const std::filesystem::path& directory = {}) {
  const Expected<SceneDescription> description = parse_scene(text, "test scene", directory);
  if (!description) throw std::runtime_error(description.error().message());
  Expected<Scene> scene = Scene::prepare(*description);
  if (!scene) throw std::runtime_error(scene.error().message());
  return *std::move(scene);
}

}  // namespace buoyancy
