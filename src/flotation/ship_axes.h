// The axes of a ship in its body frame B, and heel and trim.
//
// Forward and up are unit vectors, the third axis points to port: port = up x forward. Heel is positive to
// starboard: the starboard side goes down. Trim is positive by the stern: the bow goes up. With k the world's
// up in B,
//   k . forward = sin trim,   k . port = cos trim sin heel,   k . up = cos trim cos heel,
// so that the body is turned by the trim about the horizontal first and by the heel about its own forward
// axis last. Trim lies between -pi/2 and pi/2, heel in (-pi, pi]; heel is 0 where forward is vertical.
#pragma once

#include "base/error.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct ShipAxes {
  Vec3 forward_B = Vec3::UnitX();  // unit
  Vec3 up_B = Vec3::UnitZ();       // unit, at right angles to forward

  Vec3 port_B() const { return up_B.cross(forward_B); }
  // (forward, port, up) components of a vector of B.
  Vec3 components(const Vec3& v_B) const { return {forward_B.dot(v_B), port_B().dot(v_B), up_B.dot(v_B)}; }
};

// Errors: a vector that is zero or not finite, and vectors that are not at right angles to within 1e-6.
Expected<ShipAxes> make_ship_axes(const Vec3& forward_B, const Vec3& up_B);

// The axes of a body whose own up is this axis of B: forward is x, or y where up lies along x. up_B: a unit
// vector along x, y or z.
ShipAxes axes_with_up(const Vec3& up_B);

// The axis of coordinates, with its sign, that is nearest to a direction; of equally near ones the last.
Vec3 nearest_axis(const Vec3& direction);

struct HeelTrim {
  double heel = 0.0;  // [rad], positive to starboard
  double trim = 0.0;  // [rad], positive by the stern
};

Vec3 up_at(const ShipAxes& axes, const HeelTrim& angles);       // [-], the world's up in B
HeelTrim heel_trim_of(const ShipAxes& axes, const Vec3& up_B);  // up_B: unit
// The horizontal direction to starboard of the heeled ship, in B: unit, at right angles to up and to the
// horizontal projection of forward. It does not depend on the trim.
Vec3 starboard_at(const ShipAxes& axes, double heel);

// The attitude with this heel and trim whose forward axis points along e1 in the horizontal plane: W's x
// axis projected on it, or W's y axis where |up . x| > 0.9.
Eigen::Quaterniond attitude_at(const ShipAxes& axes, const HeelTrim& angles, const Vec3& up_W);

}  // namespace buoyancy
