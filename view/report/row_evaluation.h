// Evaluates the rows of a run with the engine's functions, as the service does for its requests.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "view/report/decimated_rows.h"
#include "view/report/run.h"

namespace buoyancy::view {

// Fills in the loads of the rows of a body that has loads: the recorded ones, and others, computed in the
// water at their time. O(rows * cost of a query).
void add_loads(const Scene& scene, const Body& body, const std::vector<KeptRow>& rows, BodyRun& run);

// Fills in the conditions of the rows of a body that has compartments or tanks. O(rows log(rows)).
void add_conditions(const Subdivision& subdivision, const std::vector<KeptRow>& rows, BodyRun& run);

}  // namespace buoyancy::view
