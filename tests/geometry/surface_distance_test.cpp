#include "geometry/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

// The nearest of many points of each triangle.
double sampled_distance(const TriangleMesh& mesh, const Vec3& point) {
  constexpr int kSteps = 40;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const double u = static_cast<double>(i) / kSteps;
        const double v = static_cast<double>(j) / kSteps;
        const Vec3 at = (1.0 - u - v) * mesh.vertex(t[0]) + u * mesh.vertex(t[1]) + v * mesh.vertex(t[2]);
        nearest = std::min(nearest, (point - at).norm());
      }
    }
  }
  return nearest;
}

TEST(SurfaceDistance, IsThatOfTheNearestPoint) {
  const TriangleMesh mesh = make_shape(RockShape{.frequency = 4, .seed = 2});
  SurfaceDistance distance(mesh);
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Vec3 point = 1.5 * random_vec3(random);
    const double found = distance.to(point);
    const double sampled = sampled_distance(mesh, point);
    EXPECT_LE(found, sampled * (1.0 + 1e-12));
    EXPECT_GE(found, sampled - 0.02);
  }
}

TEST(SurfaceDistance, MeasuresBoxesInEachOther) {
  const TriangleMesh inner = make_shape(BoxShape{{1.0, 1.0, 1.0}, {4, 4, 4}});
  const TriangleMesh outer = make_shape(BoxShape{{3.0, 3.0, 3.0}, {4, 4, 4}});
  EXPECT_NEAR(largest_distance(inner, outer), 1.0, 1e-15);
  EXPECT_NEAR(largest_distance(outer, inner), std::sqrt(3.0), 1e-15);
  EXPECT_EQ(largest_distance(inner, inner), 0.0);
}

TEST(SurfaceDistance, HandlesTrianglesWithoutArea) {
  TriangleMesh sliver;
  sliver.add_vertex({0.0, 0.0, 0.0});
  sliver.add_vertex({1.0, 0.0, 0.0});
  sliver.add_vertex({2.0, 0.0, 0.0});
  sliver.triangles = {{0, 1, 2}, {0, 0, 0}};
  SurfaceDistance distance(sliver);
  EXPECT_NEAR(distance.to({1.5, 3.0, 4.0}), 5.0, 1e-15);
  EXPECT_NEAR(distance.to({-3.0, 4.0, 0.0}), 5.0, 1e-15);
}

}  // namespace
}  // namespace buoyancy
