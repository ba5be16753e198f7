// One generator per shape, for make_shape and check_shape (shapes.h) and nobody else. Each takes a checked
// shape and returns a mesh without unused vertices, outward oriented, each edge used once each way: vertices
// are shared by construction, by index, never by comparing positions.
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

// The largest radius, m, of a smooth tube around the knot's curve that does not touch itself: the least
// radius of all circles that touch the curve at one point and pass through another (O. Gonzalez, J. H.
// Maddocks, "Global curvature, thickness, and the ideal shapes of knots", PNAS 96, 1999), which covers both
// strands that pass each other and bends that are too tight. Sampled: an upper bound, within about 1 %.
double largest_tube(const TorusKnotShape& knot);

}  // namespace buoyancy
