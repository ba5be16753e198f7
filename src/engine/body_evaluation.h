// One body's state in, its wrench out: the checks of a pose that came from somebody else, the extrapolation
// by lead_time, and the query. The main path's link between messages and hydrostatics.
#pragma once

#include <array>
#include <cstdint>

#include "hydrostatics/buoyancy.h"
#include "messages/hydrostatics.h"
#include "messages/request.h"
#include "messages/status.h"
#include "scene/scene.h"

namespace buoyancy {

// abs(norm of quaternion - 1): accepted and normalised up to the first, counted beyond the second.
inline constexpr double kQuaternionTolerance = 1e-3;
inline constexpr double kQuaternionWarnTolerance = 1e-6;

// The pose that a state asks about, or why there is none.
struct ValidatedPose {
  BodyStatus status = BodyStatus::kOk;
  Pose pose;                           // where status is kOk: finite, |q| within the tolerance of 1
  bool quaternion_normalised = false;  // beyond kQuaternionWarnTolerance
};

// Checks in this order, the first failure is the status: pose not finite, quaternion's norm, lead_time not
// finite, twist not finite (only where lead_time is not 0), extrapolated pose beyond double's range.
ValidatedPose validate_pose(const BodyState& state, double lead_time);

// Two poses are the same if these are: the bits of p_WB and q_WB.
using PoseBits = std::array<std::uint64_t, 7>;
PoseBits pose_bits(const Pose& pose);
bool same(const PoseBits& a, const PoseBits& b);

// A body's response, and what the status counts of it.
struct BodyOutcome {
  BodyStatus status = BodyStatus::kOk;
  bool quaternion_normalised = false;
  bool unchanged = false;   // taken from the body's last response
  BuoyancyResult response;  // status other than kOk: zeros
};

// validated.status: kOk. Allocates nothing.
void evaluate(const Body& body, const Water& water, const ValidatedPose& validated, BodyOutcome& outcome);
// The same where the body's bounds alone say it (try_buoyancy_from_bounds); false: they do not, outcome is as
// it was.
bool try_evaluate_from_bounds(const Body& body, const FullySubmerged& wet, const Water& water,
                              const ValidatedPose& validated, BodyOutcome& outcome);
BodyWrench to_wrench(std::int32_t body_id, const BodyOutcome& outcome);
void add_to_counters(const BodyOutcome& outcome, ServiceCounters& counters);

// The hydrostatics of a body whose outputs name them, at the pose of its wrench. status: of that wrench;
// anything but kOk leaves zeros. Counts what was computed. Allocates nothing.
BodyHydrostatics hydrostatics_of_body(const Body& body, const Water& water, const Pose& pose,
                                      BodyStatus status, ServiceCounters& counters);

// The pose after `seconds` of the constant twist: p + v t, and q turned by w t about W's axes. The quaternion
// keeps its norm. Not finite where the result, or an angle of more than 1e154, is beyond double.
Pose extrapolate(const Pose& pose, const Vec3& linear_velocity_W, const Vec3& angular_velocity_W,
                 double seconds);

}  // namespace buoyancy
