// Volume, centroid and inertia of the solid that a closed mesh encloses, for uniform density 1 kg/m^3.
//
// The integrals of 1, x and x x^T over the volume follow from the divergence theorem. They are exact per
// triangle, taken about the centre of the bounding box and summed in blocks (pairwise_sum.h).
#pragma once

#include "geometry/triangle_mesh.h"

namespace buoyancy {

struct MassProperties {
  double volume = 0.0;             // [m^3], signed
  Vec3 centroid_B = Vec3::Zero();  // [m]; the bounding box's centre if the volume is 0
  Mat3 inertia_B =
      Mat3::Zero();  // [m^5], about the centroid, axes of B; times the density [kg/m^3]: [kg m^2]
};

MassProperties mass_properties(const TriangleMesh& mesh);

}  // namespace buoyancy
