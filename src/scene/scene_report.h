// What `buoyancyd --check` prints: the water, the bodies and the report of every mesh, for people and for
// programs.
#pragma once

#include <string>

#include "scene/scene.h"

namespace buoyancy {

std::string scene_report_text(const Scene& scene);  // lines for a terminal, with a final newline
std::string scene_report_json(const Scene& scene);  // one JSON object; numbers not finite are null

}  // namespace buoyancy
