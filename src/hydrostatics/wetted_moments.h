// The surface moments of the wetted surface, by a descent of the moment tree (moment_tree.h): a fully
// submerged node adds its moments, a dry node adds nothing, and the triangles of the leaves that cross the
// water are clipped one by one.
//
// `hierarchical` sums only what force and torque need, many triangles at a time; hydrostatics needs all 30
// moments and the area, which are summed plainly here. Clipped triangles are summed about a point of the
// wetted surface itself, and heights are relative to a leaf's centre, whose own height is rounded once: a
// body that barely touches the water keeps its digits.
#pragma once

#include "geometry/moment_tree.h"
#include "geometry/surface_moments.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct WettedMoments {
  SurfaceMoments<double> moments;  // B axes, about `point`
  Vec3 point = Vec3::Zero();       // [m], B axes, from the mesh's centre c
  double height = 0.0;             // [m], of `point` over the water
  double area = 0.0;               // [m^2], of the wetted surface
};

// plane: about the mesh's centre, in metres, whatever the tree's unit of length.
//
// Errors, each times a few eps, with A_w the wetted surface's area and R the distance from `point` to its
// farthest part: area and S within A_w, N within A_w L, P within A_w L^2; if no whole node is submerged, R
// replaces L. Complexity: O(triangles that the water cuts + log n); no heap.
WettedMoments wetted_moments(const MomentTree& tree, const WaterPlane& plane);

// [m^2], the area alone, at a quarter of the cost.
double wetted_area(const MomentTree& tree, const WaterPlane& plane);

}  // namespace buoyancy
