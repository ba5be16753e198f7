// Signed volume elements of the paper, section 3: a triangle and an apex o span a tetrahedron of volume
//   V_i(o) = (a - o) . ((b - a) x (c - a)) / 6   and centroid   C_i(o) = (a + b + c + o) / 4.
//
// The edges, not the corners, are multiplied: the value equals the paper's triple product, but its rounding
// error is of the order eps L dA instead of eps L^3 per triangle.
#pragma once

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/point.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// 6 V_i(o), [m^3].
inline double six_volumes(const Point<double>& a, const Point<double>& b, const Point<double>& c,
                          const Point<double>& apex) {
  return dot(a - apex, cross(b - a, c - a));
}

// Sums over triangles, for one apex o.
struct VolumeElements {
  double volume6 = 0.0;            // [m^3], 6 sum V_i(o)
  Point<double> moment6{0, 0, 0};  // [m^4], 6 sum V_i(o) (a + b + c)

  VolumeElements& operator+=(const VolumeElements& other) {
    volume6 += other.volume6;
    moment6 += other.moment6;
    return *this;
  }

  void add(const Point<double>& a, const Point<double>& b, const Point<double>& c,
           const Point<double>& apex) {
    const double v6 = six_volumes(a, b, c, apex);
    volume6 += v6;
    moment6 += v6 * (a + b + c);
  }

  double volume() const { return volume6 / 6.0; }
  // sum V_i C_i: the first moment of the enclosed volume about the origin of the corners' coordinates.
  Vec3 moment(const Vec3& apex) const { return (moment6.vec3() + volume6 * apex) / 24.0; }
};

// [m], the apex of `improved` and `exact` about c: the volume's centroid projected onto the water, so that
// the water surface, which closes the submerged part, contributes nothing (section 4.2). Where overlapping
// parts of opposite signs put the centroid outside of the mesh's box, the box's centre replaces it: any point
// of the water plane is valid, and the torque's rounding error grows with the square of its distance.
inline Vec3 apex_on_water(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const bool inside = (mesh.centroid.array() >= mesh.box_min.array()).all() &&
                      (mesh.centroid.array() <= mesh.box_max.array()).all();
  const Vec3 from = inside ? mesh.centroid : Vec3(0.5 * (mesh.box_min + mesh.box_max));
  return from - plane.height(from) * plane.up_B;
}

// Displacement of a volume V with first moment M about c; the wrench follows from Archimedes' principle: F =
// V k at the centroid.
inline Displacement displacement_of_volume(double volume, const Vec3& moment, const WaterPlane& plane) {
  return {
      .volume = volume, .moment = moment, .force = volume * plane.up_B, .torque = moment.cross(plane.up_B)};
}

}  // namespace buoyancy
