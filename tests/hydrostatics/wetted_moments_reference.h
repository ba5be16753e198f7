// The wet surface's moments by the plainest way, every triangle one by one, in any number type: the oracle of
// the tree's descent, and what dual numbers go through.
//
// The library buoyancy_oracle holds the functions for Rational and Dual.
#pragma once

#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"
#include "hydrostatics/displacement_moments.h"
#include "tests/hydrostatics/dual.h"
#include "tests/hydrostatics/rational.h"

namespace buoyancy {

// up: k; h: height of the surface over the origin that the mesh's vertices are measured from, along k.
template <typename T>
SurfaceMoments<T> wetted_moments_reference(const TriangleMesh& mesh, const Vec3T<T>& up, const T& h);

extern template struct DisplacementMoments<Rational>;
extern template DisplacementMoments<Rational> displacement_moments<Rational>(const SurfaceMoments<Rational>&,
                                                                             const Rational&,
                                                                             const Vec3T<Rational>&);
extern template DisplacementMoments<Dual> displacement_moments<Dual>(const SurfaceMoments<Dual>&, const Dual&,
                                                                     const Vec3T<Dual>&);

}  // namespace buoyancy
