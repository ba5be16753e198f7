// The report of `buoyancyd --check`: the water, the bodies and the report of each mesh, as text and as JSON.
#pragma once

#include <string>

#include "scene/scene.h"

namespace buoyancy {

// Returns lines for a terminal, with a final newline.
std::string scene_report_text(const Scene& scene);

// Returns one JSON object, with a final newline: "scene", "water", "bodies" (in the order of the file; "mesh"
// is an index into "meshes"; mass and density are those that the simulator uses, null if an open mesh leaves
// them unknown) and "meshes" (the fields of MeshReport by name, and "bodies": the ids of its bodies).
// Non-finite numbers are null.
std::string scene_report_json(const Scene& scene);

}  // namespace buoyancy
