// The bound on the volume that a face sweeps: each of its terms, its laws, and how near a search comes to it.
#include "geometry/swept_volume.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

using Corners = std::array<Vec3, 3>;

double bound_of(const Corners& corners, double move) {
  TriangleMesh mesh;
  for (const Vec3& corner : corners) mesh.add_vertex(corner);
  return swept_volume_bound(mesh, {0, 1, 2}, move);
}

// Where every corner moves on a straight line, exactly: the area vector is quadratic in the time.
double swept_volume(const Corners& from, const Corners& moves) {
  const Vec3 mean = (moves[0] + moves[1] + moves[2]) / 3.0;
  const auto rate = [&](double t) {
    const Vec3 a = from[0] + t * moves[0];
    return mean.dot(0.5 * (from[1] + t * moves[1] - a).cross(from[2] + t * moves[2] - a));
  };
  return std::abs(rate(0.0) + 4.0 * rate(0.5) + rate(1.0)) / 6.0;
}

// The largest share of the bound that moves of the corners by at most `move` reach, by climbing from many
// starts.
double largest_share(const Corners& face, double move, RandomPoses& random) {
  const double bound = bound_of(face, move);
  double largest = 0.0;
  for (int start = 0; start < 30; ++start) {
    Corners moves;
    for (Vec3& one : moves) one = move * random.direction();
    double reached = swept_volume(face, moves);
    for (double step = move; step > 1e-3 * move; step *= 0.97) {
      Corners other = moves;
      for (Vec3& one : other) {
        one += step * random.vector(0.0, 1.0);
        if (one.norm() > move) one *= move / one.norm();
      }
      const double now = swept_volume(face, other);
      if (now <= reached) continue;
      reached = now;
      moves = other;
    }
    largest = std::max(largest, reached / bound);
  }
  return largest;
}

TEST(SweptVolume, HasATermForAreaSidesAndMoveEach) {
  const Corners face{Vec3(1, 2, 3), Vec3(4, 2, 3), Vec3(1, 6, 3)};    // of area 6, with sides of 3 and 4
  const Corners needle{Vec3(1, 2, 3), Vec3(4, 2, 3), Vec3(6, 2, 3)};  // with sides of 3 and 5
  const Corners point{Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)};
  EXPECT_NEAR(bound_of(face, 1e-12), 6e-12, 1e-22);
  EXPECT_NEAR(bound_of(needle, 1e-12), 8e-24, 1e-34);
  EXPECT_DOUBLE_EQ(bound_of(point, 0.25), 2.0 / 64.0);
  EXPECT_DOUBLE_EQ(bound_of(face, 0.5), 0.5 * (6.0 + 7.0 * 0.5 + 0.5));
  for (const double scale : {1e-3, 1e3}) {
    for (const Corners& one : {face, needle, point}) {
      Corners scaled = one;
      for (Vec3& corner : scaled) corner *= scale;
      EXPECT_NEAR(bound_of(scaled, 0.1 * scale), std::pow(scale, 3) * bound_of(one, 0.1),
                  1e-12 * std::pow(scale, 3));
      EXPECT_GT(bound_of(one, 0.2), 2.0 * bound_of(one, 0.1) - 1e-12);
    }
  }
}

TEST(SweptVolume, IsReachedInPartAndNeverExceeded) {
  RandomPoses random(5);
  struct Case {
    double width, move, share;  // of a triangle of length 1; reached at least
  };
  for (const auto& [width, move, share] :
       {Case{1.0, 1e-6, 0.99}, {0.3, 1e-3, 0.97}, {1.0, 0.3, 0.42}, {0.0, 1e-4, 0.22}, {0.0, 10.0, 0.08}}) {
    double largest = 0.0;
    for (int i = 0; i < 5; ++i) {
      const Eigen::Quaterniond q = random.rotation();
      const Vec3 at = random.direction();
      const double along = random.uniform(0.0, 1.0);
      largest = std::max(
          largest, largest_share({at, at + q * Vec3(1, 0, 0), at + q * Vec3(along, width, 0)}, move, random));
    }
    EXPECT_LE(largest, 1.0 + 1e-12) << width << ' ' << move;
    EXPECT_GE(largest, share) << width << ' ' << move;
  }
}

}  // namespace
}  // namespace buoyancy
