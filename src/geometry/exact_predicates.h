// On which side of a line or plane a point lies, decided exactly for the doubles given.
//
// A sign is computed in double first and taken if it exceeds its rounding error; else it is computed without
// rounding, as a sum of doubles that do not overlap (an expansion). Exact as long as no intermediate product
// overflows or underflows: differences of coordinates zero or between 1e-70 and 1e100 in size. Source:
// J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
// Discrete & Computational Geometry 18 (1997).
#pragma once

#include "base/vec3.h"

namespace buoyancy {

// +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they lie on one line.
int orient_2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

// +1 if d lies on the side of the plane abc that (b - a) x (c - a) points to, -1 if on the other, 0 if on it.
int orient_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The same, but 0 also where plain doubles cannot tell: a cheap first look.
int orient_3d_filtered(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// Whether a, b, c lie on one line.
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

// The point seen along an axis: y, z along 0 (x); z, x along 1 (y); x, y along 2 (z).
inline Eigen::Vector2d project_along_axis(int axis, const Vec3& point) {
  return {point((axis + 1) % 3), point((axis + 2) % 3)};
}

}  // namespace buoyancy
