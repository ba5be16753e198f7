// The area that rounding takes its share of.
//
// A face's area is a difference of products of its edges' coordinates: each is rounded by epsilon times the
// product, whatever is left of their difference. For a face about as wide as it is long that is epsilon times
// its area; for a needle across the axes its area is next to nothing beside the products. So a volume summed
// over a mesh of diagonal L is known to some epsilon L times the sum of max(area, longest edge^2 / 4) over
// its faces, which is the mesh's area where no face is thinner than 1 : 2.
#pragma once

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// m^2. O(faces).
double rounding_area(const TriangleMesh& mesh);

}  // namespace buoyancy
