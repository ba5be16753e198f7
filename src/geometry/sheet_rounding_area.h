// The effective surface area of a mesh in the rounding tolerance of validation (mesh_checks.h).
//
// A face's area is a difference of products of its edges' coordinates. Each product has a rounding error of
// epsilon times the product, however small the difference. For a face about as wide as it is long this error
// is epsilon times its area; for a needle across the axes the area is far smaller than the products. A volume
// summed over a mesh of diagonal L is therefore accurate to about epsilon L times the sum of max(area,
// longest edge^2 / 4) over its faces, which is the mesh's area if no face is thinner than 1 : 2.
//
// HydrostaticMesh::rounding_area, A_r, serves the published error bounds and differs: its faces start at the
// common corner of their two shorter edges, so only the product of these edges counts. Validation takes the
// corners in the order of the input, where the products may be those of the longest edge.
#pragma once

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Returns the sum of max(area, longest edge^2 / 4) over the faces [m^2]. Complexity: O(faces).
double sheet_rounding_area(const TriangleMesh& mesh);

}  // namespace buoyancy
