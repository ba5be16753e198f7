#include "flotation/waterline.h"

#include <array>
#include <cstddef>

#include "hydrostatics/tree_plane.h"
#include "hydrostatics/waterline_sum.h"

namespace buoyancy {
namespace {

// Expresses a point's coordinate along a horizontal axis by its coordinates along b and c; k . y = h
// eliminates the one along a. axis: in metres per unit of length of the tree; start: [m].
PlaneCoordinate coordinate(const TreeQuery& query, const Vec3& axis, double start) {
  const std::array<std::size_t, 3>& axes = query.axes;
  const double per_k_a = axis[static_cast<int>(axes[0])] / query.k[axes[0]];
  return {.b = axis[static_cast<int>(axes[1])] - per_k_a * query.k[axes[1]],
          .c = axis[static_cast<int>(axes[2])] - per_k_a * query.k[axes[2]],
          .start = start + per_k_a * (query.h_high + query.h_low)};
}

}  // namespace

Waterline waterline(const HydrostaticMesh& mesh, const WaterPlane& plane, const WaterlineAxes& axes) {
  const MomentTree& tree = *mesh.tree;
  const TreeQuery query = make_tree_query(tree, plane_of_tree(tree, plane));
  const Vec3 start = tree.offset - axes.origin;
  const WaterlineSum sum =
      sum_waterline(tree, query, coordinate(query, tree.scale * axes.u, axes.u.dot(start)),
                    coordinate(query, tree.scale * axes.v, axes.v.dot(start)));
  // The edges have the wet surface to their left seen from outside, so they run clockwise from above.
  return {.area = sum.area / -2.0,
          .u = sum.u / -6.0,
          .v = sum.v / -6.0,
          .uu = sum.uu / -12.0,
          .uv = sum.uv / -24.0,
          .vv = sum.vv / -12.0,
          .min_u = sum.min_u,
          .max_u = sum.max_u,
          .min_v = sum.min_v,
          .max_v = sum.max_v};
}

}  // namespace buoyancy
