#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "base/vec3.h"
#include "tests/wave_loads/triangle_lanes-inl.h"
#include "wave_loads/wave_inherited-inl.h"

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

// Kept models of random numbers, for a patch at `center` and made about `origin`.
KeptModelLanes<double> kept_models(std::mt19937_64& generator, const Vec3& center, const Vec3& origin) {
  std::normal_distribution<double> normal;
  KeptModelLanes<double> kept;
  for (auto& row : kept.rows) row = set<double>(normal(generator));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    kept.rows[25 + axis] = set<double>(center[at]);
    kept.rows[37 + axis] = set<double>(origin[at]);
  }
  return kept;
}

double value_at(const Quadratic<double>& q, const Vec3& y) {
  const Vectors3<double> lanes = in_lanes(y);
  return first_lane(q.value + dot<double>(q.gradient, lanes) +
                    set<double>(0.5) * dot<double>(product<double>(q.hessian, lanes), lanes));
}

TEST(InheritedModel, BoundsTheThirdMomentAboutItsOrigin) {
  std::mt19937_64 generator(41);
  double largest_ratio = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Corners corners = random_triangle(generator);
    const Vec3 origin = std::pow(10.0, i % 4 - 1) * random_vector(generator);
    const KeptModelLanes<double> kept = kept_models(generator, random_vector(generator), origin);
    const Inherited<double> inherited = inherit<double>({}, moments_of(corners), kept);
    const double ratio = third_moment(corners, origin) / first_lane(inherited.moments.mu3);
    ASSERT_LE(ratio, 1.0) << "case " << i;
    largest_ratio = std::max(largest_ratio, ratio);
  }
  EXPECT_GT(largest_ratio, 0.99);  // far from the origin all distances are about the same
}

TEST(InheritedModel, IsTheSameFunction) {
  std::mt19937_64 generator(43);
  for (int i = 0; i < 100; ++i) {
    const Corners corners = random_triangle(generator);
    const Vec3 center = random_vector(generator);
    const KeptModelLanes<double> kept = kept_models(generator, center, random_vector(generator));
    const Inherited<double> inherited = inherit<double>({}, moments_of(corners), kept);
    const Vec3 x = random_vector(generator);
    const Vec3 y = x - centroid_of(corners);
    EXPECT_NEAR(value_at(inherited.model.phi, y), value_at(kept.phi(), x - center), 1e-12);
    EXPECT_NEAR(value_at(inherited.model.s, y), value_at(kept.s(), x - center), 1e-12);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();
