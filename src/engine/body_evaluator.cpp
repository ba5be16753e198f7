#include "engine/body_evaluator.h"

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

void BodyAnswers::use(const Scene& scene) {
  scene_ = &scene;
  remembered_.assign(scene.bodies().size(), {});
  pending_.clear();
  expected_time_.clear();
  wholly_wet_.clear();
  expected_time_.reserve(scene.bodies().size());
  wholly_wet_.reserve(scene.bodies().size());
  for (const Body& body : scene.bodies()) {
    expected_time_.push_back(expected_time(body.solver));
    wholly_wet_.push_back(wholly_wet(body.solver.mesh(), scene.water(), body.reference_B));
  }
}

void BodyAnswers::Remembered::evaluated_at(const Pose& at) {
  valid = outcome.status == BodyStatus::kOk;
  pose = pose_bits(at);
}

void BodyAnswers::answer(const Question& question, std::vector<BodyWrench>& wrenches, Counters& counters) {
  const std::size_t bodies = question.bodies.size();
  pending_.clear();
  wrenches.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) {
    const BodyState& state = question.bodies[i];
    if (const BodyOutcome* outcome = answer_or_postpone(state, question.lead_time, i)) {
      wrenches[i] = wrench_of(state.body_id, *outcome);
      count(*outcome, counters);
    }
  }
  compute_pending();
  // In order: a question may name a body twice.
  for (const Pending& pending : pending_) {
    wrenches[pending.state] = wrench_of(question.bodies[pending.state].body_id, pending.outcome);
    count(pending.outcome, counters);
    Remembered& last = remembered_[pending.body];
    last.outcome = pending.outcome;
    last.evaluated_at(pending.asked.pose);
  }
}

void BodyAnswers::forget() {
  for (Remembered& last : remembered_) last.valid = false;
}

std::optional<std::size_t> BodyAnswers::body_of(std::int32_t id, std::size_t i) const {
  // Whoever asks about a whole scene tends to do so in its order.
  if (i < scene_->bodies().size() && scene_->bodies()[i].id == id) return i;
  return scene_->index_of(id);
}

const BodyOutcome* BodyAnswers::answer_or_postpone(const BodyState& state, double lead_time, std::size_t i) {
  const std::optional<std::size_t> index = body_of(state.body_id, i);
  if (!index) {
    refused_ = {.status = BodyStatus::kUnknownBody, .answer = {}};
    return &refused_;
  }
  const AskedPose asked = asked_pose(state, lead_time);
  if (asked.status != BodyStatus::kOk) {
    refused_ = {.status = asked.status, .quaternion_normalised = asked.quaternion_normalised, .answer = {}};
    return &refused_;
  }
  Remembered& last = remembered_[*index];
  if (last.valid && same(last.pose, pose_bits(asked.pose))) {
    last.outcome.unchanged = true;
    return &last.outcome;
  }
  if (evaluate_by_bounds(scene_->bodies()[*index], wholly_wet_[*index], scene_->water(), asked,
                         last.outcome)) {
    last.evaluated_at(asked.pose);
    return &last.outcome;
  }
  pending_.push_back({.state = i, .body = *index, .asked = asked, .outcome = {}});
  return nullptr;
}

void BodyAnswers::compute_pending() {
  double work = 0.0;
  for (const Pending& pending : pending_) work += expected_time_[pending.body];
  const auto compute = [this](std::size_t n) {
    Pending& pending = pending_[n];
    evaluate(scene_->bodies()[pending.body], scene_->water(), pending.asked, pending.outcome);
  };
  if (pending_.size() > 1 && work > kWorthSharing && workers_.threads() > 1) {
    const double each = work / static_cast<double>(pending_.size());
    workers_.run(pending_.size(), static_cast<std::size_t>(std::max(1.0, kShare / each)), compute);
  } else {
    for (std::size_t n = 0; n < pending_.size(); ++n) compute(n);
  }
}

}  // namespace buoyancy
