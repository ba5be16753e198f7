// `exact`: the paper's exact algorithm (section 4.3).
//
// `improved`, and the wet parts of the triangles that the water cuts. Exact to rounding in volume, centre,
// force and torque for every closed mesh: within G_V = eps (64 V_T + L A_s) and G_V L (HydrostaticMesh),
// times 1 + depth/L for bodies deeper than L, whose apex lies that far away.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// O(vertices + triangles); no heap once the thread has seen a mesh as large (wetted_surface.h).
Displacement exact(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
