#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/vec3.h"
#include "tests/wave_loads/triangle_lanes-inl.h"
#include "wave_loads/wave_clips-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace {

// The integral over a triangle of |x - origin|^3, from below: that of a convex function is at least its value
// at the centroid, of each of kCuts^2 parts.
double third_moment(const Corners& corners, const Vec3& origin) {
  constexpr int kCuts = 16;
  const Vec3 along = (corners[1] - corners[0]) / kCuts;
  const Vec3 across = (corners[2] - corners[0]) / kCuts;
  double sum = 0.0;
  for (int i = 0; i < kCuts; ++i) {
    for (int j = 0; i + j < kCuts; ++j) {
      const Vec3 corner = corners[0] + i * along + j * across - origin;
      sum += std::pow((corner + (along + across) / 3.0).norm(), 3);
      if (i + j + 1 < kCuts) sum += std::pow((corner + (along + across) * (2.0 / 3.0)).norm(), 3);
    }
  }
  return sum * 0.5 * along.cross(across).norm();
}

Vec3 from_lanes(const Vectors3<double>& v) {
  return {first_lane(v.x), first_lane(v.y), first_lane(v.z)};
}

CachedModelLanes<double> random_models(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  CachedModelLanes<double> kept;
  for (auto& row : kept.rows) row = set<double>(normal(generator));
  return kept;
}

double value_at(const Quadratic<double>& q, const Vec3& y) {
  return first_lane(value_at<double>(q, in_lanes(y)));
}

// A patch's centre lies on a grid: it is off the centroid by up to the displacement of the surface, and its
// radius and second moment are about the centre.
PatchMoments<double> moments_about(const Corners& corners, const Vec3& off_centroid) {
  PatchMoments<double> moments = moments_of(corners);
  moments.center = in_lanes(centroid_of(corners) + off_centroid);
  moments.radius = set<double>(first_lane(moments.radius) + off_centroid.norm());
  moments.mu2 = set<double>(first_lane(moments.mu2) + first_lane(moments.area) * off_centroid.squaredNorm());
  return moments;
}

TEST(InheritedModel, BoundsTheThirdMomentAboutItsOrigin) {
  std::mt19937_64 generator(41);
  PatchQuery<double> query{};
  query.k_max = 2.5;
  for (const double displacement : {0.0, 1e-4, 0.02}) {
    query.displacement = query.k_max * displacement;
    double largest_ratio = 0.0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 place = random_vector(generator);
      Corners corners = random_triangle(generator);
      for (Vec3& corner : corners) corner = place + std::pow(10.0, -(i % 4) - i % 2) * corner;
      const CachedModelLanes<double> kept = random_models(generator);
      const Vec3 origin = from_lanes(kept.origin());
      // Towards the origin in every second case: then the surface is farther away than its centre.
      const Vec3 direction =
          (i % 4 < 2 ? Vec3(origin - centroid_of(corners)) : random_vector(generator)).normalized();
      const Inherited<double> inherited =
          inherit<double>(query, moments_about(corners, displacement * direction), kept);
      const double ratio = third_moment(corners, origin) / first_lane(inherited.moments.mu3);
      ASSERT_LE(ratio, 1.0) << "case " << i << ", displacement " << displacement;
      largest_ratio = std::max(largest_ratio, ratio);
    }
    EXPECT_GT(largest_ratio, 0.98);  // all distances of a small triangle are about the same
  }
}

TEST(InheritedModel, IsTheSameFunction) {
  std::mt19937_64 generator(43);
  for (int i = 0; i < 100; ++i) {
    const Corners corners = random_triangle(generator);
    const CachedModelLanes<double> kept = random_models(generator);
    const Inherited<double> inherited = inherit<double>({}, moments_of(corners), kept);
    const Vec3 x = random_vector(generator);
    const Vec3 y = x - centroid_of(corners);
    const Vec3 from_kept = x - from_lanes(kept.center());
    EXPECT_NEAR(value_at(inherited.model.phi, y), value_at(kept.phi(), from_kept), 1e-12);
    EXPECT_NEAR(value_at(inherited.model.s, y), value_at(kept.s(), from_kept), 1e-12);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();
