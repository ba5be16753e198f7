// Wave loads by brute force: every triangle is cut into many, the surface's linear interpolant clips them,
// and the pressure of the sea itself is integrated over what is wet. The oracle of the wave loads' bounds.
#pragma once

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

struct BruteForceLoad {
  Vec3 force = Vec3::Zero();   // [m^3], B axes, over rho g
  Vec3 torque = Vec3::Zero();  // [m^4]
  double volume = 0.0;         // [m^3]
  double force_error = 0.0;    // [m^3], estimate, by comparison with half as many cuts
  double torque_error = 0.0;   // [m^4]
  double volume_error = 0.0;   // [m^3]
};

// surface: relative to center_B. cuts: of each edge; even. The error falls with the fourth power of the
// number of cuts.
BruteForceLoad brute_force_load(const TriangleMesh& surface, const Vec3& center_B, const SeaSnapshot& sea,
                                const Pose& pose, const Vec3& reference_B, int cuts);

}  // namespace buoyancy
