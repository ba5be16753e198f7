// Poses as in a simulator's requests: a floating body that moves slightly around its equilibrium from step to
// step.
#pragma once

#include <vector>

#include "hydrostatics/solver.h"

namespace buoyancy::bench {

inline constexpr double kCoherentStep = 1e-3;  // [L], L the bounding box's diagonal, and [rad]

// Equilibrium pose of a homogeneous body of half the water's density: the heave is found by bisection, the
// attitude by rotating the body along the torque about its centroid until the torque vanishes. Water level 0,
// up +z. solver: of an exact method. Costs at most some 10,000 queries.
Pose floating_pose(const Solver& solver);

// `count` poses of a closed orbit around `floating`, as in a wave: the centroid moves on a vertical circle
// and the body's up direction on a cone. From each pose to the next, and from the last to the first, the
// centroid moves by kCoherentStep L and the body turns by kCoherentStep rad, to 1 %.
std::vector<Pose> coherent_poses(const HydrostaticMesh& mesh, const Pose& floating, int count = 100);

}  // namespace buoyancy::bench
