// What `buoyancyd --check` prints: the water, the bodies and the report of every mesh, for people and for
// programs.
#pragma once

#include <string>

#include "scene/scene.h"

namespace buoyancy {

std::string scene_report_text(const Scene& scene);  // lines for a terminal, with a final newline

// One JSON object, with a final newline: "scene", "water", "bodies" (in the file's order; "mesh" is a place
// in "meshes"; mass and density as the simulator will use them, null where an open mesh leaves them unknown)
// and "meshes" (the fields of MeshReport by their names, and "bodies": the ids that use it). Numbers that are
// not finite are null.
std::string scene_report_json(const Scene& scene);

}  // namespace buoyancy
