// The five methods of "Approximate and exact buoyancy calculation for real-time floating simulation of
// meshes", section 4, as published. `hierarchical` (hierarchical.h) is compared with them. Each has a source
// file of its own.
//
// Contract of all five: `meshlets` were made from the mesh's surface (build_meshlets()); mesh coordinates and
// water plane are about the mesh's centre c (water_plane_in_body()); a triangle is fully submerged if its
// three vertices have z < 0. Heights are plain dot products. The results are the same bits on every
// instruction set. Complexity: O(vertices + triangles) per query; no heap. Error bounds: docs/mathematics.md,
// "Error bounds".
#pragma once

#include <array>
#include <vector>

#include "geometry/meshlets.h"
#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// `fast` (section 4.1): precomputed volume elements of the fully submerged triangles.
//
// The constructor computes the signed volume V_i and the centroid C_i of the tetrahedron that every triangle
// spans with B's origin. A query adds those of the fully submerged triangles:
//   V = sum V_i,  moment = sum V_i C_i,  F = rho g V up,  torque = moment x F / V  (never divided by V).
// Published error: the water surface is not closed (section 4.2), so the error does not shrink when the mesh
// is refined; it depends on how far B's origin lies from the water.
class FastTable {
 public:
  FastTable(const HydrostaticMesh& mesh, const Meshlets& meshlets);

  // mesh, meshlets: those that the table was made from.
  Displacement displacement(const HydrostaticMesh& mesh, const Meshlets& meshlets,
                            const WaterPlane& plane) const;

 private:
  // V_i about B's origin [m^3] and V_i (C_i - c) [m^4], one per triangle of the meshlets' groups
  std::vector<std::array<double, 4>> elements_;
};

// `improved` (section 4.2): volume elements of the fully submerged triangles about an apex on the water
// plane, the projection of the volume's centroid.
//
// The surface that closes the submerged part then contributes nothing, and only the cut triangles are
// missing. Published error: that of the cut triangles' wet parts; it shrinks as the mesh is refined.
Displacement improved(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane);

// `exact` (section 4.3): `improved`, and the wet parts of the triangles that the water cuts.
//
// Exact to rounding in volume, centre, force and torque for every closed mesh: within
// G_V = eps (64 V_T + L A_s) and G_V L (HydrostaticMesh), times 1 + depth/L for bodies deeper than L, whose
// apex lies that far away.
Displacement exact(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane);

// `fast_surface` (section 4.4): pressure on the fully submerged triangles.
//
// No closing surface is needed. The pressure on the wet parts of the cut triangles is missing; it is small
// because they lie near the water surface, so the error shrinks as the mesh is refined. Force and torque are
// published as computed, with the horizontal part that the missing triangles leave.
Displacement fast_surface(const Meshlets& meshlets, const WaterPlane& plane);

// `exact_surface` (section 4.4): `fast_surface`, and the wet parts of the triangles that the water cuts, that
// is, pressure on the whole wetted surface.
//
// Exact to rounding in volume, centre, force and torque, within the same bounds as `exact`; the moment is
// integrated per triangle, not taken at its centroid.
Displacement exact_surface(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane);

}  // namespace buoyancy
