// Pressure on the wetted surface, exact per triangle: the paper's surface-based methods (section 4.4).
//
// With z the signed height, linear over a triangle of oriented area A n,
//   F/(rho g)   = int z n dA       = A n (z_a + z_b + z_c) / 3
//   tau/(rho g) = int z y x n dA   = (sum z sum y + sum z_i y_i) A/12 x n
//   H           = int z dV         = 1/2 int z^2 k . n dA   over the wetted surface
// (the water surface, which closes it, contributes 0 since z = 0 there).
// The paper takes centroid times force for the torque; pressure varies over the triangle, and on coarse
// meshes that reverses the sign of the restoring moment, so the integral is taken instead.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

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

  void add(const ClipVertex<double>& a, const ClipVertex<double>& b, const ClipVertex<double>& c,
           const Point<double>& up_B) {
    const Point<double> twice_area = cross(b.y - a.y, c.y - a.y);
    const double z_sum = a.z + b.z + c.z;
    const Point<double> force = z_sum * twice_area;
    // sum z sum y + sum z_i y_i
    const Point<double> zy = (z_sum + a.z) * a.y + (z_sum + b.z) * b.y + (z_sum + c.z) * c.y;
    // 1/2 ((sum z)^2 + sum z_i^2) = sum of squares and products
    const double zz = a.z * a.z + b.z * b.z + c.z * c.z + a.z * b.z + b.z * c.z + c.z * a.z;
    force6 += force;
    torque24 += cross(zy, twice_area);
    z_squared12 += zz * dot(up_B, twice_area);
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
