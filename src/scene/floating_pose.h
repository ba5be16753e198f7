// Finds the draft at which a body floats in a given attitude.
#pragma once

#include <optional>

#include "flotation/floating_body.h"

namespace buoyancy {

struct FloatingPose {
  Pose pose;           // p_WB on the line through W's origin along up
  double draft = 0.0;  // [m], depth of the lowest vertex that displaces water
  FloatingState state;
};

// The pose with this attitude at which the body displaces its mass, with the liquids. Only the force is
// balanced there: the centre of buoyancy need not lie above or below the centre of mass. q_WB: unit.
//
// Returns nullopt where there is no such pose: the body is too heavy, or an open mesh would take in water
// first; and where a number is beyond double's range. The volume is off by at most the larger of the body's
// volume_tolerance() and the waterplane area times the rounding of the height. Complexity: that of
// Balance::at() and floating_state().
std::optional<FloatingPose> find_floating_pose(const FloatingBody& body, const Eigen::Quaterniond& q_WB,
                                               const Water& water);

}  // namespace buoyancy
