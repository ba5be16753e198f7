// Converts a water plane to the coordinates of a moment tree (MomentTree::scale) and to a TreeQuery.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/double_double.h"
#include "geometry/moment_tree.h"
#include "hydrostatics/water_plane.h"
#include "hydrostatics/wetted_tree_sum.h"

namespace buoyancy {

// plane: about the mesh's centre, in metres. A point's height over the result is its height over `plane`,
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

// Returns x rounded to a whole multiple of unit, a power of two, to the nearest where |x| is at most 2^51
// unit: the spacing of doubles near the sum is the unit.
inline double whole_multiples(double x, double unit) {
  const double large = 0x1.8p52 * unit;
  return (x + large) - large;
}

// plane: in the coordinates of the tree. The caller sets budget and half_diagonal of the result.
inline TreeQuery make_tree_query(const MomentTree& tree, const WaterPlane& plane) {
  constexpr double kUnit = 0x1p-26;
  const Vec3& k = plane.up_B;
  TreeQuery query{};
  // Without a branch, which could not be predicted.
  const Vec3 size = k.cwiseAbs();
  const auto of_x_y = static_cast<std::size_t>(size.y() > size.x());
  const std::size_t a = size.z() > std::max(size.x(), size.y()) ? 2 : of_x_y;
  for (std::size_t n = 0; n < 3; ++n) query.axes[n] = (a + n) % 3;
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    query.k[n] = k[i];
    query.k_high[n] = whole_multiples(k[i], kUnit);
    query.k_low[n] = (k[i] - query.k_high[n]) + plane.up_B_rest[i];
  }
  query.h_high = whole_multiples(plane.h_c, tree.grid * kUnit);
  query.h_low = (plane.h_c - query.h_high) + plane.h_c_rest;
  return query;
}

}  // namespace buoyancy
