// Computes the wrench on a body from its state: checks the state, extrapolates its pose by lead_time and adds
// up the loads of the water. This is the main path's link between messages and hydrostatics. The
// service, queries of many poses, the report and the response checks all call these functions, so that they
// agree on the order of the checks and on the bits.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

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

bool has_finite_twist(const BodyState& state);

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
  std::int64_t patches = 0;         // that were computed
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

// The largest lead time [s] in waves. Phases are exact up to this time and beyond.
inline constexpr double kMaxLeadTimeInWaves = 1e12;

// The status of a state whose pose is valid, before anything is computed. Checks in this order: the twist is
// finite, where the body's loads need it; the condition of its compartments and tanks is known; the water is
// known; the lead time is within range.
inline BodyStatus check_state(const BodyState& state, double lead_time, const WaterState& water,
                              bool needs_twist, bool is_condition_known) {
  if (needs_twist && !has_finite_twist(state)) return BodyStatus::kNonFiniteTwist;
  if (!is_condition_known) return BodyStatus::kBadCondition;
  if (water.at_rest == nullptr) return BodyStatus::kNoSea;
  const bool is_far = water.waves != nullptr && std::abs(lead_time) > kMaxLeadTimeInWaves;
  return is_far ? BodyStatus::kOutOfRange : BodyStatus::kOk;
}

// Returns the rough cost [ns] of a query at the surface on the processors of docs/measurements.md. An error
// by a factor of two makes no difference to its callers.
double estimated_time(const Solver& solver, bool in_waves);

// Returns the load on the solver's mesh at a pose. mesh: that of the solver. Precondition: the water is
// known. No heap allocation, except, in waves, until a thread's buffers are as large as its queries need.
WaveBuoyancyResult buoyancy_of(const Solver& solver, const PreparedMesh& mesh, const WaterState& water,
                               const Pose& pose, const Vec3& reference_B);

// A pose at which a body is computed, and where its outcome goes.
struct PoseQuery {
  const Body* body = nullptr;
  Pose pose;  // of a ValidatedPose with status kOk
  bool quaternion_normalised = false;
  const BodyCondition* condition = nullptr;  // of its compartments and tanks; nullptr: that of the scene file
  BodyOutcome* outcome = nullptr;
};

// The most queries that are computed together: a group is quicker than its queries one by one, and gives the
// same bits.
inline constexpr std::size_t kMaxGroup = 8;

// Sets the outcome of every query. Preconditions: there are at most kMaxGroup, and the water is known.
void evaluate(std::span<const PoseQuery> queries, const WaterState& water);
// Sets the outcome of one query.
void evaluate(const Body& body, const WaterState& water, const ValidatedPose& validated, BodyOutcome& outcome,
              const BodyCondition* condition = nullptr);
// Sets outcome to what bounds alone decide (see try_buoyancy_from_bounds, and in waves
// try_buoyancy_in_waves_from_bounds). Returns false, and leaves outcome unchanged, where they do not suffice,
// and for a body with compartments or tanks.
// Preconditions: validated.status is kOk, and the water is known. No heap allocation.
bool try_evaluate_from_bounds(const Body& body, const FullySubmerged& submerged, const WaterState& water,
                              const ValidatedPose& validated, BodyOutcome& outcome);
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
