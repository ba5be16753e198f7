// The exact oracle: a body's displacement in any number type, mainly in rational arithmetic (rational.h).
//
// It follows the definition: the pose's rotation is R(q)/|q|^2, rational in the quaternion's components; the
// wet part of every triangle comes from the same clip as the product's (triangle_clip.h); volume and first
// moment are the sums of the tetrahedra about an apex on the water. Rationals round nothing, so that a double
// result minus this one is the double's true error. Balls (ball.h) enclose the truth, thousands of times
// faster. With long double the terms are summed in blocks, so that 1,000,000 triangles cost no significant
// digits.
//
// This header declares; exact_oracle-inl.h defines. The library buoyancy_oracle holds the instantiations for
// Rational, Ball and long double, so that sources that include this header need not instantiate them.
#pragma once

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

template <typename T>
struct ExactDisplacement {
  T volume;           // [m^3]
  Vec3T<T> moment;    // [m^4], B axes: integral of x_B over the displaced volume
  Vec3T<T> up_B;      // k
  Vec3 o_B;           // [m], a point of the mesh
  Vec3T<T> moment_o;  // [m^4], the moment about o, for number types that lose digits with a far origin

  // torque/(rho g) about a point of B, in B: (moment_o + V (o - r)) x k
  Vec3T<T> torque(const Vec3& reference_B) const;
};

// Rotates a vector from B to W.
template <typename T>
Vec3T<T> exactly_in_world(const Pose& pose, const Vec3T<T>& v_B);

// The water plane in B, about a point o of B: k . (x_B - o) = h.
template <typename T>
struct ExactPlane {
  Vec3T<T> up_B;
  T h;
};

template <typename T>
ExactPlane<T> exact_plane(const Pose& pose, const Water& water, const Vec3& o_B = Vec3::Zero());

template <typename T>
ExactDisplacement<T> exact_displacement(const TriangleMesh& mesh, const Pose& pose, const Water& water);

}  // namespace buoyancy
