// The water plane in the coordinates of a moment tree (MomentTree::scale).
#pragma once

#include "base/double_double.h"
#include "geometry/moment_tree.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// plane: about the mesh's centre, in metres. The height of a point over the result is that over `plane`,
// divided by the tree's scale, to double-double accuracy. WaterPlane::error stays in metres.
inline WaterPlane plane_of_tree(const MomentTree& tree, const WaterPlane& plane) {
  if (tree.scale == 1.0 && tree.offset.isZero(0.0)) return plane;
  DoubleDouble h{plane.h_c, plane.h_c_rest};
  for (int i = 0; i < 3; ++i) {
    h = h - DoubleDouble{plane.up_B[i], plane.up_B_rest[i]} * tree.offset[i];
  }
  h = h * reciprocal({tree.scale, 0.0});
  WaterPlane result = plane;
  result.h_c = h.hi;
  result.h_c_rest = h.lo;
  return result;
}

}  // namespace buoyancy
