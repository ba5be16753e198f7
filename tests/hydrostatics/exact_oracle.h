// The exact oracle: a body's displacement in any number type, rational arithmetic (rational.h) above all.
//
// Everything is taken from the definition: the pose's rotation is R(q)/|q|^2, rational in the quaternion's
// components; the wet part of every triangle comes from the same clip as the product's (triangle_clip.h),
// then volume and first moment are the sums of the tetrahedra over an apex on the water. In rationals nothing
// is rounded, so that a double result minus this one is the double's true error.
#pragma once

#include "geometry/triangle_mesh.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

template <typename T>
struct ExactDisplacement {
  T volume;         // m^3
  Vec3T<T> moment;  // m^4, B: integral of x_B over the displaced volume
  Vec3T<T> up_B;    // k

  // torque/(rho g) about a point of B, in B: (moment - V r) x k
  Vec3T<T> torque(const Vec3& reference_B) const {
    return (moment - volume * reference_B.template cast<T>()).cross(up_B);
  }
};

template <typename T>
Vec3T<T> exact_up_in_body(const Pose& pose, const Water& water) {
  const T w(pose.q_WB.w());
  const Vec3T<T> u = pose.q_WB.vec().template cast<T>();
  const Vec3T<T> up = water.up_W.template cast<T>();
  const T uu = u.dot(u);
  const Vec3T<T> turned = up * T(w * w - uu) + u * T(T(2) * u.dot(up)) - u.cross(up) * T(T(2) * w);
  return turned / T(w * w + uu);
}

template <typename T>
ExactDisplacement<T> exact_displacement(const TriangleMesh& mesh, const Pose& pose, const Water& water) {
  ExactDisplacement<T> result;
  result.up_B = exact_up_in_body<T>(pose, water);
  const Vec3T<T> k = result.up_B;
  const T h = T(water.level) - water.up_W.template cast<T>().dot(pose.p_WB.template cast<T>());
  const Vec3T<T> apex_B = k * T(h / k.dot(k));
  const auto apex = Point<T>::from(apex_B);

  const auto corner = [&](std::int32_t i) {
    const Vec3T<T> x = mesh.vertex(i).template cast<T>();
    return Corner<T>{Point<T>::from(x), T(k.dot(x) - h)};
  };
  T volume6(0);
  Point<T> moment24{T(0), T(0), T(0)};  // about the apex
  const auto add = [&](const Corner<T>& a, const Corner<T>& b, const Corner<T>& c) {
    const Point<T> p = a.y - apex;
    const Point<T> q = b.y - apex;
    const Point<T> r = c.y - apex;
    const T v6 = dot(p, cross(q, r));
    volume6 += v6;
    moment24 += v6 * (p + q + r);
  };
  for (const Triangle& triangle : mesh.triangles) {
    const Corner<T> a = corner(triangle[0]);
    const Corner<T> b = corner(triangle[1]);
    const Corner<T> c = corner(triangle[2]);
    const int wet = int(a.wet()) + int(b.wet()) + int(c.wet());
    if (wet == 3) {
      add(a, b, c);
    } else if (wet != 0) {
      visit_wet_part(a, b, c, add);
    }
  }
  result.volume = volume6 / T(6);
  result.moment = moment24.vec3() / T(24) + apex_B * result.volume;
  return result;
}

}  // namespace buoyancy
