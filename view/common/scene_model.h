// Describes a scene to a page: the report of buoyancyd --check (scene_report.h) and the shapes to draw.
#pragma once

#include <cstddef>

#include "base/json.h"
#include "scene/scene.h"
#include "view/page/mesh_drawing.h"

namespace buoyancy::view {

// Does a page show the parts of the wrench on the body? True with drag, added mass or the output "loads".
bool has_loads(const Body& body);

struct SceneModelOptions {
  // The limit for all meshes together. Meshes that exceed their equal share are reduced to it.
  std::size_t max_triangles = kMaxDrawnTriangles;
};

// The object of scene_report_json() with paths reduced to file names, "sea" as in sea_json.h and absent if
// the water is at rest, and additionally
//   of each body   "center_of_mass": [3] [m], B, or null if the scene does not specify it
//   of each mesh   "center": [3] [m], B
//                  "positions": float32, three per vertex [m], relative to center
//                  "indices": uint32, three per triangle, counter-clockwise seen from outside
//                  "shown_triangles": the number of triangles in indices
// and only if a body has_loads()
//   "loads"        "e1", "e2": [3], W: the horizontal axes, as in sea_json.h
//                  "current": [3] [m/s], W
//                  "waves": whether there can be any
//   of such a body "loads": {"drag_center": [3] [m], B, or null without drag
//                            "added_mass": whether it has any
//                            "published": whether its outputs include "loads"}
// The meshes of the parts of a body are left out, as are its "parts" and the "sections" of meshes: a page
// draws the mesh that joins them. "mesh" of bodies, compartments and tanks is an index into the remaining
// meshes.
//
// positions and indices are base64 of little-endian numbers. A mesh with more triangles than its share of
// max_triangles is reduced for drawing only (meshoptimizer).
Json scene_model(const Scene& scene, const SceneModelOptions& options = {});

}  // namespace buoyancy::view
