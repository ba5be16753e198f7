// Triangles as patches in lanes, for tests of what is made with SIMD.
#if defined(BUOYANCY_TRIANGLE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_TRIANGLE_LANES_INL_H
#undef BUOYANCY_TRIANGLE_LANES_INL_H
#else
#define BUOYANCY_TRIANGLE_LANES_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>

#include <Eigen/Geometry>

#include "base/vec3.h"
#include "wave_loads/wave_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

inline double first_lane(const VectorOf<double>& numbers) {
  return hn::GetLane(numbers);
}

inline Vectors3<double> in_lanes(const Vec3& v) {
  return {set<double>(v.x()), set<double>(v.y()), set<double>(v.z())};
}

inline Vec3 random_vector(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return {normal(generator), normal(generator), normal(generator)};
}

using Corners = std::array<Vec3, 3>;

inline Vec3 centroid_of(const Corners& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3.0;
}

inline Corners random_triangle(std::mt19937_64& generator) {
  Corners corners;
  for (Vec3& corner : corners) corner = random_vector(generator);
  return corners;
}

// Its centroid, radius, area and second moment; 0 for the rest.
inline PatchMoments<double> moments_of(const Corners& corners) {
  const Vec3 centroid = centroid_of(corners);
  double radius = 0.0;
  double mean = 0.0;  // of the square of the distance: the mean of those of the edges' midpoints
  for (std::size_t n = 0; n < 3; ++n) {
    radius = std::max(radius, (corners[n] - centroid).norm());
    mean += (0.5 * (corners[n] + corners[(n + 1) % 3]) - centroid).squaredNorm() / 3.0;
  }
  const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  PatchMoments<double> moments{};
  moments.center = in_lanes(centroid);
  moments.radius = set<double>(radius);
  moments.area = set<double>(area);
  moments.mu2 = set<double>(mean * area);
  return moments;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_TRIANGLE_LANES_INL_H
