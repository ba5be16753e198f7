#include "geometry/moment_tree.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace buoyancy {
namespace {

// Calls visit(child, moments, box) for every child of every node.
template <typename Visit>
void visit_children(const MomentTree& tree, const Visit& visit) {
  for (const TreeNode& node : tree.nodes) {
    for (std::size_t i = 0; i < node.children; ++i) {
      const Vec3 center(node.center_x[i], node.center_y[i], node.center_z[i]);
      const Vec3 half(node.half_x[i], node.half_y[i], node.half_z[i]);
      visit(node.child[i], node.first_moments + i, BoundingBox{center - half, center + half});
    }
  }
}

// Appends the leaves below a child.
void collect_leaves(const MomentTree& tree, std::uint32_t child, std::vector<std::uint32_t>& leaves) {
  if ((child & TreeNode::kLeafBit) != 0) {
    leaves.push_back(child - TreeNode::kLeafBit);
    return;
  }
  const TreeNode& node = tree.nodes[child];
  for (std::size_t i = 0; i < node.children; ++i) collect_leaves(tree, node.child[i], leaves);
}

Vec3 leaf_vertex(const TreeLeaf& leaf, std::size_t i) {
  return leaf.vertex(i) + Vec3(leaf.center[0], leaf.center[1], leaf.center[2]);
}

std::vector<TriangleMesh> surfaces() {
  std::vector<TriangleMesh> meshes{make_shape(BoxShape{}), make_shape(SphereShape{.segments = 9}),
                                   make_shape(TorusKnotShape{}), make_shape(RockShape{.frequency = 20}),
                                   make_shape(BoxShape{.size = {1000, 1, 1e-3}, .segments = {50, 3, 1}})};
  TriangleMesh one_triangle;
  one_triangle.add_vertex({0, 0, 0});
  one_triangle.add_vertex({1, 0, 0});
  one_triangle.add_vertex({0, 1, 0});
  one_triangle.triangles.push_back({0, 1, 2});
  meshes.push_back(one_triangle);
  TriangleMesh fan;  // all triangles coincide
  for (int i = 0; i < 300; ++i) fan.triangles.push_back({0, 1, 2});
  fan.x = {0, 1, 0};
  fan.y = {0, 0, 1};
  fan.z = {0, 0, 0};
  meshes.push_back(fan);
  TriangleMesh soup;  // no two triangles share a vertex, so that a leaf holds five
  for (int i = 0; i < 100; ++i) {
    const auto first = soup.add_vertex({0.1 * i, 0, 0});
    soup.add_vertex({0.1 * i + 1, 0.3, 0});
    soup.add_vertex({0.1 * i, 1, 0.2});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  meshes.push_back(soup);
  return meshes;
}

TEST(MomentTree, StoresEveryTriangleInOneLeaf) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    std::multiset<std::array<double, 9>> expected;
    std::multiset<std::array<double, 9>> found;
    const auto corners = [](const Vec3& a, const Vec3& b, const Vec3& c) {
      const auto rounded = [](double value) { return std::nearbyint(value * 0x1p30); };
      std::array<double, 9> key{};
      for (int i = 0; i < 3; ++i) {
        key[static_cast<std::size_t>(i)] = rounded(a[i]);
        key[static_cast<std::size_t>(i) + 3] = rounded(b[i]);
        key[static_cast<std::size_t>(i) + 6] = rounded(c[i]);
      }
      return key;
    };
    for (const Triangle& t : surface.triangles) {
      expected.insert(corners(surface.vertex(t[0]), surface.vertex(t[1]), surface.vertex(t[2])));
    }
    for (const TreeLeaf& leaf : tree.leaves) {
      EXPECT_LE(leaf.triangles, kLeafTriangles);
      EXPECT_LE(leaf.vertices, kLeafVertices);
      for (std::size_t i = 0; i < leaf.triangles; ++i) {
        EXPECT_LT(std::max({leaf.a[i], leaf.b[i], leaf.c[i]}), leaf.vertices);
        found.insert(corners(leaf_vertex(leaf, leaf.a[i]), leaf_vertex(leaf, leaf.b[i]),
                             leaf_vertex(leaf, leaf.c[i])));
      }
    }
    EXPECT_TRUE(found == expected);
  }
}

TEST(MomentTree, BoundsEveryVertexBelowNode) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    visit_children(tree, [&](std::uint32_t child, std::size_t, const BoundingBox& box) {
      std::vector<std::uint32_t> leaves;
      collect_leaves(tree, child, leaves);
      for (const std::uint32_t index : leaves) {
        const TreeLeaf& leaf = tree.leaves[index];
        for (std::size_t i = 0; i < leaf.vertices; ++i) {
          const Vec3 at = leaf_vertex(leaf, i);
          EXPECT_TRUE((at.array() >= box.min_B.array()).all() && (at.array() <= box.max_B.array()).all());
        }
      }
      EXPECT_LE(box.max_B.cwiseAbs().maxCoeff(), static_cast<double>(tree.reach));
      EXPECT_LE(box.min_B.cwiseAbs().maxCoeff(), static_cast<double>(tree.reach));
    });
  }
}

TEST(MomentTree, StoresMomentsOfSubtree) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    visit_children(tree, [&](std::uint32_t child, std::size_t moments_index, const BoundingBox&) {
      std::vector<std::uint32_t> leaves;
      collect_leaves(tree, child, leaves);
      SurfaceMoments<double> expected;
      double area = 0.0;
      for (const std::uint32_t index : leaves) {
        const TreeLeaf& leaf = tree.leaves[index];
        for (std::size_t i = 0; i < leaf.triangles; ++i) {
          const auto one = moments_of_triangle<double>(
              leaf_vertex(leaf, leaf.a[i]), leaf_vertex(leaf, leaf.b[i]), leaf_vertex(leaf, leaf.c[i]));
          expected += one;
          area += one.S.norm();
        }
      }
      const NodeMoments& node = tree.moments[moments_index];
      const double reach = static_cast<double>(tree.reach);
      EXPECT_LE((node.moments().S - expected.S).norm(), 1e-14 * area);
      EXPECT_LE((node.moments().N - expected.N).norm(), 1e-14 * area * reach);
      EXPECT_LE((node.moments().P - expected.P).norm(), 1e-14 * area * reach * reach);
      EXPECT_NEAR(node.area(), area, 1e-14 * area);
    });
  }
}

TEST(MomentTree, SumsToVolumeOfClosedSurface) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 20});
  const MomentTree tree = build_moment_tree(rock);
  const SurfaceMoments<double> total = tree.total.moments();
  const double volume = total.N.trace() / 3.0;
  EXPECT_LE(total.S.norm(), 1e-13);
  EXPECT_LE((total.N - volume * Mat3::Identity()).norm(), 1e-13);
}

TEST(MomentTree, PlacesLeafCentresOnGrid) {
  const MomentTree tree = build_moment_tree(make_shape(RockShape{.radius = 0.3, .frequency = 20}));
  for (const TreeLeaf& leaf : tree.leaves) {
    for (const double coordinate : leaf.center) {
      const double steps = coordinate / tree.grid;
      EXPECT_EQ(steps, std::nearbyint(steps));
      EXPECT_LE(std::abs(steps), 0x1p22);
    }
  }
}

TEST(MomentTree, FillsLeavesAndLimitsMemory) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 80});
  const MomentTree tree = build_moment_tree(rock);
  const auto triangles = static_cast<double>(rock.triangles.size());
  EXPECT_GT(triangles / static_cast<double>(tree.leaves.size()), 13.0);
  EXPECT_LT(static_cast<double>(tree.bytes()) / triangles, 80.0);
}

}  // namespace
}  // namespace buoyancy
