// Gives flat polygons that are stored twice the same triangles, so that these can be recognised as
// duplicates.
#pragma once

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Patches are faces connected through edges of exactly two faces. All flat patches with the same rim get the
// triangles of the first one, reversed where their rim runs the other way round. Only patches whose rim edges
// all have three faces or more take part, as those of a polygon that is stored twice. A patch is flat if it
// lies within the tolerance [m] of a plane. Returns a bound on the volume that this changes [m^3].
// Complexity: O(n log n).
double unify_coincident_patches(TriangleMesh& mesh, double tolerance);

}  // namespace buoyancy
