// What a page needs to know of a scene, once: what --check reports of it (scene_report.h) and shapes to draw.
#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "scene/scene.h"

namespace buoyancy {

struct SceneModelOptions {
  std::size_t max_triangles =
      60'000;  // of all meshes together; shared among those that have more than their part
};

// The object of scene_report_json() with paths cut down to the files' names, and more in it:
//   of a body   "center_of_mass": [3], m, B, or null where nobody said it
//   of a mesh   "center": [3], m, B; "positions": float32, three a vertex, m, about the centre; "indices":
//   uint32,
//               three a triangle, counter-clockwise seen from outside; both base64 of little-endian numbers;
//               "shown_triangles": how many these are
// A mesh with more triangles than its part is reduced for the picture alone (meshoptimizer).
nlohmann::ordered_json scene_model(const Scene& scene, const SceneModelOptions& options = {});

}  // namespace buoyancy
