#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/vec3.h"
#include "tests/wave_loads/triangle_lanes-inl.h"
#include "wave_loads/wave_inherited-inl.h"
#include "wave_loads/wave_triangles-inl.h"

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

KeptModelLanes<double> random_models(std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  KeptModelLanes<double> kept;
  for (auto& row : kept.rows) row = set<double>(normal(generator));
  return kept;
}

double value_at(const Quadratic<double>& q, const Vec3& y) {
  return first_lane(value_at<double>(q, in_lanes(y)));
}

TEST(InheritedModel, BoundsTheThirdMomentAboutItsOrigin) {
  std::mt19937_64 generator(41);
  double largest_ratio = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 place = random_vector(generator);
    Corners corners = random_triangle(generator);
    for (Vec3& corner : corners) corner = place + std::pow(10.0, -(i % 4)) * corner;
    const KeptModelLanes<double> kept = random_models(generator);
    const Inherited<double> inherited = inherit<double>({}, moments_of(corners), kept);
    const double ratio = third_moment(corners, from_lanes(kept.origin())) / first_lane(inherited.moments.mu3);
    ASSERT_LE(ratio, 1.0) << "case " << i;
    largest_ratio = std::max(largest_ratio, ratio);
  }
  EXPECT_GT(largest_ratio, 0.99);  // all distances of a small triangle are about the same
}

TEST(InheritedModel, IsTheSameFunction) {
  std::mt19937_64 generator(43);
  for (int i = 0; i < 100; ++i) {
    const Corners corners = random_triangle(generator);
    const KeptModelLanes<double> kept = random_models(generator);
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
