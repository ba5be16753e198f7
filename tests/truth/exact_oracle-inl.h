// Definitions of the exact oracle's functions (exact_oracle.h), for sources that instantiate them with their
// own number type.
#pragma once

#include <vector>

#include "geometry/pairwise_sum.h"
#include "hydrostatics/triangle_clip.h"
#include "tests/truth/exact_oracle.h"

namespace buoyancy {

template <typename T>
Vec3T<T> ExactDisplacement<T>::torque(const Vec3& reference_B) const {
  const Vec3T<T> lever = o_B.template cast<T>() - reference_B.template cast<T>();
  return (moment_o + lever * volume).cross(up_B);
}

// R(q) v / |q|^2 with q = (w, u), or its inverse with u negated.
template <typename T>
Vec3T<T> exactly_rotated(const T& w, const Vec3T<T>& u, const Vec3T<T>& v) {
  const T uu = u.dot(u);
  const Vec3T<T> turned = v * T(w * w - uu) + u * T(T(2) * u.dot(v)) + u.cross(v) * T(T(2) * w);
  return turned / T(w * w + uu);
}

template <typename T>
Vec3T<T> exactly_in_world(const Pose& pose, const Vec3T<T>& v_B) {
  return exactly_rotated<T>(T(pose.q_WB.w()), pose.q_WB.vec().template cast<T>(), v_B);
}

template <typename T>
ExactPlane<T> exact_plane(const Pose& pose, const Water& water, const Vec3& o_B) {
  const Vec3T<T> up = water.up_W.template cast<T>();
  const Vec3T<T> back = Vec3(-pose.q_WB.vec()).template cast<T>();
  const Vec3T<T> k = exactly_rotated<T>(T(pose.q_WB.w()), back, up);
  return {k, T(water.level) - up.dot(pose.p_WB.template cast<T>()) - k.dot(o_B.template cast<T>())};
}

// Customization point for number types that may not determine a height's sign.
template <typename T>
class SettledHeights {
 public:
  SettledHeights(const TriangleMesh& /*mesh*/, const Pose& /*pose*/, const Water& /*water*/) {}
  const T& settled(std::size_t /*vertex*/, const T& height) { return height; }
};

template <typename T>
ExactDisplacement<T> exact_displacement(const TriangleMesh& mesh, const Pose& pose, const Water& water) {
  ExactDisplacement<T> result;
  const Vec3 o_B = mesh.vertex(0);
  result.o_B = o_B;
  const auto [k, h] = exact_plane<T>(pose, water, o_B);
  result.up_B = k;
  const Vec3T<T> apex_o = k * T(h / k.dot(k));
  const auto apex = Point<T>::from(apex_o);

  SettledHeights<T> heights(mesh, pose, water);
  std::vector<ClipVertex<T>> corners;
  corners.reserve(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3T<T> y = mesh.vertex(static_cast<std::int32_t>(i)).template cast<T>() - o_B.template cast<T>();
    corners.push_back({Point<T>::from(y), heights.settled(i, T(k.dot(y) - h))});
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
  const auto add = [&](const ClipVertex<T>& a, const ClipVertex<T>& b, const ClipVertex<T>& c) {
    const Point<T> p = a.y - apex;
    const Point<T> q = b.y - apex;
    const Point<T> r = c.y - apex;
    // A product of edges, so that rounding errors are relative to the triangle.
    const T v6 = dot(p, cross(b.y - a.y, c.y - a.y));
    sum.add({v6, v6 * (p + q + r)});
  };
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t n) -> const ClipVertex<T>& {
      return corners[static_cast<std::size_t>(triangle[n])];
    };
    const int wet = int(corner(0).wet()) + int(corner(1).wet()) + int(corner(2).wet());
    if (wet == 3) {
      add(corner(0), corner(1), corner(2));
    } else if (wet != 0) {
      for_each_wet_triangle(corner(0), corner(1), corner(2), add);
    }
  }
  const Term total = sum.total();
  result.volume = total.volume6 / T(6);
  result.moment_o = total.moment24.vec3() / T(24) + apex_o * result.volume;
  result.moment = result.moment_o + o_B.template cast<T>() * result.volume;
  return result;
}

}  // namespace buoyancy
