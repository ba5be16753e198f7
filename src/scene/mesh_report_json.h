// The report of a mesh as JSON, for `buoyancyd --check --json` and buoyancy-mesh.
#pragma once

#include <nlohmann/json.hpp>

#include "geometry/mesh_report.h"

namespace buoyancy {

// The fields of MeshReport by name; `flipped` is "turned" and `max_move` "largest_move". "closing" is null
// unless the mesh is refused for its edges and could be closed; "advice" is closing_advice().
nlohmann::ordered_json mesh_report_json(const MeshReport& report);

}  // namespace buoyancy
