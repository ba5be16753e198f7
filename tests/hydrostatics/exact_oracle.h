// The exact oracle: a body's displacement in any number type, rational arithmetic (rational.h) above all.
//
// Everything is taken from the definition: the pose's rotation is R(q)/|q|^2, rational in the quaternion's
// components; the wet part of every triangle comes from the same clip as the product's (triangle_clip.h),
// then volume and first moment are the sums of the tetrahedra over an apex on the water. In rationals nothing
// is rounded, so that a double result minus this one is the double's true error. In long double the terms are
// summed in blocks, so that 1,000,000 triangles cost no digits that count.
#pragma once

#include <vector>

#include "geometry/pairwise_sum.h"
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

  std::vector<Corner<T>> corners;
  corners.reserve(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3T<T> x = mesh.vertex(static_cast<std::int32_t>(i)).template cast<T>();
    corners.push_back({Point<T>::from(x), T(k.dot(x) - h)});
  }
  struct Term {
    T volume6{};
    Point<T> moment24{};  // about the apex

    Term& operator+=(const Term& other) {
      volume6 += other.volume6;
      moment24 += other.moment24;
      return *this;
    }
  };
  PairwiseSum<Term> sum;
  const auto add = [&](const Corner<T>& a, const Corner<T>& b, const Corner<T>& c) {
    const Point<T> p = a.y - apex;
    const Point<T> q = b.y - apex;
    const Point<T> r = c.y - apex;
    const T v6 = dot(p, cross(q, r));
    sum.add({v6, v6 * (p + q + r)});
  };
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t n) -> const Corner<T>& {
      return corners[static_cast<std::size_t>(triangle[n])];
    };
    const int wet = int(corner(0).wet()) + int(corner(1).wet()) + int(corner(2).wet());
    if (wet == 3) {
      add(corner(0), corner(1), corner(2));
    } else if (wet != 0) {
      visit_wet_part(corner(0), corner(1), corner(2), add);
    }
  }
  const Term total = sum.total();
  result.volume = total.volume6 / T(6);
  result.moment = total.moment24.vec3() / T(24) + apex_B * result.volume;
  return result;
}

}  // namespace buoyancy
