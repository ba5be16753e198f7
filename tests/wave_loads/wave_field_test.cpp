#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/wave_loads/triangle_lanes-inl.h"
#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_integrals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace {

// An expansion, and a patch beside its centre.
struct PatchInCell {
  CellBounds<double> bounds;
  double reach, extent;
  std::vector<double> distances;  // of points of the patch from its centroid, over the largest

  double truncation_at(double distance) const {
    return first_lane(bounds_at<double>(bounds, set<double>(distance)).truncation);
  }
  double mean() const {
    double sum = 0.0;
    for (const double distance : distances) sum += truncation_at(reach + extent * distance);
    return sum / static_cast<double>(distances.size());
  }
  double bound() const {
    double squares = 0.0;
    for (const double distance : distances) squares += distance * distance;
    const double spread = std::sqrt(squares / static_cast<double>(distances.size()));
    const ReachBounds<double> farthest = bounds_at<double>(bounds, set<double>(reach + extent));
    return first_lane(mean_truncation<double>(bounds, farthest, set<double>(reach), set<double>(extent),
                                              set<double>(spread)));
  }
};

PatchInCell random_patch(std::mt19937_64& generator) {
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator);
  };
  PatchInCell patch{};
  for (double& sigma : patch.bounds.sigma) sigma = uniform(0.0, 1.0);
  patch.bounds.tail = uniform(0.0, 1.0);
  patch.reach = uniform(0.0, 3.0);
  patch.extent = uniform(0.0, 3.0);
  const double exponent = uniform(0.0, 4.0);
  for (int i = 0; i < 50; ++i) patch.distances.push_back(std::pow(uniform(0.0, 1.0), exponent));
  return patch;
}

TEST(WaveField, BoundsTheMeanOfWhatIsLeftOut) {
  std::mt19937_64 generator(29);
  double largest_ratio = 0.0;
  for (int i = 0; i < 2'000; ++i) {
    const PatchInCell patch = random_patch(generator);
    const double ratio = patch.mean() / patch.bound();
    ASSERT_LE(ratio, 1.0 + 1e-12) << "case " << i;
    largest_ratio = std::max(largest_ratio, ratio);
  }
  EXPECT_GT(largest_ratio, 0.99);
}

TEST(WaveField, KnowsTheMeanWhereAllPointsAreAsFar) {
  std::mt19937_64 generator(31);
  for (int i = 0; i < 100; ++i) {
    PatchInCell patch = random_patch(generator);
    patch.distances.assign(10, 1.0);
    EXPECT_NEAR(patch.bound(), patch.truncation_at(patch.reach + patch.extent), 1e-12 * patch.bound());
  }
}

TEST(WaveField, KnowsTheSpreadOfATriangle) {
  std::mt19937_64 generator(37);
  for (int i = 0; i < 100; ++i) {
    const Corners corners = random_triangle(generator);
    double squares = 0.0;
    double largest = 0.0;
    for (const Vec3& corner : corners) {
      const double squared = (corner - centroid_of(corners)).squaredNorm();
      squares += squared / 12.0;
      largest = std::max(largest, squared);
    }
    EXPECT_NEAR(first_lane(spread_of<double>(moments_of(corners))), std::sqrt(squares / largest), 1e-12);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();
