// Evaluates the state of one body by itself, for callers that have neither requests nor arrays of poses. The
// results have the bits of the service's responses.
#pragma once

#include <optional>

#include "engine/body_evaluation.h"
#include "messages/loads.h"

namespace buoyancy {

struct StateEvaluation {
  BodyWrench wrench;
  // Of a body with drag, added mass or the loads output whose status is kOk.
  std::optional<BodyLoads> loads;
};

// lead_time: [s], of the state and of the water. condition: of the body's compartments and tanks; nullptr: it
// has none, or their condition is unknown. No heap allocation, except as stated for evaluate().
StateEvaluation evaluate_state(const Body& body, const WaterState& water, const Current& current,
                               const BodyState& state, double lead_time, const BodyCondition* condition);

}  // namespace buoyancy
