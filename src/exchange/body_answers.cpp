#include "exchange/body_answers.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

// ns. Handing work to other threads costs some 10 us: it has to be a good deal more than that, and what is
// handed over at once some 10 us too.
constexpr double kWorthSharing = 5e4;
constexpr double kShare = 1e4;

// ns, on the processors of docs/measurements.md; twice or half as much changes nothing that matters here.
double expected_time(const Solver& solver) {
  const auto triangles = static_cast<double>(solver.mesh().surface.triangles.size());
  return solver.method() == Method::kHierarchical ? 300.0 + 50.0 * std::sqrt(triangles) : 4.0 * triangles;
}

}  // namespace

BodyAnswers::BodyAnswers(const Scene& scene, unsigned threads)
    : scene_(&scene), workers_(threads), remembered_(scene.bodies().size()) {
  expected_time_.reserve(scene.bodies().size());
  for (const Body& body : scene.bodies()) expected_time_.push_back(expected_time(body.solver));
}

void BodyAnswers::answer(const Question& question, std::vector<BodyWrench>& wrenches, Counters& counters) {
  const std::size_t bodies = question.bodies.size();
  if (outcomes_.size() < bodies) outcomes_.resize(bodies);
  pending_.clear();
  for (std::size_t i = 0; i < bodies; ++i) answer_or_postpone(question.bodies[i], question.lead_time, i);
  compute_pending();
  wrenches.clear();
  for (std::size_t i = 0; i < bodies; ++i) {
    count(outcomes_[i], counters);
    wrenches.push_back(outcomes_[i].wrench);
  }
}

void BodyAnswers::answer_or_postpone(const BodyState& state, double lead_time, std::size_t i) {
  const std::optional<std::size_t> index = scene_->index_of(state.body_id);
  if (!index) {
    outcomes_[i] = not_answered(state.body_id, BodyStatus::kUnknownBody);
    return;
  }
  const AskedPose asked = asked_pose(state, lead_time);
  if (asked.status != BodyStatus::kOk) {
    outcomes_[i] = not_answered(state.body_id, asked.status, asked.quaternion_normalised);
    return;
  }
  const Remembered& last = remembered_[*index];
  if (last.valid && last.pose == pose_bits(asked.pose)) {
    outcomes_[i] = last.outcome;
    outcomes_[i].unchanged = true;
    return;
  }
  const Body& body = scene_->bodies()[*index];
  if (is_answered_by_bounds(body.solver,
                            immersion_at_a_glance(body.solver.mesh(), asked.pose, scene_->water()))) {
    outcomes_[i] = evaluate(body, scene_->water(), asked);
    remember(*index, asked.pose, outcomes_[i]);
    return;
  }
  pending_.push_back({i, *index, asked});
}

void BodyAnswers::compute_pending() {
  double work = 0.0;
  for (const Pending& pending : pending_) work += expected_time_[pending.body];
  const auto compute = [this](std::size_t n) {
    const Pending& pending = pending_[n];
    outcomes_[pending.state] = evaluate(scene_->bodies()[pending.body], scene_->water(), pending.asked);
  };
  if (pending_.size() > 1 && work > kWorthSharing && workers_.threads() > 1) {
    const double each = work / static_cast<double>(pending_.size());
    workers_.run(pending_.size(), static_cast<std::size_t>(std::max(1.0, kShare / each)), compute);
  } else {
    for (std::size_t n = 0; n < pending_.size(); ++n) compute(n);
  }
  // Afterwards and in order: a question may name a body twice.
  for (const Pending& pending : pending_) {
    remember(pending.body, pending.asked.pose, outcomes_[pending.state]);
  }
}

void BodyAnswers::remember(std::size_t body, const Pose& pose, const BodyOutcome& outcome) {
  Remembered& last = remembered_[body];
  last.valid = outcome.wrench.status == BodyStatus::kOk;
  if (!last.valid) return;
  last.pose = pose_bits(pose);
  last.outcome = outcome;
}

}  // namespace buoyancy
