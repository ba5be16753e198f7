// Signed volume elements of the paper, section 3: a triangle and an apex o span a tetrahedron of volume
//   V_i(o) = (a - o) . ((b - a) x (c - a)) / 6   and centroid   C_i(o) = (a + b + c + o) / 4.
//
// The edges, not the corners, are multiplied: the same number as the paper's triple product, but its rounding
// error is of the order eps L dA instead of eps L^3 per triangle.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// Sums about an apex o, positions relative to o.
struct VolumeElements {
  double volume6 = 0.0;          // m^3: 6 sum V_i
  Vec3 moment24 = Vec3::Zero();  // m^4: 24 sum V_i (C_i - o)

  VolumeElements& operator+=(const VolumeElements& other) {
    volume6 += other.volume6;
    moment24 += other.moment24;
    return *this;
  }

  // Corners relative to o.
  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double v6 = a.dot((b - a).cross(c - a));
    volume6 += v6;
    moment24 += v6 * (a + b + c);
  }
};

// The apex of `improved` and `exact`: the volume's centroid projected onto the water, so that the water's
// surface, which closes the wet part, contributes nothing (section 4.2). About c, m.
inline Vec3 apex_on_water(const Vec3& centroid, const WaterPlane& plane) {
  return centroid - plane.height(centroid) * plane.up_B;
}

// Displacement of a volume V with first moment M about c; the wrench is Archimedes': F = V k at the centroid.
inline Displacement displacement_of_volume(double volume, const Vec3& moment, const WaterPlane& plane) {
  return {volume, moment, volume * plane.up_B, moment.cross(plane.up_B)};
}

// From sums about the apex to the displacement about c.
inline Displacement displacement_about_apex(const VolumeElements& sum, const Vec3& apex,
                                            const WaterPlane& plane) {
  const double volume = sum.volume6 / 6.0;
  return displacement_of_volume(volume, sum.moment24 / 24.0 + volume * apex, plane);
}

}  // namespace buoyancy
