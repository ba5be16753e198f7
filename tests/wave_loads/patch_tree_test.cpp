#include "wave_loads/patch_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace buoyancy {
namespace {

TriangleMesh rock(std::int32_t frequency) {
  RockShape shape;
  shape.frequency = frequency;
  shape.roughness = 0.4;
  return make_shape(shape);
}

Vec3 center_of(const PatchBlock& block, std::size_t lane) {
  return {block.center[0][lane], block.center[1][lane], block.center[2][lane]};
}

struct Corner {
  Vec3 a, b, c;
};

// The triangles below a patch, about c.
void collect(const PatchTree& tree, const PatchBlock& block, std::size_t lane, std::vector<Corner>& out) {
  if (block.triangle_blocks[lane] == 0) {
    const PatchBlock& children = tree.blocks[block.child[lane]];
    for (std::size_t child = 0; child < children.patches; ++child) collect(tree, children, child, out);
    return;
  }
  for (std::uint32_t b = 0; b < block.triangle_blocks[lane]; ++b) {
    const auto& corners = tree.triangles[block.child[lane] + b].corners;
    for (std::size_t i = 0; i < kSiblings; ++i) {
      const auto at = [&](std::size_t corner) -> Vec3 {
        return Vec3(corners[3 * corner][i], corners[3 * corner + 1][i], corners[3 * corner + 2][i]) +
               center_of(block, lane);
      };
      const Corner triangle{at(0), at(1), at(2)};
      if ((triangle.b - triangle.a).norm() > 0.0) out.push_back(triangle);
    }
  }
}

TEST(PatchTree, HoldsEveryTriangleOnce) {
  for (const std::int32_t frequency : {2, 7, 24}) {
    const TriangleMesh mesh = rock(frequency);
    const PatchTree tree = build_patch_tree(mesh);
    std::vector<Corner> triangles;
    for (std::size_t lane = 0; lane < tree.blocks[0].patches; ++lane) {
      collect(tree, tree.blocks[0], lane, triangles);
    }
    EXPECT_EQ(triangles.size(), patch_surface(mesh).triangles.size());
    double area = 0.0;
    for (const Corner& t : triangles) area += 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
    EXPECT_GE(tree.area, area);
    EXPECT_LE(tree.area, area * (1.0 + 1e-4));
  }
}

TEST(PatchTree, MomentsAddUpToThoseOfTheVolume) {
  const TriangleMesh mesh = rock(20);
  const PatchTree tree = build_patch_tree(mesh);
  Vec3 S = Vec3::Zero();
  double volume = 0.0;
  for (std::size_t lane = 0; lane < tree.blocks[0].patches; ++lane) {
    const PatchBlock& block = tree.blocks[0];
    const Vec3 m = center_of(block, lane);
    for (std::size_t k = 0; k < 3; ++k) {
      S[static_cast<int>(k)] += block.S[k][lane];
      volume += (block.N[3 * k + k][lane] + m[static_cast<int>(k)] * block.S[k][lane]) / 3.0;
    }
  }
  double expected = 0.0;
  for (const Triangle& t : mesh.triangles) {
    expected += mesh.vertex(t[0]).dot(mesh.vertex(t[1]).cross(mesh.vertex(t[2]))) / 6.0;
  }
  EXPECT_NEAR(S.norm(), 0.0, 1e-5);
  EXPECT_NEAR(volume, expected, 1e-5 * expected);
}

TEST(PatchTree, BoundsHoldForEveryPatch) {
  const TriangleMesh mesh = rock(12);
  const PatchTree tree = build_patch_tree(mesh);
  for (const PatchBlock& block : tree.blocks) {
    for (std::size_t lane = 0; lane < block.patches; ++lane) {
      std::vector<Corner> triangles;
      collect(tree, block, lane, triangles);
      const Vec3 m = center_of(block, lane);
      double radius = 0.0;
      double area = 0.0;
      double mu2 = 0.0;
      double mu3 = 0.0;
      Eigen::Matrix<double, 27, 3> third = Eigen::Matrix<double, 27, 3>::Zero();
      for (const Corner& t : triangles) {
        const Vec3 normal = 0.5 * (t.b - t.a).cross(t.c - t.a);
        const double of_triangle = normal.norm();
        area += of_triangle;
        constexpr int kCuts = 8;  // points of the midpoint rule along an edge
        for (int i = 0; i < kCuts; ++i) {
          for (int j = 0; j < kCuts - i; ++j) {
            const double u = (i + 1.0 / 3.0) / kCuts;
            const double v = (j + 1.0 / 3.0) / kCuts;
            const Vec3 y = t.a + u * (t.b - t.a) + v * (t.c - t.a) - m;
            const double distance = y.norm();
            const double of_point = 2.0 / (kCuts * (kCuts + 1.0));
            const double share = of_triangle * of_point;
            mu2 += share * distance * distance;
            mu3 += share * distance * distance * distance;
            for (int n = 0; n < 27; ++n) {
              third.row(n) += of_point * y(n % 3) * y(n / 3 % 3) * y(n / 9) * normal.transpose();
            }
          }
        }
        for (const Vec3& corner : {t.a, t.b, t.c}) radius = std::max(radius, (corner - m).norm());
      }
      // Those of the surface count as well, which is as far away as the grid allows.
      ASSERT_GE(block.radius[lane], radius + tree.displacement);
      ASSERT_LE(block.radius[lane], radius + 2.0 * tree.displacement + 1e-6 * radius);
      ASSERT_GE(block.area[lane], area + tree.displacement * radius);
      ASSERT_LE(block.area[lane], area * (1.0 + 1e-3));
      ASSERT_NEAR(block.mu2[lane], mu2, 0.05 * mu2);
      ASSERT_GE(block.mu3[lane], 0.95 * mu3);
      ASSERT_LE(block.mu3[lane], radius * block.mu2[lane] * (1.0 + 1e-6));
      ASSERT_NEAR(block.nu3[lane], third.norm(), 0.05 * mu3);
      ASSERT_GE(block.mu3[lane], block.nu3[lane]);
    }
  }
}

TEST(PatchTree, NeighboursShareTheirCorners) {
  const TriangleMesh source = rock(12);
  const TriangleMesh mesh = patch_surface(source);
  const PatchTree tree = build_patch_tree(source);
  std::vector<Corner> triangles;
  for (std::size_t lane = 0; lane < tree.blocks[0].patches; ++lane) {
    collect(tree, tree.blocks[0], lane, triangles);
  }
  std::set<std::array<double, 3>> corners;
  for (const Corner& t : triangles) {
    for (const Vec3& corner : {t.a, t.b, t.c}) corners.insert({corner.x(), corner.y(), corner.z()});
  }
  EXPECT_EQ(corners.size(), mesh.vertex_count());
  EXPECT_LE(tree.displacement, 3e-7);
  for (const std::array<double, 3>& corner : corners) {
    double nearest = 1.0;
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
      const Vec3 vertex = mesh.vertex(static_cast<std::int32_t>(i));
      nearest = std::min(nearest, (vertex - Vec3(corner[0], corner[1], corner[2])).norm());
    }
    ASSERT_LE(nearest, tree.displacement);
  }
}

// Two large squares a little apart: no leaf holds triangles of both sides.
TEST(PatchTree, KeepsTheSidesOfThinBodiesApart) {
  const TriangleMesh plate = make_shape(BoxShape{{2.0, 2.0, 0.1}, {1, 1, 1}});
  const PatchTree tree = build_patch_tree(plate);
  float largest = 0.0F;
  for (const PatchBlock& block : tree.blocks) {
    for (std::size_t lane = 0; lane < block.patches; ++lane) {
      if (block.triangle_blocks[lane] > 0) largest = std::max(largest, block.radius[lane]);
    }
  }
  EXPECT_LT(largest, 0.1F);
}

}  // namespace
}  // namespace buoyancy
