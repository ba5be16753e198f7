#include "engine/body_evaluator.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

// [ns]. Dispatching work to other threads costs about 10 us: parallel execution has to save several times
// that, and each dispatched task should take about as long.
constexpr double kMinParallelWork = 5e4;
constexpr double kMinTaskWork = 1e4;

// [ns], on the processors of docs/measurements.md. A factor of two either way makes no difference here.
double estimated_time(const Solver& solver) {
  const auto triangles = static_cast<double>(solver.mesh().surface.triangles.size());
  return solver.method() == Method::kHierarchical ? 300.0 + 50.0 * std::sqrt(triangles) : 4.0 * triangles;
}

}  // namespace

void BodyEvaluator::set_scene(const Scene& scene) {
  scene_ = &scene;
  cached_.assign(scene.bodies().size(), {});
  pending_.clear();
  estimated_time_.clear();
  fully_submerged_.clear();
  estimated_time_.reserve(scene.bodies().size());
  fully_submerged_.reserve(scene.bodies().size());
  for (const Body& body : scene.bodies()) {
    estimated_time_.push_back(estimated_time(body.solver));
    fully_submerged_.push_back(submerged_constants(body.solver.mesh(), scene.water(), body.reference_B));
  }
}

void BodyEvaluator::CachedResult::set_pose(const Pose& evaluated) {
  valid = outcome.status == BodyStatus::kOk;
  pose = pose_bits(evaluated);
}

void BodyEvaluator::evaluate_all(const WrenchRequest& request, std::vector<BodyWrench>& wrenches,
                                 ServiceCounters& counters) {
  const std::size_t bodies = request.bodies.size();
  pending_.clear();
  wrenches.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    const BodyState& state = request.bodies[i];
    if (const BodyOutcome* outcome = evaluate_or_defer(state, request.lead_time, i)) {
      wrenches[i] = to_wrench(state.body_id, *outcome);
      add_to_counters(*outcome, counters);
    }
  }
  compute_pending();
  // In the request's order, since a request may contain a body twice: the last outcome stays cached.
  for (const Pending& pending : pending_) {
    wrenches[pending.state] = to_wrench(request.bodies[pending.state].body_id, pending.outcome);
    add_to_counters(pending.outcome, counters);
    CachedResult& last = cached_[pending.body];
    last.outcome = pending.outcome;
    last.set_pose(pending.validated.pose);
  }
}

void BodyEvaluator::clear_cache() {
  for (CachedResult& last : cached_) last.valid = false;
}

std::optional<std::size_t> BodyEvaluator::find_body(std::int32_t id, std::size_t i) const {
  // Fast path: requests for a whole scene usually list the bodies in the scene's order.
  if (i < scene_->bodies().size() && scene_->bodies()[i].id == id) return i;
  return scene_->index_of(id);
}

const BodyOutcome* BodyEvaluator::evaluate_or_defer(const BodyState& state, double lead_time, std::size_t i) {
  const std::optional<std::size_t> index = find_body(state.body_id, i);
  if (!index) {
    rejected_ = {.status = BodyStatus::kUnknownBody, .result = {}};
    return &rejected_;
  }
  const ValidatedPose validated = validate_pose(state, lead_time);
  if (validated.status != BodyStatus::kOk) {
    rejected_ = {
        .status = validated.status, .quaternion_normalised = validated.quaternion_normalised, .result = {}};
    return &rejected_;
  }
  CachedResult& last = cached_[*index];
  if (last.valid && equal_branch_free(last.pose, pose_bits(validated.pose))) {
    last.outcome.unchanged = true;
    return &last.outcome;
  }
  if (try_evaluate_from_bounds(scene_->bodies()[*index], fully_submerged_[*index], scene_->water(), validated,
                               last.outcome)) {
    last.set_pose(validated.pose);
    return &last.outcome;
  }
  pending_.push_back({.state = i, .body = *index, .validated = validated, .outcome = {}});
  return nullptr;
}

void BodyEvaluator::compute_pending() {
  double work = 0.0;
  for (const Pending& pending : pending_) work += estimated_time_[pending.body];
  const auto compute = [this](std::size_t n) {
    Pending& pending = pending_[n];
    evaluate(scene_->bodies()[pending.body], scene_->water(), pending.validated, pending.outcome);
  };
  if (pending_.size() > 1 && work > kMinParallelWork && thread_pool_.thread_count() > 1) {
    const double each = work / static_cast<double>(pending_.size());
    thread_pool_.run(pending_.size(), static_cast<std::size_t>(std::max(1.0, kMinTaskWork / each)), compute);
  } else {
    for (std::size_t n = 0; n < pending_.size(); ++n) compute(n);
  }
}

}  // namespace buoyancy
