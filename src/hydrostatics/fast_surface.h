// `fast_surface`: the paper's surface-based approximation (section 4.4): pressure on the wholly wet
// triangles.
//
// No closing surface is needed. What is missing is the pressure on the wet parts of the cut triangles, near
// the surface, where it is small: the error shrinks as the mesh is refined. Force and torque are published as
// computed, with the horizontal part that the missing triangles leave.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// O(vertices + triangles); no heap once the thread has seen a mesh as large (wetted_surface.h).
Displacement fast_surface(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
