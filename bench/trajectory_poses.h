// Poses as a simulator asks for them: a floating body that moves a little around its equilibrium from step to
// step.
#pragma once

#include <vector>

#include "hydrostatics/solver.h"

namespace buoyancy::bench {

inline constexpr double kCoherentStep = 1e-3;  // of the bounding box's diagonal L, and rad

// Where a homogeneous body of half the water's density floats at rest: heave balanced by bisection, attitude
// by turning the body along the torque about its centroid until that has died away. The water's level is 0,
// up +z. solver: of an exact method; at most some 10,000 queries.
Pose floating_pose(const Solver& solver);

// `count` poses of a closed orbit around `floating`, as in a wave: the centroid runs through a vertical
// circle, the body's up direction round a cone. From each pose to the next, and from the last to the first,
// the centroid moves by kCoherentStep L and the body turns by kCoherentStep rad, to 1 %.
std::vector<Pose> coherent_poses(const HydrostaticMesh& mesh, const Pose& floating, int count = 100);

}  // namespace buoyancy::bench
