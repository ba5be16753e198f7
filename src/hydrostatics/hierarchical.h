// `hierarchical`: exact to rounding, at the cost of the waterline instead of the mesh.
//
// A descent of the moment tree (moment_tree.h): a wholly wet node adds its surface moments, a dry one
// nothing, and the triangles of the leaves that the water crosses are clipped, many at a time. All is
// integrated with one component n_a of the normal, along B's axis nearest to up (docs/mathematics.md, "One
// axis is enough"):
//   int z n_a dA = k_a V,  int z y_j n_a dA = k_a M_j for j other than a,  int z^2 n_a dA = 2 k_a H,
//   k . M = H - z_c V,  F/(rho g) = V k,  torque_c/(rho g) = M x k,   z = k . y + z_c,  z_c = -h_c.
// A body above the water or below it is answered from its bounds and its constants.
//
// Error: within G_V and G_V L_r (HydrostaticMesh::volume_tolerance) at every depth. A leaf's heights are
// rounded relative to the leaf's size, its centre's height being taken from an exact product: a cap of 1e-6
// V_T keeps 9 digits. Complexity: O(triangles the water cuts + log n); no heap.
//
// With a tolerance the descent stops where what is undecided cannot change volume by more than tolerance V_T,
// or torque/(rho g) by more than that times L_r (pruned_node.h); the bound that was reached is in the
// answer. The cost then follows the tolerance, and n hardly.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// mesh: with its tree. tolerance: 0 (exact) or more, relative to the whole displacement; below the mesh's
// max_rounding_bound() / V_T it is as 0.
Displacement hierarchical(const HydrostaticMesh& mesh, const WaterPlane& plane, double tolerance = 0.0);

// m: how far the plane's heights over the body may be off (WaterPlane::error) so that this costs a hundredth
// of the tolerance at most; 0 where it has to be exact. It is counted in the bound.
double allowed_plane_error(const HydrostaticMesh& mesh, double tolerance);

}  // namespace buoyancy
