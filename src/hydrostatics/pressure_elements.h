// Pressure on the wetted surface, exact per triangle: the paper's surface-based methods (section 4.4).
//
// With z the signed height, linear over a triangle of oriented area A n,
//   F/(rho g)   = int z n dA       = A n (z_a + z_b + z_c) / 3
//   tau/(rho g) = int z y x n dA   = (sum z sum y + sum z_i y_i) A/12 x n
//   H           = int z dV         = 1/2 int z^2 k . n dA   over the wetted surface
// The water surface, which closes the wetted surface, contributes 0 since z = 0 there.
// The paper takes centroid times force for the torque; pressure varies over the triangle, and on coarse
// meshes that reverses the sign of the restoring moment, so the integral is taken instead.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/point.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// Sums over triangles; the kernels of meshlet_kernels-inl.h add to them.
struct PressureElements {
  Point<double> force6{0, 0, 0};    // [m^3], 6 F/(rho g)
  Point<double> torque24{0, 0, 0};  // [m^4], 24 tau_c/(rho g)
  double z_squared12 = 0.0;         // [m^4], 12 int z^2 k . n dA = 24 H

  PressureElements& operator+=(const PressureElements& other) {
    force6 += other.force6;
    torque24 += other.torque24;
    z_squared12 += other.z_squared12;
    return *this;
  }

  // Volume and centre of buoyancy follow from the pressure: V = k . F, the horizontal part of V (c_B - c)
  // from the torque, its vertical part from H.
  Displacement displacement(const WaterPlane& plane) const {
    Displacement result;
    result.force = force6.vec3() / 6.0;
    result.torque = torque24.vec3() / 24.0;
    result.volume = plane.up_B.dot(result.force);
    result.moment =
        plane.up_B.cross(result.torque) + (z_squared12 / 24.0 + plane.h_c * result.volume) * plane.up_B;
    return result;
  }
};

}  // namespace buoyancy
