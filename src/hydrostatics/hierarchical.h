// `hierarchical`: exact to rounding, with a cost that follows the waterline instead of the mesh.
//
// A descent of the moment tree (moment_tree.h): a fully submerged node adds its surface moments, a dry node
// adds nothing, and the triangles of the leaves that cross the water are clipped, many at a time. All
// integrals use one component n_a of the normal, along B's axis nearest to up (docs/mathematics.md, "One axis
// is enough"):
//   int z n_a dA = k_a V,  int z y_j n_a dA = k_a M_j for j other than a,  int z^2 n_a dA = 2 k_a H,
//   k . M = H - z_c V,  F/(rho g) = V k,  torque_c/(rho g) = M x k,   z = k . y + z_c,  z_c = -h_c.
// A dry or fully submerged body is evaluated from its bounds and its constants.
//
// Error: within G_V and G_V L_r (HydrostaticMesh::volume_tolerance) at every depth. A leaf's heights are
// rounded relative to the leaf's size, because the height of its centre comes from an exact product: a cap of
// 1e-6 V_T keeps 9 digits. Complexity: O(triangles that the water cuts + log n). Heap: see Solver.
//
// With a tolerance the descent stops as soon as the pruned nodes cannot change volume by more than
// tolerance V_T, or torque/(rho g) by more than that times L_r (pruned_node.h); the result holds the bound
// that was reached. The cost then depends on the tolerance and hardly on n.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// mesh: with its tree. tolerance: 0 (exact) or more, relative to the whole displacement; a tolerance below
// the mesh's max_rounding_bound() / V_T has the effect of 0.
Displacement hierarchical(const HydrostaticMesh& mesh, const WaterPlane& plane, double tolerance = 0.0);

// [m], the largest error of the plane's heights over the body (WaterPlane::error) that costs at most a
// hundredth of the tolerance; 0 where the plane has to be exact. The published bound includes it.
double allowed_plane_error(const HydrostaticMesh& mesh, double tolerance);

}  // namespace buoyancy
