// Internal to prepared_mesh.cpp: moves the vertices of a mesh to the frame of a body.
#pragma once

#include "geometry/triangle_mesh.h"
#include "scene/prepared_mesh.h"

namespace buoyancy {

// Computed in double-double and rounded once: a mesh far from its own origin that is turned back to its body
// loses no digits.
void place(TriangleMesh& mesh, const MeshPlacement& placement);

}  // namespace buoyancy
