// The surface moments of what is wet, by a descent of the moment tree (moment_tree.h): a wholly wet node adds
// its own, a dry one nothing, and the triangles of the leaves that the water crosses are clipped one by one.
//
// `hierarchical` sums no more than force and torque need, many triangles at a time; this is the plain sum of
// all 30 moments and of the area, for those who ask for hydrostatics. Clipped triangles are summed about a
// point of the wet surface itself, and heights are taken from a leaf's centre, whose own is rounded once: a
// body that barely touches the water keeps its digits.
#pragma once

#include "geometry/moment_tree.h"
#include "geometry/surface_moments.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct WettedMoments {
  SurfaceMoments<double> moments;  // B axes, about `point`
  Vec3 point = Vec3::Zero();       // m, B axes, from the mesh's centre c
  double height = 0.0;             // m: of `point` over the water
  double area = 0.0;               // m^2: of the wet surface
};

// Errors, with A_w the wet surface's area, R the distance from `point` to its farthest part, each times a few
// eps: area and S within A_w, N within A_w L, P within A_w L^2; where no whole node is wet, R in the place of
// L. O(triangles that the water cuts + log n); no heap.
WettedMoments wetted_moments(const MomentTree& tree, const WaterPlane& plane);

}  // namespace buoyancy
