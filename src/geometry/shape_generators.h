// Internal to make_shape and check_shape (shapes.h), and to the benchmarks: one generator per shape.
//
// Contract: each takes a checked shape and returns an outward oriented mesh without unused vertices whose
// edges are each used once in each direction. Vertices are shared by construction, not by comparing
// positions.
#pragma once

#include "geometry/shapes.h"

namespace buoyancy {

TriangleMesh generate(const BoxShape& box);
TriangleMesh generate(const SphereShape& sphere);
TriangleMesh generate(const CylinderShape& cylinder);
TriangleMesh generate(const ConeShape& cone);
TriangleMesh generate(const TorusKnotShape& knot);
TriangleMesh generate(const WigleyShape& hull);
TriangleMesh generate(const RockShape& rock);

// Returns the point of the rock's surface [m] in a direction from its centre. direction: of any length but 0.
Vec3 rock_surface_point(const RockShape& rock, const Vec3& direction);

// Returns the maximum radius [m] of a smooth tube around the knot's curve that does not touch itself: the
// minimum radius of all circles that are tangent to the curve at one point and pass through another (O.
// Gonzalez, J. H. Maddocks, "Global curvature, thickness, and the ideal shapes of knots", PNAS 96, 1999). It
// accounts for strands that pass each other and for tight bends. The curve is sampled: the result is an upper
// bound, within about 1 %.
double max_tube_radius(const TorusKnotShape& knot);

}  // namespace buoyancy
