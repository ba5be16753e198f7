// Evaluates core types with a BodyEvaluator, which reads and writes messages in place.
#pragma once

#include <vector>

#include "engine/body_evaluator.h"
#include "messages/wire_views.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

// Replaces wrenches by one wrench per state of the request, in water at rest.
inline void evaluate_all(BodyEvaluator& evaluator, const WrenchRequest& request,
                         std::vector<BodyWrench>& wrenches, ServiceCounters& counters) {
  const ByteVector request_bytes = encoded(request);
  ByteVector response_bytes;
  const RequestView view = RequestView::of(request_bytes).value();
  ResponseWriter writer(view.id(), view.size(), response_bytes);
  evaluator.evaluate(view, {.first = 0, .count = view.size(), .listed = {}},
                     {&evaluator.scene().water(), nullptr},
                     {.response = writer, .loads = {}, .load_places = {}}, counters);
  wrenches = decoded<WrenchResponse>(response_bytes).bodies;
}

// Evaluates one body on its own, with a BodyEvaluator that has no cached results.
inline BodyWrench evaluate_alone(const Scene& scene, const BodyState& state, double lead_time,
                                 ServiceCounters& counters) {
  BodyEvaluator evaluator(scene, 1);
  std::vector<BodyWrench> wrenches;
  evaluate_all(evaluator, {.id = {}, .lead_time = lead_time, .bodies = {state}}, wrenches, counters);
  return wrenches.at(0);
}

}  // namespace buoyancy
