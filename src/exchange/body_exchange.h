// One body's state in, its wrench out: the checks of a pose that came from somebody else, the extrapolation
// by lead_time, and the query. The main path's link between messages and hydrostatics.
#pragma once

#include "messages/hydrostatics.h"
#include "messages/question.h"
#include "messages/status.h"
#include "scene/scene.h"

namespace buoyancy {

// abs(norm of quaternion - 1): accepted and normalised up to the first, counted beyond the second.
inline constexpr double kQuaternionTolerance = 1e-3;
inline constexpr double kQuaternionNoteworthy = 1e-6;

// Checks in this order, the first failure is the status: unknown id, pose not finite, quaternion's norm,
// lead_time not finite, twist not finite (only where lead_time is not 0), then the query's own. Anything but
// kOk leaves zeros. Counts into counters what it met. Allocates nothing.
BodyWrench answer_body(const Scene& scene, const BodyState& state, double lead_time, Counters& counters);

// The hydrostatics of a body whose outputs name them, at the pose that answer_body() took. status: of its
// wrench; anything but kOk leaves zeros. Counts what was computed. Allocates nothing.
BodyHydrostatics hydrostatics_of_body(const Body& body, const Water& water, const BodyState& state,
                                      double lead_time, BodyStatus status, Counters& counters);

// The pose after `seconds` of the constant twist: p + v t, and q turned by w t about W's axes. The quaternion
// keeps its norm. Not finite where the result, or an angle of more than 1e154, is beyond double.
Pose extrapolate(const Pose& pose, const Vec3& linear_velocity_W, const Vec3& angular_velocity_W,
                 double seconds);

}  // namespace buoyancy
