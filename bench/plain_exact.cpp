#include "plain_exact.h"

#include <array>

namespace buoyancy::bench {

PlainExact::PlainExact(const TriangleMesh& mesh)
    : triangles_(&mesh.triangles), vertices_(mesh.vertex_count()) {
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i)
    vertices_B_.push_back({mesh.x[i], mesh.y[i], mesh.z[i]});
}

PlainWrench PlainExact::operator()(const Pose& pose, const Water& water, const Vec3& reference_B) {
  using P = Point<double>;
  const Mat3 R = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 apex_W(pose.p_WB.x(), pose.p_WB.y(), water.level);
  const double height = pose.p_WB.z() - water.level;
  // World axes about the apex, which is on the water: z is the height, and a tetrahedron needs no apex.
  for (std::size_t i = 0; i < vertices_B_.size(); ++i) {
    const P& v = vertices_B_[i];
    vertices_[i] = {R(0, 0) * v.x + R(0, 1) * v.y + R(0, 2) * v.z,
                    R(1, 0) * v.x + R(1, 1) * v.y + R(1, 2) * v.z,
                    R(2, 0) * v.x + R(2, 1) * v.y + R(2, 2) * v.z + height};
  }

  double volume6 = 0.0;
  P moment24{0, 0, 0};
  const auto add = [&](const P& a, const P& b, const P& c) {
    const double v6 = dot(a, cross(b, c));
    volume6 += v6;
    moment24 += v6 * (a + b + c);
  };
  const auto cut = [](const P& wet, const P& dry) { return wet + (wet.z / (wet.z - dry.z)) * (dry - wet); };
  for (const Triangle& triangle : *triangles_) {
    const P& a = vertices_[static_cast<std::size_t>(triangle[0])];
    const P& b = vertices_[static_cast<std::size_t>(triangle[1])];
    const P& c = vertices_[static_cast<std::size_t>(triangle[2])];
    if (a.z < 0 && b.z < 0 && c.z < 0) {
      add(a, b, c);
      continue;
    }
    if (a.z >= 0 && b.z >= 0 && c.z >= 0) continue;
    // p is the corner that is alone on its side of the water.
    const std::array<const P*, 5> corners{&a, &b, &c, &a, &b};
    const std::size_t first = (b.z < 0) == (c.z < 0) ? 0 : (a.z < 0) == (c.z < 0) ? 1 : 2;
    const P& p = *corners[first];
    const P& q = *corners[first + 1];
    const P& r = *corners[first + 2];
    if (p.z < 0) {
      add(p, cut(p, q), cut(p, r));
    } else {
      const P on_pq = cut(q, p);
      add(on_pq, q, r);
      add(on_pq, r, cut(r, p));
    }
  }

  const double volume = volume6 / 6.0;
  const Vec3 reference_W = pose.p_WB + R * reference_B;
  const Vec3 moment_W = moment24.vec3() / 24.0 + volume * (apex_W - reference_W);  // V (c_B - reference)
  const Vec3 per_volume_W = water.density * water.gravity * Vec3::UnitZ();
  return {volume, volume * per_volume_W, moment_W.cross(per_volume_W)};
}

}  // namespace buoyancy::bench
