#include "query/pose_evaluation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "engine/load_evaluation.h"
#include "engine/subdivision_load.h"
#include "query/pose_loop.h"

namespace buoyancy {
namespace {

constexpr std::size_t kGroup = 8;  // poses that are computed together

// [ns], rough: a factor of two either way makes no difference.
double estimated_time(const Body& body, bool in_waves) {
  const auto triangles = static_cast<double>(body.solver.mesh().surface.triangles.size());
  if (in_waves) return body.solver.method() == Method::kHierarchical ? 4e4 : 200.0 * triangles;
  return body.solver.method() == Method::kHierarchical ? 100.0 + 25.0 * std::sqrt(triangles)
                                                       : 1.5 * triangles;
}

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

// Evaluates the poses of one range on one thread.
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
  // A pose that crosses the surface of water at rest, to be computed with others.
  struct Pending {
    std::size_t pose = 0;
    bool quaternion_normalised = false;
  };

  void evaluate(std::size_t i) {
    const BodyState state = state_at(body_, poses_, i);
    const ValidatedPose validated = validate_pose(state, 0.0);
    BodyOutcome outcome;
    outcome.status = validated.status;
    if (outcome.status == BodyStatus::kOk && body_.hydrodynamics != nullptr && !twist_of(state).is_finite()) {
      outcome.status = BodyStatus::kNonFiniteTwist;
    }
    if (outcome.status == BodyStatus::kOk && !water_.is_known) outcome.status = BodyStatus::kNoSea;
    if (outcome.status != BodyStatus::kOk) return store(to_wrench(body_.id, outcome), wrenches_, i);

    const WaterState now{&water_.at_rest, sea_.at(poses_.utime(i))};
    if (try_evaluate_from_bounds(body_, submerged_, now, validated, outcome)) {
      return complete(state, validated.pose, now, outcome, i);
    }
    if (now.waves != nullptr) {
      buoyancy::evaluate(body_, now, validated, outcome);
      return complete(state, validated.pose, now, outcome, i);
    }
    pending_[pending_count_] = {i, validated.quaternion_normalised};
    queries_[pending_count_] = {
        .solver = &body_.solver, .pose = validated.pose, .reference_B = body_.reference_B};
    if (++pending_count_ == kGroup) compute_group();
  }

  void compute_group() {
    std::array<BuoyancyResult, kGroup> results;
    buoyancy::buoyancy(std::span(queries_).first(pending_count_), water_.at_rest,
                       std::span(results).first(pending_count_));
    for (std::size_t n = 0; n < pending_count_; ++n) {
      BodyOutcome outcome;
      WaveBuoyancyResult computed{.result = results[n]};
      double flooded_volume = 0.0;
      if (body_.subdivision != nullptr) {
        flooded_volume =
            add_subdivision_load(body_, nullptr, {&water_.at_rest, nullptr}, queries_[n].pose, computed);
      }
      outcome.result = computed.result;
      complete_outcome(pending_[n].quaternion_normalised, outcome);
      outcome.flooded_volume = flooded_volume;
      const std::size_t i = pending_[n].pose;
      complete(state_at(body_, poses_, i), queries_[n].pose, {&water_.at_rest, nullptr}, outcome, i);
    }
    pending_count_ = 0;
  }

  // Adds the loads of motion to a buoyant wrench, and stores it.
  void complete(const BodyState& state, const Pose& pose, const WaterState& now, const BodyOutcome& outcome,
                std::size_t i) {
    BodyWrench wrench = to_wrench(body_.id, outcome);
    if (outcome.status == BodyStatus::kOk && (body_.hydrodynamics != nullptr || !loads_.empty())) {
      add_loads(twist_of(state), pose, now, outcome, i, wrench);
    }
    store(wrench, wrenches_, i);
  }

  void add_loads(const BodyTwist& twist, const Pose& pose, const WaterState& now, const BodyOutcome& outcome,
                 std::size_t i, BodyWrench& wrench) {
    if (body_.hydrodynamics == nullptr) {
      loads_[i] = to_loads(body_, wrench, flow_at_body(now, water_.current_W, pose.p_WB));
      return;
    }
    // A dry body has neither drag nor added mass.
    if (outcome.result.immersion == Immersion::kDry && loads_.empty()) return;
    const HydrodynamicState state = hydrodynamic_state(body_, now, water_.current_W, pose, twist, outcome);
    const HydrodynamicLoad load = body_.hydrodynamics->load(state);
    if (!loads_.empty()) loads_[i] = to_loads(body_, wrench, state, load);
    add_hydrodynamic_load(load, wrench);
  }

  const Body& body_;
  const QueryWater& water_;
  const PoseArrays& poses_;
  const WrenchArrays& wrenches_;
  std::span<BodyLoads> loads_;
  FullySubmerged submerged_;
  MovingSea sea_;
  std::array<Pending, kGroup> pending_;
  std::array<BuoyancyQuery, kGroup> queries_;
  std::size_t pending_count_ = 0;
};

}  // namespace

QueryWater water_of(const QuerySea& sea) {
  return {.at_rest = sea.water(), .waves = sea.waves(), .current_W = sea.current_W()};
}

QueryWater water_of(const Scene& scene) {
  return {.at_rest = scene.water(),
          .waves = scene.prepared_sea(),
          .current_W = scene.current_W(),
          .is_known = !scene.receives_sea()};
}

void evaluate_poses(const Body& body, const QueryWater& water, const PoseArrays& poses,
                    const WrenchArrays& wrenches, std::span<BodyLoads> loads, unsigned threads) {
  assert(wrenches.statuses.size() == poses.size() && (loads.empty() || loads.size() == poses.size()));
  run_chunks(poses.size(), estimated_time(body, water.waves != nullptr), threads,
             [&](std::size_t begin, std::size_t end) {
               RangeEvaluation(body, water, poses, wrenches, loads).run(begin, end);
             });
}

void evaluate_hydrostatics(const Body& body, const Water& water, const PoseArrays& poses,
                           std::span<BodyHydrostatics> hydrostatics, unsigned threads) {
  assert(hydrostatics.size() == poses.size());
  run_chunks(poses.size(), estimated_time(body, false), threads, [&](std::size_t begin, std::size_t end) {
    ServiceCounters counters;
    for (std::size_t i = begin; i < end; ++i) {
      const ValidatedPose validated = validate_pose(state_at(body, poses, i), 0.0);
      BodyOutcome outcome;
      outcome.status = validated.status;
      // Its status says whether the pose is within range, and whether the boundary of an open mesh is dry.
      if (outcome.status == BodyStatus::kOk) evaluate(body, {&water, nullptr}, validated, outcome);
      hydrostatics[i] =
          buoyancy::evaluate_hydrostatics(body, water, validated.pose, outcome.status, counters);
    }
  });
}

}  // namespace buoyancy
