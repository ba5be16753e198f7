// How much the loads of water at rest on two meshes in the same pose differ: a measure of how much a change
// of a mesh, such as a decimation, matters.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"

namespace buoyancy {

struct LoadDifference {
  double force = 0.0;   // [N], the largest |F_a - F_b|
  double torque = 0.0;  // [N m], the largest |T_a - T_b|, both about the origin of the meshes' frame
  // Bounds on the rounding errors of these differences.
  double force_error = 0.0;   // [N]
  double torque_error = 0.0;  // [N m]
};

// Returns the largest differences over `poses` poses. Their upward directions are spread evenly over the
// sphere, and the levels of the water over the heights of both meshes along that direction; the heading makes
// no difference. The poses depend on the meshes and on their number alone. No difference of forces, in any
// pose, exceeds density * gravity * symmetric_difference() (geometry/volume_difference.h).
//
// a, b: closed, in the same frame B, with their trees, and neither so large that buoyancy() returns
// kOutOfRange. density: [kg/m^3]. gravity: [m/s^2]. poses: 0 or more. Complexity: that of as many queries
// with `hierarchical` for each mesh. No heap allocation.
LoadDifference largest_load_difference(const HydrostaticMesh& a, const HydrostaticMesh& b, double density,
                                       double gravity, int poses);

}  // namespace buoyancy
