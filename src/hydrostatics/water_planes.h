// Water planes in the body frames of many bodies at once.
#pragma once

#include <span>

#include "hydrostatics/water_plane.h"

namespace buoyancy {

// Sets planes[i] to water_plane_in_body(poses[i], water, centers_B[i]), the same bits except for the kind of
// a NaN, in a fraction of the time: double-double arithmetic in SIMD (Highway, run-time dispatch). All spans
// have the same size. No heap allocation.
void water_planes_in_body(std::span<const Pose> poses, const Water& water, std::span<const Vec3> centers_B,
                          std::span<WaterPlane> planes);

}  // namespace buoyancy
