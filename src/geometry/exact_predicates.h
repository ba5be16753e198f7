// Exact orientation predicates: the side of a line or plane on which a point lies, for the given doubles.
//
// A floating-point filter computes the determinant in double and accepts its sign if the value exceeds its
// rounding error bound; otherwise the determinant is computed without rounding, as an expansion (a sum of
// non-overlapping doubles). The result is exact as long as no intermediate product overflows or underflows:
// |differences of coordinates| zero or from 1e-70 to 1e100. Source: J. R. Shewchuk, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates", Discrete & Computational Geometry 18
// (1997).
#pragma once

#include "base/vec3.h"

namespace buoyancy {

// Returns +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they are collinear.
int orient_2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

// Returns +1 if d lies on the side of the plane abc that (b - a) x (c - a) points to, -1 if it lies on the
// other side, 0 if it lies on the plane.
int orient_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Same as orient_3d, but returns 0 also if the filter alone cannot decide. It is a cheap first test.
int orient_3d_filtered(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

// Returns (y, z) for axis 0 (x), (z, x) for axis 1 (y), (x, y) for axis 2 (z).
inline Eigen::Vector2d project_along_axis(int axis, const Vec3& point) {
  return {point((axis + 1) % 3), point((axis + 2) % 3)};
}

}  // namespace buoyancy
