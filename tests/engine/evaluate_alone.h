// Evaluates one body on its own, with a BodyEvaluator that has no cached results.
#pragma once

#include <vector>

#include "engine/body_evaluator.h"

namespace buoyancy {

inline BodyWrench evaluate_alone(const Scene& scene, const BodyState& state, double lead_time,
                                 ServiceCounters& counters) {
  BodyEvaluator evaluator(scene, 1);
  std::vector<BodyWrench> wrenches;
  evaluator.evaluate_all({.id = {}, .lead_time = lead_time, .bodies = {state}}, wrenches, counters);
  return wrenches.at(0);
}

}  // namespace buoyancy
