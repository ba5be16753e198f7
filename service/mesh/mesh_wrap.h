// A closed surface around a mesh, for meshes that no repair can close: parts that do not meet, faces that
// cross.
#pragma once

#include "base/error.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy::service {

// Returns the outer surface of all points within gap / 2 of the mesh, moved back by gap / 2 (OpenVDB, on a
// grid of gap / 3): gaps up to `gap` [m] wide are closed, edges are rounded by about a grid cell, and sheets
// that enclose nothing vanish. All faces are new. mesh: at least one triangle. Errors: a program that was
// built without OpenVDB; a gap that is too small for the mesh's size (more than 1,500 cells along its
// diagonal); a mesh of which nothing is left. Complexity: proportional to the area over (gap / 3)^2, some
// seconds and 1 GB at most.
Expected<TriangleMesh> wrap_mesh(const TriangleMesh& mesh, double gap);

}  // namespace buoyancy::service
