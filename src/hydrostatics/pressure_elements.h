// Pressure on the wet surface, exact per triangle: the paper's surface-based methods (section 4.4).
//
// With z the signed height, linear over a triangle of oriented area A n,
//   F/(rho g)   = int z n dA       = A n (z_a + z_b + z_c) / 3
//   tau/(rho g) = int z y x n dA   = (sum z sum y + sum z_i y_i) A/12 x n
//   H           = int z dV         = 1/2 int z^2 k . n dA over the wet surface (z = 0 on the water closes
//   it).
// The paper takes centroid times force for the torque; pressure varies over the triangle, and on coarse
// meshes that turns the restoring moment's sign, so the integral is taken instead.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct PressureElements {
  Vec3 force6 = Vec3::Zero();    // m^3: 6 F/(rho g)
  Vec3 torque24 = Vec3::Zero();  // m^4: 24 tau_c/(rho g)
  double height24 = 0.0;         // m^4: 24 H

  PressureElements& operator+=(const PressureElements& other) {
    force6 += other.force6;
    torque24 += other.torque24;
    height24 += other.height24;
    return *this;
  }

  void add(const Corner<double>& a, const Corner<double>& b, const Corner<double>& c, const Vec3& up_B) {
    const Vec3 twice_area = (b.y - a.y).cross(c.y - a.y);
    const double z_sum = a.z + b.z + c.z;
    const Vec3 zy = z_sum * (a.y + b.y + c.y) + a.z * a.y + b.z * b.y + c.z * c.y;
    const double zz = z_sum * z_sum + a.z * a.z + b.z * b.z + c.z * c.z;  // 2 (sum of squares and products)
    force6 += z_sum * twice_area;
    torque24 += zy.cross(twice_area);
    height24 += 0.5 * zz * up_B.dot(twice_area);
  }

  // Volume and centre of buoyancy as the pressure implies them: V = k . F, horizontal part of V (c_B - c)
  // from the torque, vertical part from H.
  Displacement displacement(const WaterPlane& plane) const {
    Displacement result;
    result.force = force6 / 6.0;
    result.torque = torque24 / 24.0;
    result.volume = plane.up_B.dot(result.force);
    result.moment =
        plane.up_B.cross(result.torque) + (height24 / 24.0 + plane.h_c * result.volume) * plane.up_B;
    return result;
  }
};

}  // namespace buoyancy
