#include "geometry/moment_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace buoyancy {
namespace {

// A leaf without its storage type.
struct Leaf {
  LeafPatch patch;
  std::vector<Vec3> vertices;  // relative to c

  Vec3 a(std::size_t triangle) const { return vertices[patch.corners[triangle].a()]; }
  Vec3 b(std::size_t triangle) const { return vertices[patch.corners[triangle].b()]; }
  Vec3 c(std::size_t triangle) const { return vertices[patch.corners[triangle].c()]; }
};

template <typename Real>
Leaf read_leaf(const MomentTree& tree, const TreeLeaf<Real>& from) {
  Leaf leaf{from, {}};
  for (std::size_t i = 0; i < from.vertices; ++i) {
    leaf.vertices.push_back(tree.center(from.center) + from.vertex(i));
  }
  return leaf;
}

std::vector<Leaf> read_leaves(const MomentTree& tree) {
  std::vector<Leaf> leaves;
  for (const auto& leaf : tree.leaves) leaves.push_back(read_leaf(tree, leaf));
  for (const auto& leaf : tree.double_leaves) leaves.push_back(read_leaf(tree, leaf));
  return leaves;
}

// The numbers of the leaves below child i of a node.
std::vector<std::uint32_t> leaves_below(const MomentTree& tree, const TreeNode& node, std::uint32_t i) {
  if (i >= node.inner_nodes) return {node.first_leaf + i - node.inner_nodes};
  std::vector<std::uint32_t> leaves;
  const TreeNode& child = tree.nodes[node.first_node + i];
  for (std::uint32_t j = 0; j < child.children; ++j) {
    const std::vector<std::uint32_t> more = leaves_below(tree, child, j);
    leaves.insert(leaves.end(), more.begin(), more.end());
  }
  return leaves;
}

// Calls visit(leaves below the child, its moments, its box) for every child of every node.
template <typename Visit>
void visit_children(const MomentTree& tree, const Visit& visit) {
  for (const TreeNode& node : tree.nodes) {
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const Vec3 center = tree.center_of_child(node, i);
      const Vec3 half = tree.half_of_child(node, i);
      visit(leaves_below(tree, node, i), node.first_moments + i, BoundingBox{center - half, center + half});
    }
  }
}

void round_to_float(TriangleMesh& mesh) {
  for (std::vector<double>* const coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& value : *coordinates) value = static_cast<double>(static_cast<float>(value));
  }
}

// A sphere of `rows` rings of as many quadrilaterals each, which are strips at the poles.
TriangleMesh latitude_longitude_sphere(int rows) {
  TriangleMesh mesh;
  const auto add = [&](int row, int column) {
    const double theta = std::numbers::pi * row / rows;
    const double phi = 2.0 * std::numbers::pi * column / rows;
    return mesh.add_vertex(
        {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
  };
  const std::int32_t top = add(0, 0);
  for (int row = 1; row < rows; ++row) {
    for (int column = 0; column < rows; ++column) add(row, column);
  }
  const std::int32_t bottom = add(rows, 0);
  const auto at = [&](int row, int column) { return top + 1 + (row - 1) * rows + column % rows; };
  for (int column = 0; column < rows; ++column) {
    mesh.triangles.push_back({top, at(1, column), at(1, column + 1)});
    for (int row = 1; row < rows - 1; ++row) {
      mesh.triangles.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
      mesh.triangles.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
    }
    mesh.triangles.push_back({at(rows - 1, column), bottom, at(rows - 1, column + 1)});
  }
  return mesh;
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
  TriangleMesh soup;  // no two triangles share a vertex, so that a leaf holds eight
  for (int i = 0; i < 100; ++i) {
    const auto first = soup.add_vertex({0.1 * i, 0, 0});
    soup.add_vertex({0.1 * i + 1, 0.3, 0});
    soup.add_vertex({0.1 * i, 1, 0.2});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  meshes.push_back(soup);
  TriangleMesh in_float = make_shape(RockShape{.frequency = 20});
  round_to_float(in_float);
  meshes.push_back(in_float);
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
    for (const Leaf& leaf : read_leaves(tree)) {
      EXPECT_LE(leaf.patch.triangles, kLeafTriangles);
      EXPECT_LE(leaf.patch.vertices, kLeafVertices);
      for (std::size_t i = 0; i < leaf.patch.triangles; ++i) {
        const LeafCorners corner = leaf.patch.corners[i];
        EXPECT_LT(std::max({corner.a(), corner.b(), corner.c()}), leaf.patch.vertices);
        found.insert(corners(leaf.a(i), leaf.b(i), leaf.c(i)));
      }
    }
    EXPECT_TRUE(found == expected);
  }
}

std::size_t levels_below(const MomentTree& tree, const TreeNode& node) {
  std::size_t levels = 0;
  for (std::uint32_t i = 0; i < node.inner_nodes; ++i) {
    levels = std::max(levels, levels_below(tree, tree.nodes[node.first_node + i]));
  }
  return levels + 1;
}

TEST(MomentTree, HasNoMoreLevelsThanItsLeavesNeed) {
  for (const TriangleMesh& surface : surfaces()) {
    // Every number of triangles up to the shape's: every remainder of leaves over full subtrees.
    const std::size_t step = surface.triangles.size() / 150 + 1;
    for (std::size_t triangles = 1; triangles <= surface.triangles.size(); triangles += step) {
      TriangleMesh part = surface;
      part.triangles.resize(triangles);
      const MomentTree tree = build_moment_tree(part);
      std::size_t needed = 1;
      for (std::size_t full = kTreeWidth; full < tree.num_leaves(); full *= kTreeWidth) ++needed;
      ASSERT_EQ(levels_below(tree, tree.nodes[0]), needed) << triangles;
      ASSERT_LE(needed, kMaxTreeLevels);
    }
  }
}

TEST(MomentTree, BoundsEveryVertexBelowNode) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    const std::vector<Leaf> leaves = read_leaves(tree);
    visit_children(tree, [&](const std::vector<std::uint32_t>& below, std::size_t, const BoundingBox& box) {
      for (const std::uint32_t index : below) {
        for (const Vec3& at : leaves[index].vertices) {
          EXPECT_TRUE((at.array() >= box.min_B.array()).all() && (at.array() <= box.max_B.array()).all());
        }
      }
      EXPECT_LE(box.max_B.cwiseAbs().maxCoeff(), tree.reach);
      EXPECT_LE(box.min_B.cwiseAbs().maxCoeff(), tree.reach);
    });
  }
}

TEST(MomentTree, StoresMomentsOfSubtree) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    const std::vector<Leaf> leaves = read_leaves(tree);
    visit_children(tree, [&](const std::vector<std::uint32_t>& below, std::size_t index, const BoundingBox&) {
      SurfaceMoments<double> expected;
      double area = 0.0;
      for (const std::uint32_t leaf : below) {
        for (std::size_t i = 0; i < leaves[leaf].patch.triangles; ++i) {
          const auto one =
              moments_of_triangle<double>(leaves[leaf].a(i), leaves[leaf].b(i), leaves[leaf].c(i));
          expected += one;
          area += one.S.norm();
        }
      }
      const SurfaceMoments<double> moments = tree.moments_of(index);
      EXPECT_LE((moments.S - expected.S).norm(), 1e-14 * area);
      EXPECT_LE((moments.N - expected.N).norm(), 1e-14 * area * tree.reach);
      EXPECT_LE((moments.P - expected.P).norm(), 1e-14 * area * tree.reach * tree.reach);
      EXPECT_NEAR(tree.areas[index], area, 1e-14 * area);
      if (below.size() == 1) {
        EXPECT_EQ(leaves[below[0]].patch.moments, index);
      }
    });
  }
}

TEST(MomentTree, SplitsLeavesAmongFullNodes) {
  for (const TriangleMesh& surface : surfaces()) {
    const MomentTree tree = build_moment_tree(surface);
    std::size_t children = 0;
    for (const TreeNode& node : tree.nodes) children += node.children;
    EXPECT_EQ(children, tree.num_leaves() + tree.nodes.size() - 1);
    EXPECT_EQ(children, tree.areas.size());
    EXPECT_LE(tree.nodes.size(), tree.num_leaves() / 6 + 2);
  }
}

TEST(MomentTree, HoldsFloat32MeshesExactlyInFloat32) {
  TriangleMesh rock = make_shape(RockShape{.frequency = 20});
  for (const double distance : {0.0, 0.9, 7.0, 1e3, 1e6}) {
    TriangleMesh file = rock;
    for (double& x : file.x) x += distance;
    round_to_float(file);
    const Vec3 c(std::nearbyint(distance), 0.0, 0.0);
    TriangleMesh surface = file;
    for (double& x : surface.x) x -= c.x();
    const MomentTree tree = build_moment_tree(surface, -c);
    EXPECT_TRUE(tree.double_leaves.empty()) << distance;
    std::set<std::array<double, 3>> expected;
    for (std::size_t i = 0; i < surface.vertex_count(); ++i) {
      expected.insert({surface.x[i], surface.y[i], surface.z[i]});
    }
    for (const Leaf& leaf : read_leaves(tree)) {
      for (const Vec3& at : leaf.vertices) {
        EXPECT_EQ(expected.count({at.x(), at.y(), at.z()}), 1U) << distance;
      }
    }
  }
}

TEST(MomentTree, HoldsOtherMeshesInDouble) {
  const MomentTree tree = build_moment_tree(latitude_longitude_sphere(12));
  EXPECT_TRUE(tree.leaves.empty());
  EXPECT_FALSE(tree.double_leaves.empty());
}

TEST(MomentTree, SumsToVolumeOfClosedSurface) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 20});
  const MomentTree tree = build_moment_tree(rock);
  const SurfaceMoments<double> total = tree.total;
  const double volume = total.N.trace() / 3.0;
  EXPECT_LE(total.S.norm(), 1e-13);
  EXPECT_LE((total.N - volume * Mat3::Identity()).norm(), 1e-13);
}

TEST(MomentTree, PlacesLeafCentresOnGrid) {
  const MomentTree tree = build_moment_tree(make_shape(RockShape{.radius = 0.3, .frequency = 20}));
  for (const Leaf& leaf : read_leaves(tree)) {
    for (const std::int32_t steps : leaf.patch.center) EXPECT_LE(std::abs(steps), 1 << 23);
  }
  int exponent = 0;
  EXPECT_EQ(std::frexp(tree.grid, &exponent), 0.5);
  EXPECT_LE(tree.reach, std::ldexp(tree.grid, 23));
}

TEST(MomentTree, FillsLeavesAndLimitsMemory) {
  for (TriangleMesh mesh : {make_shape(RockShape{.frequency = 80}), latitude_longitude_sphere(300)}) {
    round_to_float(mesh);
    const MomentTree tree = build_moment_tree(mesh);
    const auto triangles = static_cast<double>(mesh.triangles.size());
    EXPECT_GT(triangles / static_cast<double>(tree.num_leaves()), 20.0);
    EXPECT_LT(static_cast<double>(tree.bytes()) / triangles, 34.0);
  }
}

}  // namespace
}  // namespace buoyancy
