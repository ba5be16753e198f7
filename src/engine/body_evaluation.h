// Evaluates one body: validates the pose of a received state, extrapolates it by lead_time and computes the
// wrench. This is the main path's link between messages and hydrostatics.
#pragma once

#include <array>
#include <cstdint>

#include "hydrostatics/buoyancy.h"
#include "messages/hydrostatics.h"
#include "messages/request.h"
#include "messages/status.h"
#include "scene/scene.h"

namespace buoyancy {

// Bounds on |norm - 1| of a quaternion: it is accepted and normalised up to the first, and counted as
// normalised beyond the second.
inline constexpr double kQuaternionTolerance = 1e-3;
inline constexpr double kQuaternionWarnTolerance = 1e-6;

// The pose that a state requests, or the reason why it is invalid.
struct ValidatedPose {
  BodyStatus status = BodyStatus::kOk;
  Pose pose;                           // valid only if status is kOk: finite, |q| within the tolerance of 1
  bool quaternion_normalised = false;  // |norm - 1| > kQuaternionWarnTolerance
};

// Checks in this order, and returns the first failure as the status: pose not finite, quaternion's norm,
// lead_time [s] not finite, twist not finite (only where lead_time is not 0), extrapolated pose beyond
// double's range.
ValidatedPose validate_pose(const BodyState& state, double lead_time);

// The bits of p_WB and q_WB: poses with equal bits have the same result.
using PoseBits = std::array<std::uint64_t, 7>;
PoseBits pose_bits(const Pose& pose);
Pose to_pose(const PoseBits& bits);
// Compares without a branch per component: every body of every request makes this test.
bool equal_branch_free(const PoseBits& a, const PoseBits& b);

// What a load in waves reports beside its result, see WaveBuoyancyResult.
struct WaveDetails {
  bool work_capped = false;
  bool sea_too_steep = false;
  bool below_bed = false;
  double volume_error_bound = 0.0;  // [m^3]
};

// A body's result, and what the service's counters record about it.
struct BodyOutcome {
  BodyStatus status = BodyStatus::kOk;
  bool quaternion_normalised = false;
  bool unchanged = false;  // the body's last result was reused
  WaveDetails in_waves;
  BuoyancyResult result;        // zeros if status is not kOk
  double flooded_volume = 0.0;  // [m^3], that flooded compartments take from the hull's displaced volume
};

// The water at a request's time.
struct WaterState {
  const Water* at_rest = nullptr;    // nullptr: unknown, since no sea has been received for this time
  const SeaAtTime* waves = nullptr;  // nullptr: the water is at rest
};

// The result of a mesh at a pose. mesh: of the solver. Precondition: the water is known. No heap allocation,
// except, in waves, until a thread's buffers are as large as its queries need.
WaveBuoyancyResult buoyancy_of(const Solver& solver, const PreparedMesh& mesh, const WaterState& water,
                               const Pose& pose, const Vec3& reference_B);

// The details of a result of buoyancy_of().
WaveDetails details_of(const WaveBuoyancyResult& computed);

// condition: of the body's compartments and tanks; nullptr: that of the scene file. Preconditions:
// validated.status is kOk, and the water is known.
void evaluate(const Body& body, const WaterState& water, const ValidatedPose& validated, BodyOutcome& outcome,
              const BodyCondition* condition = nullptr);
// Sets outcome to what bounds alone decide (see try_buoyancy_from_bounds, and in waves
// try_buoyancy_in_waves_from_bounds). Returns false, and leaves outcome unchanged, where they do not suffice,
// and for a body with compartments or tanks.
// Preconditions: validated.status is kOk, and the water is known. No heap allocation.
bool try_evaluate_from_bounds(const Body& body, const FullySubmerged& submerged, const WaterState& water,
                              const ValidatedPose& validated, BodyOutcome& outcome);
// Sets the fields of outcome that accompany its result, which was computed at a valid pose; in_waves to those
// of water at rest. flooded_volume stays.
void complete_outcome(bool quaternion_normalised, BodyOutcome& outcome);
BodyWrench to_wrench(std::int32_t body_id, const BodyOutcome& outcome);
void add_to_counters(const BodyOutcome& outcome, ServiceCounters& counters);

// Computes and counts the hydrostatics of a body at the pose of its wrench. status: the status of that
// wrench; unless it is kOk, the result holds zeros. condition: as for evaluate(). No heap allocation for a
// body without compartments and tanks.
BodyHydrostatics evaluate_hydrostatics(const Body& body, const Water& water, const Pose& pose,
                                       BodyStatus status, ServiceCounters& counters,
                                       const BodyCondition* condition = nullptr);

// The pose after `seconds` of constant twist: p + v t, and q rotated by w t about W's axes. The quaternion
// keeps its norm. The pose is not finite where it exceeds double's range, or where |w t| exceeds 1e154 [rad].
Pose extrapolate(const Pose& pose, const Vec3& linear_velocity_W, const Vec3& angular_velocity_W,
                 double seconds);

}  // namespace buoyancy
