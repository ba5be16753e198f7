// `fast`: the paper's fast approximate algorithm (section 4.1).
//
// At construction the signed volume V_i and the centroid C_i of the tetrahedron of every triangle and B's
// origin are computed once. A query adds those of the wholly wet triangles:
//   V = sum V_i,  moment = sum V_i C_i,  F = rho g V up,  torque = moment x F / V  (never divided by V).
// Published error: the water's surface is not closed (section 4.2), so the error does not shrink when the
// mesh is refined; it depends on how far B's origin lies from the water.
#pragma once

#include <vector>

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

class FastTable {
 public:
  explicit FastTable(const HydrostaticMesh& mesh);

  // mesh: the one the table was made from. O(vertices + triangles), no heap.
  Displacement displacement(const HydrostaticMesh& mesh, const WaterPlane& plane) const;

 private:
  struct Element {
    double volume;  // m^3: V_i about B's origin
    Vec3 moment;    // m^4: V_i (C_i - c)
  };
  std::vector<Element> elements_;  // one per triangle
};

}  // namespace buoyancy
