// Reference implementation of the wetted surface's moments: it adds every triangle one by one, in any number
// type. It is the oracle of the tree's descent and the kernel that dual numbers differentiate.
//
// The library buoyancy_oracle holds the instantiations for Rational and Dual.
#pragma once

#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"
#include "hydrostatics/displacement_moments.h"
#include "tests/truth/dual.h"
#include "tests/truth/rational.h"

namespace buoyancy {

// up: k. h: [m], height of the water plane along k over the origin of the mesh's coordinates.
template <typename T>
SurfaceMoments<T> wetted_moments_reference(const TriangleMesh& mesh, const Vec3T<T>& up, const T& h);

extern template struct DisplacementMoments<Rational>;
extern template DisplacementMoments<Rational> displacement_moments<Rational>(const SurfaceMoments<Rational>&,
                                                                             const Rational&,
                                                                             const Vec3T<Rational>&);
extern template DisplacementMoments<Dual> displacement_moments<Dual>(const SurfaceMoments<Dual>&, const Dual&,
                                                                     const Vec3T<Dual>&);

}  // namespace buoyancy
