// `exact_surface`: the paper's exact surface-based algorithm (section 4.4): pressure on the whole wet
// surface.
//
// `fast_surface`, and the wet parts of the triangles that the water cuts. Exact to rounding in volume,
// centre, force and torque, within the same bounds as `exact`; the moment is integrated per triangle, not
// taken at its centroid.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// O(vertices + triangles); no heap once the thread has seen a mesh as large (wetted_surface.h).
Displacement exact_surface(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
