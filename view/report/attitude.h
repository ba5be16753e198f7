// How a body lies in the water, in the words of people who look at it.
#pragma once

#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class MeshUp { kZ, kY, kX };  // the axis of B that points up when the body is upright

struct Attitude {
  double heave = 0.0;  // m: B's origin over the water
  double roll = 0.0;   // degrees, -180 to 180
  double pitch = 0.0;  // degrees, -90 to 90
};

// Roll and pitch are the last two of yaw, pitch and roll about z, y and x, z being up, after the turn has
// been taken out that stands a mesh upright whose own up axis is y (90 degrees about its x) or x (-90 degrees
// about its y); in a world whose up is not z, after the shortest turn of up to z. pose.q_WB: not zero.
Attitude attitude(const Pose& pose, const Water& water, MeshUp mesh_up);

}  // namespace buoyancy
