// `improved`: the paper's improved approximate algorithm (section 4.2).
//
// Volume elements of the wholly wet triangles about an apex on the water, the projection of the volume's
// centroid: the surface that closes the wet part then contributes nothing, and only the cut triangles are
// missing. Published error: that of the cut triangles' wet parts, shrinking as the mesh is refined.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// O(vertices + triangles); no heap once the thread has seen a mesh as large (wetted_surface.h).
Displacement improved(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
