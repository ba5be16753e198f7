#include "engine/body_evaluation.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "hydrostatics/hydrostatics.h"
#include "messages/conversions.h"

namespace buoyancy {
namespace {

bool all_finite(const Pose& pose) {
  return pose.p_WB.allFinite() && pose.q_WB.coeffs().allFinite();
}

std::array<std::array<double, 3>, 2> as_arrays(const std::array<Vec3, 2>& pair) {
  return {as_array(pair[0]), as_array(pair[1])};
}

// abs(norm - 1). Components whose squares over- or underflow give infinity or 1: both are far from a unit.
double norm_defect(const std::array<double, 4>& q) {
  return std::abs(std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) - 1.0);
}

BodyStatus as_body_status(BuoyancyStatus status) {
  switch (status) {
    case BuoyancyStatus::kOk:
      return BodyStatus::kOk;
    case BuoyancyStatus::kOpenEdgeWet:
      return BodyStatus::kOpenEdgeWet;
    case BuoyancyStatus::kOutOfRange:
      return BodyStatus::kOutOfRange;
  }
  return BodyStatus::kOutOfRange;
}

// What goes beside the answer that the outcome now holds.
void judge(const AskedPose& asked, BodyOutcome& outcome) {
  outcome.status = as_body_status(outcome.answer.status);
  outcome.quaternion_normalised = asked.quaternion_normalised;
  outcome.unchanged = false;
}

}  // namespace

AskedPose asked_pose(const BodyState& state, double lead_time) {
  AskedPose asked;
  asked.status = BodyStatus::kNonFinitePose;
  if (!all_finite(state.position) || !all_finite(state.quaternion_wxyz)) return asked;
  asked.status = BodyStatus::kBadQuaternion;
  const double defect = norm_defect(state.quaternion_wxyz);
  if (defect > kQuaternionTolerance) return asked;
  asked.quaternion_normalised = defect > kQuaternionNoteworthy;
  asked.status = BodyStatus::kBadLeadTime;
  if (!std::isfinite(lead_time)) return asked;
  asked.status = BodyStatus::kNonFiniteTwist;
  if (lead_time != 0.0 && (!all_finite(state.linear_velocity) || !all_finite(state.angular_velocity)))
    return asked;
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  asked.pose = {.p_WB = as_vec3(state.position), .q_WB = {w, x, y, z}};
  if (lead_time != 0.0) {
    asked.status = BodyStatus::kOutOfRange;
    asked.pose =
        extrapolate(asked.pose, as_vec3(state.linear_velocity), as_vec3(state.angular_velocity), lead_time);
    if (!all_finite(asked.pose)) return asked;
  }
  asked.status = BodyStatus::kOk;
  return asked;
}

PoseBits pose_bits(const Pose& pose) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return {bits(pose.p_WB.x()), bits(pose.p_WB.y()), bits(pose.p_WB.z()), bits(pose.q_WB.w()),
          bits(pose.q_WB.x()), bits(pose.q_WB.y()), bits(pose.q_WB.z())};
}

bool same(const PoseBits& a, const PoseBits& b) {
  std::uint64_t difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

void evaluate(const Body& body, const Water& water, const AskedPose& asked, BodyOutcome& outcome) {
  outcome.answer = buoyancy(body.solver, asked.pose, water, body.reference_B);
  judge(asked, outcome);
}

bool evaluate_by_bounds(const Body& body, const WhollyWet& wet, const Water& water, const AskedPose& asked,
                        BodyOutcome& outcome) {
  if (!buoyancy_by_bounds(body.solver, wet, asked.pose, water, outcome.answer)) return false;
  judge(asked, outcome);
  return true;
}

BodyWrench wrench_of(std::int32_t body_id, const BodyOutcome& outcome) {
  const BuoyancyAnswer& answer = outcome.answer;
  return {.body_id = body_id,
          .status = outcome.status,
          .force = as_array(answer.force_W),
          .torque = as_array(answer.torque_W),
          .submerged_volume = answer.volume,
          .center_of_buoyancy = as_array(answer.center_of_buoyancy_W),
          .force_error_bound = answer.force_error_bound,
          .torque_error_bound = answer.torque_error_bound};
}

void count(const BodyOutcome& outcome, Counters& counters) {
  ++counters.bodies[static_cast<std::size_t>(outcome.status)];
  counters.quaternions_normalised += static_cast<std::int64_t>(outcome.quaternion_normalised);
  if (outcome.status != BodyStatus::kOk) return;
  counters.bodies_unchanged += static_cast<std::int64_t>(outcome.unchanged);
  switch (outcome.answer.immersion) {
    case Immersion::kDry:
      ++counters.bodies_dry;
      break;
    case Immersion::kWet:
      ++counters.bodies_wet;
      break;
    case Immersion::kCrossing:
      ++counters.bodies_crossing;
      break;
  }
  counters.largest_dropped_force = std::max(counters.largest_dropped_force, outcome.answer.dropped_force);
  counters.largest_dropped_torque = std::max(counters.largest_dropped_torque, outcome.answer.dropped_torque);
}

BodyHydrostatics hydrostatics_of_body(const Body& body, const Water& water, const Pose& pose,
                                      BodyStatus status, Counters& counters) {
  BodyHydrostatics message;
  message.body_id = body.id;
  message.status = status;
  if (status != BodyStatus::kOk) return message;
  const std::optional<Hydrostatics> found =
      hydrostatics(body.solver.mesh(), pose, water, body.reference_B, body.center_of_mass_B);
  if (!found) {
    message.status = BodyStatus::kOutOfRange;
    return message;
  }
  ++counters.hydrostatics;
  message.submerged_volume = found->volume;
  message.center_of_buoyancy = as_array(found->center_of_buoyancy_W);
  message.wetted_area = found->wetted_area;
  message.waterplane_area = found->waterplane_area;
  message.waterplane_centroid = as_array(found->waterplane_centroid_W);
  message.waterplane_second_moments = found->waterplane_second_moments;
  message.waterplane_axes = as_arrays(found->waterplane_axes_W);
  message.metacentric_radii = found->metacentric_radii;
  message.metacenters = as_arrays(found->metacenters_W);
  message.metacentric_heights = found->metacentric_heights;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      message.stiffness[row][column] =
          found->stiffness(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
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
  const Eigen::Quaterniond turn{std::cos(0.5 * angle), axis_sine.x(), axis_sine.y(), axis_sine.z()};
  return {.p_WB = pose.p_WB + seconds * linear_velocity_W, .q_WB = turn * pose.q_WB};
}

}  // namespace buoyancy
