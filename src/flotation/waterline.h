// The waterplane of a mesh from the edges at which the water cuts its surface: area, moments and extent in
// the plane. Green's theorem turns the integrals over the waterplane into sums over its edges, at less than
// the cost of a displacement by `hierarchical`; only the triangles that the water cuts are visited.
#pragma once

#include <limits>

#include "hydrostatics/hydrostatic_mesh.h"

namespace buoyancy {

// Horizontal axes: u, v and up are right-handed and unit. Coordinates start at `origin`, which is given in
// the mesh's frame, relative to its centre c.
struct WaterlineAxes {
  Vec3 u = Vec3::UnitX();
  Vec3 v = Vec3::UnitY();
  Vec3 origin = Vec3::Zero();  // [m]
};

struct Waterline {
  double area = 0.0;                                       // [m^2]
  double u = 0.0, v = 0.0;                                 // [m^3], first moments
  double uu = 0.0, uv = 0.0, vv = 0.0;                     // [m^4], second moments
  double min_u = std::numeric_limits<double>::infinity();  // [m]; min > max: no waterline
  double max_u = -std::numeric_limits<double>::infinity();
  double min_v = std::numeric_limits<double>::infinity();
  double max_v = -std::numeric_limits<double>::infinity();
};

// mesh: with its tree. plane: about c. Errors: area 64 eps A_s, moments that times the largest coordinate.
// Complexity: O(triangles that the water cuts + log n); no heap.
Waterline waterline(const HydrostaticMesh& mesh, const WaterPlane& plane, const WaterlineAxes& axes);

}  // namespace buoyancy
