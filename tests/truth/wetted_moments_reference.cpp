#include "tests/truth/wetted_moments_reference.h"

#include "hydrostatics/triangle_clip.h"

namespace buoyancy {

template <typename T>
SurfaceMoments<T> wetted_moments_reference(const TriangleMesh& mesh, const Vec3T<T>& up, const T& h) {
  SurfaceMoments<T> moments;
  const auto corner = [&](std::int32_t i) {
    const Vec3T<T> y = mesh.vertex(i).template cast<T>();
    return ClipVertex<T>{Point<T>::from(y), T(up.dot(y) - h)};
  };
  const auto add = [&](const ClipVertex<T>& a, const ClipVertex<T>& b, const ClipVertex<T>& c) {
    moments += moments_of_triangle<T>(a.y.vec3(), b.y.vec3(), c.y.vec3());
  };
  for (const Triangle& triangle : mesh.triangles) {
    const ClipVertex<T> a = corner(triangle[0]);
    const ClipVertex<T> b = corner(triangle[1]);
    const ClipVertex<T> c = corner(triangle[2]);
    const int wet = int(a.wet()) + int(b.wet()) + int(c.wet());
    if (wet == 3) {
      add(a, b, c);
    } else if (wet != 0) {
      for_each_wet_triangle(a, b, c, add);
    }
  }
  return moments;
}

template SurfaceMoments<Rational> wetted_moments_reference<Rational>(const TriangleMesh&,
                                                                     const Vec3T<Rational>&, const Rational&);
template SurfaceMoments<Dual> wetted_moments_reference<Dual>(const TriangleMesh&, const Vec3T<Dual>&,
                                                             const Dual&);

template struct DisplacementMoments<Rational>;
template DisplacementMoments<Rational> displacement_moments<Rational>(const SurfaceMoments<Rational>&,
                                                                      const Rational&,
                                                                      const Vec3T<Rational>&);
template DisplacementMoments<Dual> displacement_moments<Dual>(const SurfaceMoments<Dual>&, const Dual&,
                                                              const Vec3T<Dual>&);

}  // namespace buoyancy
