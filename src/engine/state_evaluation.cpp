#include "engine/state_evaluation.h"

#include "engine/load_evaluation.h"

namespace buoyancy {

StateEvaluation evaluate_state(const Body& body, const WaterState& water, const Current& current,
                               const BodyState& state, double lead_time, const BodyCondition* condition) {
  const ValidatedPose pose = validate_pose(state, lead_time);
  BodyOutcome outcome;
  outcome.status = pose.status;
  if (outcome.status == BodyStatus::kOk) {
    outcome.status = check_state(state, lead_time, water, body.hydrodynamics != nullptr,
                                 body.subdivision == nullptr || condition != nullptr);
  }
  if (outcome.status == BodyStatus::kOk) {
    const FullySubmerged submerged =
        submerged_constants(body.solver.mesh(), *water.at_rest, body.reference_B);
    if (!try_evaluate_from_bounds(body, submerged, water, pose, outcome)) {
      evaluate(body, water, pose, outcome, condition);
    }
  }
  StateEvaluation evaluation{.wrench = to_wrench(body.id, outcome), .loads = std::nullopt};
  const bool has_loads = body.loads || body.hydrodynamics != nullptr;
  if (!has_loads || outcome.status != BodyStatus::kOk) return evaluation;
  add_loads(body, water, current, pose.pose, twist_of(state), outcome, evaluation.wrench,
            &evaluation.loads.emplace());
  if (evaluation.wrench.status != BodyStatus::kOk) evaluation.loads.reset();
  return evaluation;
}

}  // namespace buoyancy
