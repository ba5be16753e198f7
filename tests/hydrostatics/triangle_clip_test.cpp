#include "hydrostatics/triangle_clip.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/hydrostatics/random_poses.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

template <typename T>
struct Clipped {
  std::vector<std::array<ClipVertex<T>, 3>> triangles;
  Vec3T<T> twice_area = Vec3T<T>::Constant(T(0));
};

template <typename T>
Clipped<T> clip(const ClipVertex<T>& a, const ClipVertex<T>& b, const ClipVertex<T>& c) {
  Clipped<T> clipped;
  for_each_wet_triangle(a, b, c, [&](const ClipVertex<T>& p, const ClipVertex<T>& q, const ClipVertex<T>& r) {
    clipped.triangles.push_back({p, q, r});
    clipped.twice_area += cross(q.y - p.y, r.y - p.y).vec3();
  });
  return clipped;
}

// A corner with integer coordinates whose height is its z coordinate.
ClipVertex<Rational> random_corner(RandomPoses& random) {
  const auto coordinate = [&] { return Rational(static_cast<int>(random.pick(41)) - 20); };
  ClipVertex<Rational> corner{{coordinate(), coordinate(), coordinate()}, Rational(0)};
  corner.z = corner.y.z;
  return corner;
}

TEST(TriangleClip, SplitsTrianglesExactly) {
  RandomPoses random(5);
  int num_cut = 0;
  for (int i = 0; i < 2000; ++i) {
    const ClipVertex<Rational> a = random_corner(random);
    const ClipVertex<Rational> b = random_corner(random);
    const ClipVertex<Rational> c = random_corner(random);
    const int wet = int(a.wet()) + int(b.wet()) + int(c.wet());
    if (wet == 0 || wet == 3 || a.z == 0 || b.z == 0 || c.z == 0) continue;
    ++num_cut;
    const auto mirrored = [](ClipVertex<Rational> corner) {
      corner.z = -corner.z;
      return corner;
    };
    const auto below = clip(a, b, c);
    const auto above = clip(mirrored(a), mirrored(b), mirrored(c));
    EXPECT_EQ(below.triangles.size(), std::size_t(wet));
    EXPECT_EQ(above.triangles.size(), std::size_t(3 - wet));
    const Vec3T<Rational> whole = cross(b.y - a.y, c.y - a.y).vec3();
    EXPECT_EQ(Vec3T<Rational>(below.twice_area + above.twice_area), whole);
    for (const auto& triangle : below.triangles) {
      for (const ClipVertex<Rational>& corner : triangle) {
        EXPECT_LE(corner.z, Rational(0));
        EXPECT_EQ(corner.z, corner.y.z) << "a cut point lies where the edge meets the water";
      }
    }
  }
  EXPECT_GT(num_cut, 1000);
}

TEST(TriangleClip, FindsSameCutPointFromBothTriangles) {
  RandomPoses random(6);
  for (int i = 0; i < 1000; ++i) {
    const ClipVertex<double> wet{Point<double>::from(random.direction()), random.uniform(-1, -1e-12)};
    const ClipVertex<double> dry{Point<double>::from(random.direction()), random.uniform(0, 1)};
    const ClipVertex<double> left{Point<double>::from(random.direction()), random.uniform(0, 1)};
    const ClipVertex<double> right{Point<double>::from(random.direction()), random.uniform(-1, -1e-12)};
    const auto one = clip(wet, dry, left);     // the edge runs from wet to dry, one corner is wet
    const auto other = clip(dry, wet, right);  // the edge runs from dry to wet, two corners are wet
    EXPECT_EQ(one.triangles[0][1].y.vec3(), other.triangles[0][0].y.vec3());
  }
}

TEST(TriangleClip, TreatsCornerOnWaterAsDry) {
  const ClipVertex<double> on{{0, 0, 0}, 0.0};
  const ClipVertex<double> below{{1, 0, -1}, -1.0};
  const ClipVertex<double> also_below{{0, 1, -1}, -1.0};
  EXPECT_FALSE(on.wet());
  const auto clipped = clip(on, below, also_below);
  EXPECT_EQ(clipped.twice_area, Vec3(Vec3(1, 0, -1).cross(Vec3(0, 1, -1)))) << "nothing is lost";
}

}  // namespace
}  // namespace buoyancy
