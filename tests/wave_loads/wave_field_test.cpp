#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/vec3.h"
#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_pieces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace {

double first_lane(const VectorOf<double>& numbers) {
  return hn::GetLane(numbers);
}

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
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) corner = {normal(generator), normal(generator), normal(generator)};
    const Vec3 centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
    PieceLanes<double> piece{};
    double radius = 0.0;
    double mean = 0.0;  // of the square of the distance: the mean of those of the edges' midpoints
    for (std::size_t n = 0; n < 3; ++n) {
      corners[n] -= centroid;
      piece.corners[n] = {set<double>(corners[n].x()), set<double>(corners[n].y()),
                          set<double>(corners[n].z())};
      radius = std::max(radius, corners[n].norm());
    }
    for (std::size_t n = 0; n < 3; ++n)
      mean += (0.5 * (corners[n] + corners[(n + 1) % 3])).squaredNorm() / 3.0;
    piece.radius = set<double>(radius);
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    PatchMoments<double> patch{};
    patch.radius = piece.radius;
    patch.area = set<double>(area);
    patch.mu2 = set<double>(mean * area);
    const double spread = std::sqrt(mean) / radius;
    EXPECT_NEAR(first_lane(spread_of<double>(piece)), spread, 1e-6);
    EXPECT_NEAR(first_lane(spread_of<double>(patch)), spread, 1e-12);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();
