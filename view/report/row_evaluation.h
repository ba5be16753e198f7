// Evaluates the rows of a run with the engine's functions, as the service does for its requests.
#pragma once

#include <optional>
#include <vector>

#include "engine/body_evaluation.h"
#include "messages/loads.h"
#include "scene/scene.h"
#include "view/report/decimated_rows.h"
#include "view/report/run.h"

namespace buoyancy::view {

struct RowEvaluation {
  BodyWrench wrench;
  std::optional<BodyLoads> loads;  // of a body with loads (view/common/scene_model.h) whose status is kOk
};

// lead_time: [s], of the state and of the water. condition: of the body's compartments and tanks; nullptr: it
// has none, or their condition is unknown.
RowEvaluation evaluate_row(const Body& body, const WaterState& water, const Current& current,
                           const BodyState& state, double lead_time, const BodyCondition* condition);

// Fills in the loads of the rows of a body that has loads: the recorded ones, and others, computed in the
// water at their time. O(rows * cost of a query).
void add_loads(const Scene& scene, const Body& body, const std::vector<KeptRow>& rows, BodyRun& run);

// Fills in the conditions of the rows of a body that has compartments or tanks. O(rows log(rows)).
void add_conditions(const Subdivision& subdivision, const std::vector<KeptRow>& rows, BodyRun& run);

}  // namespace buoyancy::view
