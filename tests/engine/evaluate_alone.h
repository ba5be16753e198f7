// One body's answer, asked by itself of an exchange that remembers nothing.
#pragma once

#include <vector>

#include "engine/body_evaluator.h"

namespace buoyancy {

inline BodyWrench answer_alone(const Scene& scene, const BodyState& state, double lead_time,
                               Counters& counters) {
  BodyAnswers answers(scene, 1);
  std::vector<BodyWrench> wrenches;
  answers.answer({.key = {}, .lead_time = lead_time, .bodies = {state}}, wrenches, counters);
  return wrenches.at(0);
}

}  // namespace buoyancy
