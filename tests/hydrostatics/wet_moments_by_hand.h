// The wet surface's moments by the plainest way, every triangle one by one, in any number type: the oracle of
// the tree's descent, and what dual numbers go through.
#pragma once

#include "geometry/surface_moments.h"
#include "hydrostatics/triangle_clip.h"

namespace buoyancy {

// up: k; h: height of the surface over the origin that the mesh's vertices are measured from, along k.
template <typename T>
SurfaceMoments<T> wet_moments_by_hand(const TriangleMesh& mesh, const Vec3T<T>& up, const T& h) {
  SurfaceMoments<T> moments;
  const auto corner = [&](std::int32_t i) {
    const Vec3T<T> y = mesh.vertex(i).template cast<T>();
    return Corner<T>{Point<T>::from(y), T(up.dot(y) - h)};
  };
  const auto add = [&](const Corner<T>& a, const Corner<T>& b, const Corner<T>& c) {
    moments += moments_of_triangle<T>(a.y.vec3(), b.y.vec3(), c.y.vec3());
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
  return moments;
}

}  // namespace buoyancy
