// The loops over the waterline that run per node and per leaf of the moment tree: like wetted_tree_sum.h, an
// interface of plain types to a SIMD implementation.
#pragma once

#include <limits>

#include "hydrostatics/wetted_tree_sum.h"

namespace buoyancy {

// Gives a coordinate [m] of a point of the water plane, start + b y_b + c y_c, from the point's coordinates
// y_b, y_c along b and c (TreeQuery::axes) in the tree's unit of length.
struct PlaneCoordinate {
  double b = 0.0;
  double c = 0.0;
  double start = 0.0;
};

// Sums over the directed edges at which the water cuts the surface, from (u, v) to (u', v'), with the wet
// surface to the left seen from outside and w = u v' - u' v.
struct WaterlineSum {
  double area = 0.0;                                       // [m^2], of w
  double u = 0.0, v = 0.0;                                 // [m^3], of w (u + u')
  double uu = 0.0, vv = 0.0;                               // [m^4], of w (u^2 + u u' + u'^2)
  double uv = 0.0;                                         // [m^4], of w (u (2 v + v') + u' (v + 2 v'))
  double min_u = std::numeric_limits<double>::infinity();  // [m]; min > max: no edge
  double max_u = -std::numeric_limits<double>::infinity();
  double min_v = std::numeric_limits<double>::infinity();
  double max_v = -std::numeric_limits<double>::infinity();
};

// query: without a budget. Complexity: O(triangles that the water cuts + log n); no heap.
WaterlineSum sum_waterline(const MomentTree& tree, const TreeQuery& query, const PlaneCoordinate& u,
                           const PlaneCoordinate& v);

}  // namespace buoyancy
