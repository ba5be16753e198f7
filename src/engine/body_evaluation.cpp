#include "engine/body_evaluation.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "engine/subdivision_load.h"
#include "hydrostatics/hydrostatics.h"
#include "messages/conversions.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMinGroup = 3;  // fewer are quicker one by one

bool all_finite(const Pose& pose) {
  return pose.p_WB.allFinite() && pose.q_WB.coeffs().allFinite();
}

std::array<std::array<double, 3>, 2> to_arrays(const std::array<Vec3, 2>& pair) {
  return {to_array(pair[0]), to_array(pair[1])};
}

// |norm - 1|. Components whose squares overflow or underflow yield infinity or 1, both far beyond the
// tolerance.
double norm_defect(const std::array<double, 4>& q) {
  return std::abs(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) - 1.0);
}

BodyStatus to_body_status(BuoyancyStatus status) {
  switch (status) {
    case BuoyancyStatus::kOk:
      return BodyStatus::kOk;
    case BuoyancyStatus::kOpenEdgeWet:
      return BodyStatus::kOpenEdgeWet;
    case BuoyancyStatus::kOutOfRange:
      return BodyStatus::kOutOfRange;
    case BuoyancyStatus::kNotCertified:
      return BodyStatus::kNotCertified;
  }
  return BodyStatus::kOutOfRange;
}

WaveDetails details_of(const WaveBuoyancyResult& computed) {
  return {computed.work_capped, computed.sea_too_steep, computed.below_bed, computed.volume_error_bound,
          static_cast<std::int64_t>(computed.patches)};
}

// Sets the fields that accompany a result at a valid pose.
void complete_outcome(bool quaternion_normalised, const WaveDetails& in_waves, BodyOutcome& outcome) {
  outcome.status = to_body_status(outcome.result.status);
  outcome.quaternion_normalised = quaternion_normalised;
  outcome.unchanged = false;
  outcome.in_waves = in_waves;
}

// computed: the load on the body's mesh alone, to which those of compartments and tanks are added.
void set_outcome(const PoseQuery& query, const WaterState& water, WaveBuoyancyResult& computed) {
  BodyOutcome& outcome = *query.outcome;
  outcome.flooded_volume = 0.0;
  if (query.body->subdivision != nullptr) {
    outcome.flooded_volume = add_subdivision_load(*query.body, query.condition, water, query.pose, computed);
  }
  outcome.result = computed.result;
  complete_outcome(query.quaternion_normalised, details_of(computed), outcome);
}

}  // namespace

bool has_finite_twist(const BodyState& state) {
  return all_finite(state.linear_velocity) && all_finite(state.angular_velocity);
}

ValidatedPose validate_pose(const BodyState& state, double lead_time) {
  ValidatedPose validated;
  validated.status = BodyStatus::kNonFinitePose;
  if (!all_finite(state.position) || !all_finite(state.quaternion_wxyz)) return validated;
  validated.status = BodyStatus::kBadQuaternion;
  const double defect = norm_defect(state.quaternion_wxyz);
  if (defect > kQuaternionTolerance) return validated;
  validated.quaternion_normalised = defect > kQuaternionWarnTolerance;
  validated.status = BodyStatus::kBadLeadTime;
  if (!std::isfinite(lead_time)) return validated;
  validated.status = BodyStatus::kNonFiniteTwist;
  if (lead_time != 0.0 && !has_finite_twist(state)) return validated;
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  validated.pose = {.p_WB = to_vec3(state.position), .q_WB = {w, x, y, z}};
  if (lead_time != 0.0) {
    validated.status = BodyStatus::kOutOfRange;
    validated.pose = extrapolate(validated.pose, to_vec3(state.linear_velocity),
                                 to_vec3(state.angular_velocity), lead_time);
    if (!all_finite(validated.pose)) return validated;
  }
  validated.status = BodyStatus::kOk;
  return validated;
}

PoseBits pose_bits(const Pose& pose) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return {bits(pose.p_WB.x()), bits(pose.p_WB.y()), bits(pose.p_WB.z()), bits(pose.q_WB.w()),
          bits(pose.q_WB.x()), bits(pose.q_WB.y()), bits(pose.q_WB.z())};
}

Pose to_pose(const PoseBits& bits) {
  const auto value = [&bits](std::size_t i) { return std::bit_cast<double>(bits[i]); };
  return {.p_WB = {value(0), value(1), value(2)}, .q_WB = {value(3), value(4), value(5), value(6)}};
}

bool equal_branch_free(const PoseBits& a, const PoseBits& b) {
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

WaveBuoyancyResult buoyancy_of(const Solver& solver, const PreparedMesh& mesh, const WaterState& water,
                               const Pose& pose, const Vec3& reference_B) {
  if (water.waves == nullptr) return {.result = buoyancy(solver, pose, *water.at_rest, reference_B)};
  return buoyancy_in_waves(solver, mesh.wave_mesh.value(), *water.waves, pose, reference_B);
}

double estimated_time(const Solver& solver, bool in_waves) {
  const auto triangles = static_cast<double>(solver.mesh().surface.triangles.size());
  // In waves, the cost hardly depends on the mesh; other methods add up some hundred components per triangle.
  if (in_waves) return solver.method() == Method::kHierarchical ? 4e4 : 200.0 * triangles;
  return solver.method() == Method::kHierarchical ? 200.0 + 35.0 * std::sqrt(triangles) : 1.5 * triangles;
}

void evaluate(std::span<const PoseQuery> queries, const WaterState& water) {
  if (water.waves != nullptr || queries.size() < kMinGroup) {
    for (const PoseQuery& query : queries) {
      const Body& body = *query.body;
      WaveBuoyancyResult computed =
          buoyancy_of(body.solver, *body.prepared_mesh, water, query.pose, body.reference_B);
      set_outcome(query, water, computed);
    }
    return;
  }
  assert(queries.size() <= kMaxGroup);
  std::array<BuoyancyQuery, kMaxGroup> together;
  std::array<BuoyancyResult, kMaxGroup> results;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const Body& body = *queries[i].body;
    together[i] = {.solver = &body.solver, .pose = queries[i].pose, .reference_B = body.reference_B};
  }
  buoyancy(std::span(together).first(queries.size()), *water.at_rest,
           std::span(results).first(queries.size()));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    WaveBuoyancyResult computed{.result = results[i]};
    set_outcome(queries[i], water, computed);
  }
}

void evaluate(const Body& body, const WaterState& water, const ValidatedPose& validated, BodyOutcome& outcome,
              const BodyCondition* condition) {
  const PoseQuery query{.body = &body,
                        .pose = validated.pose,
                        .quaternion_normalised = validated.quaternion_normalised,
                        .condition = condition,
                        .outcome = &outcome};
  evaluate(std::span(&query, 1), water);
}

// Not inlined into try_evaluate_from_bounds(), the whole cost of most bodies of a large scene at rest.
[[gnu::noinline]] static bool try_evaluate_from_bounds_in_waves(const Body& body,
                                                                const FullySubmerged& submerged,
                                                                const SeaAtTime& waves,
                                                                const ValidatedPose& validated,
                                                                BodyOutcome& outcome) {
  WaveBuoyancyResult computed;
  if (!try_buoyancy_in_waves_from_bounds(body.solver, submerged, waves, validated.pose, body.reference_B,
                                         computed)) {
    return false;
  }
  outcome.result = computed.result;
  complete_outcome(validated.quaternion_normalised, details_of(computed), outcome);
  return true;
}

bool try_evaluate_from_bounds(const Body& body, const FullySubmerged& submerged, const WaterState& water,
                              const ValidatedPose& validated, BodyOutcome& outcome) {
  if (body.subdivision != nullptr) return false;
  if (water.waves != nullptr) {
    return try_evaluate_from_bounds_in_waves(body, submerged, *water.waves, validated, outcome);
  }
  if (!try_buoyancy_from_bounds(body.solver, submerged, validated.pose, *water.at_rest, body.reference_B,
                                outcome.result)) {
    return false;
  }
  complete_outcome(validated.quaternion_normalised, {}, outcome);
  return true;
}

BodyWrench to_wrench(std::int32_t body_id, const BodyOutcome& outcome) {
  const BuoyancyResult& result = outcome.result;
  return {.body_id = body_id,
          .status = outcome.status,
          .force = to_array(result.force_W),
          .torque = to_array(result.torque_W),
          .submerged_volume = result.volume,
          .center_of_buoyancy = to_array(result.center_of_buoyancy_W),
          .force_error_bound = result.force_error_bound,
          .torque_error_bound = result.torque_error_bound};
}

void add_to_counters(const BodyOutcome& outcome, ServiceCounters& counters) {
  ++counters.bodies[static_cast<std::size_t>(outcome.status)];
  counters.quaternions_normalised += static_cast<std::int64_t>(outcome.quaternion_normalised);
  if (outcome.status != BodyStatus::kOk) return;
  counters.bodies_unchanged += static_cast<std::int64_t>(outcome.unchanged);
  counters.bodies_work_capped += static_cast<std::int64_t>(outcome.in_waves.work_capped);
  counters.bodies_sea_too_steep += static_cast<std::int64_t>(outcome.in_waves.sea_too_steep);
  counters.bodies_below_bed += static_cast<std::int64_t>(outcome.in_waves.below_bed);
  switch (outcome.result.immersion) {
    case Immersion::kDry:
      ++counters.bodies_dry;
      break;
    case Immersion::kSubmerged:
      ++counters.bodies_wet;
      break;
    case Immersion::kPiercing:
      ++counters.bodies_crossing;
      break;
  }
  counters.largest_dropped_force = std::max(counters.largest_dropped_force, outcome.result.dropped_force);
  counters.largest_dropped_torque = std::max(counters.largest_dropped_torque, outcome.result.dropped_torque);
}

BodyHydrostatics evaluate_hydrostatics(const Body& body, const Water& water, const Pose& pose,
                                       BodyStatus status, ServiceCounters& counters,
                                       const BodyCondition* condition) {
  BodyHydrostatics message;
  message.body_id = body.id;
  message.status = status;
  if (status != BodyStatus::kOk) return message;
  const std::optional<Hydrostatics> computed =
      body.subdivision == nullptr
          ? hydrostatics(body.solver.mesh(), pose, water, body.reference_B, body.center_of_mass_B)
          : subdivided_hydrostatics(body, condition, water, pose);
  if (!computed) {
    message.status = BodyStatus::kOutOfRange;
    return message;
  }
  ++counters.hydrostatics;
  message.submerged_volume = computed->volume;
  message.center_of_buoyancy = to_array(computed->center_of_buoyancy_W);
  message.wetted_area = computed->wetted_area;
  message.waterplane_area = computed->waterplane_area;
  message.waterplane_centroid = to_array(computed->waterplane_centroid_W);
  message.waterplane_second_moments = computed->waterplane_second_moments;
  message.waterplane_axes = to_arrays(computed->waterplane_axes_W);
  message.metacentric_radii = computed->metacentric_radii;
  message.metacenters = to_arrays(computed->metacenters_W);
  message.metacentric_heights = computed->metacentric_heights;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      message.stiffness[row][column] =
          computed->stiffness(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
  }
  return message;
}

Pose extrapolate(const Pose& pose, const Vec3& linear_velocity_W, const Vec3& angular_velocity_W,
                 double seconds) {
  const Vec3 rotation_W = angular_velocity_W * seconds;
  const double angle = rotation_W.norm();
  const double sine_per_angle = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  const Vec3 axis_sine = sine_per_angle * rotation_W;
  const Eigen::Quaterniond rotation{std::cos(0.5 * angle), axis_sine.x(), axis_sine.y(), axis_sine.z()};
  return {.p_WB = pose.p_WB + seconds * linear_velocity_W, .q_WB = rotation * pose.q_WB};
}

}  // namespace buoyancy
