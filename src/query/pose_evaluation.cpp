#include "query/pose_evaluation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "engine/load_evaluation.h"
#include "query/pose_loop.h"

namespace buoyancy {
namespace {

template <std::size_t kSize>
std::array<double, kSize> element(std::span<const double> values, std::size_t i) {
  std::array<double, kSize> copy{};
  if (!values.empty())
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(kSize * i), kSize, copy.begin());
  return copy;
}

BodyState state_at(const Body& body, const PoseArrays& poses, std::size_t i) {
  return {.body_id = body.id,
          .position = element<3>(poses.positions, i),
          .quaternion_wxyz = element<4>(poses.quaternions_wxyz, i),
          .linear_velocity = element<3>(poses.linear_velocities, i),
          .angular_velocity = element<3>(poses.angular_velocities, i)};
}

void store(const std::array<double, 3>& values, std::span<double> out, std::size_t i) {
  std::ranges::copy(values, out.begin() + static_cast<std::ptrdiff_t>(3 * i));
}

void store(const BodyWrench& wrench, const WrenchArrays& out, std::size_t i) {
  out.statuses[i] = static_cast<std::int32_t>(wrench.status);
  store(wrench.force, out.forces, i);
  store(wrench.torque, out.torques, i);
  out.volumes[i] = wrench.submerged_volume;
  store(wrench.center_of_buoyancy, out.centers_of_buoyancy, i);
  out.force_error_bounds[i] = wrench.force_error_bound;
  out.torque_error_bounds[i] = wrench.torque_error_bound;
}

// Evaluates the poses of one range on one thread, up to kGroup of them together: setting up a large group
// costs as much as half a pose.
template <std::size_t kGroup>
class RangeEvaluation {
 public:
  RangeEvaluation(const Body& body, const QueryWater& water, const PoseArrays& poses,
                  const WrenchArrays& wrenches, std::span<BodyLoads> loads)
      : body_(body),
        water_(water),
        poses_(poses),
        wrenches_(wrenches),
        loads_(loads),
        submerged_(submerged_constants(body.solver.mesh(), water.at_rest, body.reference_B)),
        sea_(water.waves.get()) {}

  void run(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) evaluate(i);
    compute_group();
  }

 private:
  void evaluate(std::size_t i) {
    const BodyState state = state_at(body_, poses_, i);
    const ValidatedPose validated = validate_pose(state, 0.0);
    BodyOutcome outcome;
    outcome.status = validated.status;
    if (outcome.status == BodyStatus::kOk) {
      if (water_.is_known) move_to(poses_.utime(i));
      outcome.status = check_state(state, 0.0, now_, body_.hydrodynamics != nullptr, true);
    }
    if (outcome.status != BodyStatus::kOk) return store(to_wrench(body_.id, outcome), wrenches_, i);
    if (try_evaluate_from_bounds(body_, submerged_, now_, validated, outcome)) {
      return complete(i, validated.pose, outcome);
    }
    pending_[pending_count_] = i;
    queries_[pending_count_] = {.body = &body_,
                                .pose = validated.pose,
                                .quaternion_normalised = validated.quaternion_normalised,
                                .condition = nullptr,
                                .outcome = &outcomes_[pending_count_]};
    // The next pose may move the waves, so that each is computed on its own.
    if (++pending_count_ == kGroup || now_.waves != nullptr) compute_group();
  }

  // The pending poses are in water at rest, and are computed before waves begin.
  void move_to(std::int64_t utime) {
    const SeaAtTime* const waves = sea_.at(utime);
    if (waves != now_.waves) compute_group();
    now_ = {&water_.at_rest, waves};
  }

  void compute_group() {
    buoyancy::evaluate(std::span(queries_).first(pending_count_), now_);
    for (std::size_t n = 0; n < pending_count_; ++n) complete(pending_[n], queries_[n].pose, outcomes_[n]);
    pending_count_ = 0;
  }

  // Adds the loads of motion to a buoyant wrench, and stores it.
  void complete(std::size_t i, const Pose& pose, const BodyOutcome& outcome) {
    BodyWrench wrench = to_wrench(body_.id, outcome);
    if (outcome.status == BodyStatus::kOk && (body_.hydrodynamics != nullptr || !loads_.empty())) {
      add_loads(body_, now_, water_.current, pose, twist_of(state_at(body_, poses_, i)), outcome, wrench,
                loads_.empty() ? nullptr : &loads_[i]);
    }
    store(wrench, wrenches_, i);
  }

  const Body& body_;
  const QueryWater& water_;
  const PoseArrays& poses_;
  const WrenchArrays& wrenches_;
  std::span<BodyLoads> loads_;
  FullySubmerged submerged_;
  MovingSea sea_;
  WaterState now_;
  std::array<PoseQuery, kGroup> queries_;
  std::array<BodyOutcome, kGroup> outcomes_;
  std::array<std::size_t, kGroup> pending_{};  // the index of each query's pose
  std::size_t pending_count_ = 0;
};

}  // namespace

QueryWater water_of(const QuerySea& sea) {
  return {.at_rest = sea.water(), .waves = sea.waves(), .current = sea.current()};
}

QueryWater water_of(const Scene& scene) {
  return {.at_rest = scene.water(),
          .waves = scene.prepared_sea(),
          .current = scene.current(),
          .is_known = !scene.receives_sea()};
}

void evaluate_poses(const Body& body, const QueryWater& water, const PoseArrays& poses,
                    const WrenchArrays& wrenches, std::span<BodyLoads> loads, unsigned threads) {
  assert(wrenches.statuses.size() == poses.size() && (loads.empty() || loads.size() == poses.size()));
  if (poses.size() == 1) return RangeEvaluation<1>(body, water, poses, wrenches, loads).run(0, 1);
  run_chunks(poses.size(), estimated_time(body.solver, water.waves != nullptr), threads,
             [&](std::size_t begin, std::size_t end) {
               RangeEvaluation<kMaxGroup>(body, water, poses, wrenches, loads).run(begin, end);
             });
}

void evaluate_hydrostatics(const Body& body, const Water& water, const PoseArrays& poses,
                           std::span<BodyHydrostatics> hydrostatics, unsigned threads) {
  assert(hydrostatics.size() == poses.size());
  run_chunks(poses.size(), estimated_time(body.solver, false), threads,
             [&](std::size_t begin, std::size_t end) {
               ServiceCounters counters;
               for (std::size_t i = begin; i < end; ++i) {
                 const ValidatedPose validated = validate_pose(state_at(body, poses, i), 0.0);
                 BodyOutcome outcome;
                 outcome.status = validated.status;
                 // The buoyancy's status says whether the pose is within range, and whether an open boundary
                 // is dry.
                 if (outcome.status == BodyStatus::kOk) evaluate(body, {&water, nullptr}, validated, outcome);
                 hydrostatics[i] =
                     buoyancy::evaluate_hydrostatics(body, water, validated.pose, outcome.status, counters);
               }
             });
}

}  // namespace buoyancy
