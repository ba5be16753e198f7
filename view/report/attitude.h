// Heave, roll and pitch of a body in the water.
#pragma once

#include "hydrostatics/water_plane.h"

namespace buoyancy::view {

enum class MeshUp { kZ, kY, kX };  // the axis of B that points up if the body is upright

struct Attitude {
  double heave = 0.0;  // [m], height of B's origin above the level; in run_summary.h, of the centre of mass
  double roll = 0.0;   // [degrees], -180 to 180
  double pitch = 0.0;  // [degrees], -90 to 90
};

// Decomposes the orientation into yaw, pitch and roll about z, y and x, z being up, and returns the last two.
// Two rotations are removed first: the one that stands a mesh upright if its own up axis is y (90 degrees
// about its x) or x (-90 degrees about its y), and, if up_W is not z, the shortest rotation of up_W to z.
// Precondition: pose.q_WB != 0.
Attitude attitude(const Pose& pose, const Water& water, MeshUp mesh_up);

}  // namespace buoyancy::view
