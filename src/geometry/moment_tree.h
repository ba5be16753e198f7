// The moment tree: a bounding-volume tree over a closed surface whose nodes store the surface moments of
// their subtrees, so that a fully submerged node costs one addition and a dry node costs nothing.
//
// The tree is flat and wide: inner nodes have up to eight children, whose bounds are stored side by side in
// 16 bits, rounded outward; leaves have up to 24 triangles, which index up to 24 vertices of the leaf. It
// consists of arrays without pointers; the children of a node follow each other in them. It is built once per
// mesh and scale, is immutable, and is shared by all bodies and threads.
//
// Coordinates are relative to the mesh's centre c. Moments are stored about c, not about each node's own
// centre: adding a node then takes 10 additions instead of about 50 operations for a change of centre. The
// rounding error of this choice, eps times (max distance from c) times (wetted area), is a fraction of the
// volume tolerance G_V (docs/mathematics.md, "The moment tree"). A leaf's vertices are relative to the leaf's
// own centre, so that heights and edges are rounded relative to the size of the leaf and not of the body.
//
// Vertices are stored exactly. Mesh files hold float32 coordinates, and a leaf's centre is chosen such that
// the vertices about it are float32 numbers too; the leaves of other meshes hold double.
//
// Complexity: build O(n log n), below 1 us per triangle. Memory: about 30 to 35 B per triangle, or 45 to 50 B
// if float32 does not hold the coordinates (docs/measurements.md, "The tree"). Query: hierarchical.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/large_page_array.h"
#include "base/vec3.h"
#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr int kTreeWidth = 8;       // children per inner node, at most
inline constexpr int kLeafTriangles = 24;  // per leaf, at most
inline constexpr int kLeafVertices = 24;   // per leaf, at most
// Levels of inner nodes, at most: every child is a full subtree, so that 2^32 leaves have no more.
inline constexpr std::size_t kMaxTreeLevels = 11;

// The ten surface moments about c that belong to one component n_a of the normal.
struct AxisMoments {
  double S = 0.0;             // int n_a dA [m^2]
  std::array<double, 3> N{};  // int y_i n_a dA [m^3]
  std::array<double, 6> P{};  // int y_i y_j n_a dA [m^4], indexed by kSymmetricPair
};

// Bounds of eight children, and where their data are. The inner nodes among the children come first.
struct alignas(64) TreeNode {
  // Centres and half-extents by axis, in units of MomentTree::unit, relative to c. They contain every vertex
  // below child i.
  std::array<std::array<std::int16_t, kTreeWidth>, 3> center;
  std::array<std::array<std::uint16_t, kTreeWidth>, 3> half;
  std::uint32_t first_node;     // index of child 0, if it is an inner node; the others' follow
  std::uint32_t first_leaf;     // index of the first child that is a leaf; the others' follow
  std::uint32_t first_moments;  // index of child 0's moments; its siblings' follow
  std::uint8_t inner_nodes;     // number of children that are inner nodes
  std::uint8_t children;        // 1 to kTreeWidth
};

// int |n_a| dA over each child's surface [m^2], by axis, as the upper half of a float32, rounded up. Only
// pruned descents read them.
struct ProjectedAreas {
  std::array<std::array<std::uint16_t, kTreeWidth>, 3> values;
};

// The corners of a leaf's triangle, as indices of its vertices.
struct LeafCorners {
  static constexpr unsigned kBits = 5;
  static constexpr unsigned kMask = (1U << kBits) - 1U;

  std::uint16_t word;  // a + 2^5 b + 2^10 c

  std::size_t a() const { return word & kMask; }
  std::size_t b() const { return static_cast<unsigned>(word) >> kBits & kMask; }
  std::size_t c() const { return static_cast<unsigned>(word) >> (2 * kBits) & kMask; }
};

// A patch of the surface, without its vertices. Unused triangles are (0, 0, 0) and contribute nothing.
struct LeafPatch {
  std::array<LeafCorners, kLeafTriangles> corners;
  std::array<std::int32_t, 3> center;  // relative to c, in units of MomentTree::grid
  std::uint32_t moments;               // index of the leaf's moments
  // [m^3]: eps times this value bounds the rounding error while the water plane cuts the leaf. The areas of
  // its triangles have errors of eps times products of edge lengths, however small the area itself; their
  // products with heights inherit these errors.
  float rounding;
  std::uint8_t vertices;
  std::uint8_t triangles;
};

// Unused vertices repeat the first vertex.
template <typename Real>
struct alignas(64) TreeLeaf : LeafPatch {
  // Vertices relative to the leaf's centre [m], by axis.
  alignas(32) std::array<std::array<Real, kLeafVertices>, 3> y;

  Vec3 vertex(std::size_t i) const {
    return {static_cast<double>(y[0][i]), static_cast<double>(y[1][i]), static_cast<double>(y[2][i])};
  }
};

// Lengths are in metres, or in the unit of the mesh file's coordinates: see `scale`.
struct MomentTree {
  // The tree's point y is at scale y + offset, B axes, relative to the mesh's centre c. A mesh that a scene
  // scales keeps the file's coordinates, which float32 holds, in its tree. Otherwise scale is 1 and offset 0:
  // everything below is in metres and relative to c.
  double scale = 1.0;          // [m] per unit of length of the tree
  Vec3 offset = Vec3::Zero();  // [m]

  LargePageArray<TreeNode> nodes;                  // nodes[0] is the root
  LargePageArray<ProjectedAreas> projected_areas;  // of each node's children
  // One of the two is empty. Float32 leaves hold half the memory.
  LargePageArray<TreeLeaf<float>> leaves;
  LargePageArray<TreeLeaf<double>> double_leaves;
  // One entry per child of each node.
  std::array<LargePageArray<AxisMoments>, 3> moments;  // by component of the normal
  LargePageArray<double> areas;                        // [m^2]

  SurfaceMoments<double> total;  // of the whole surface
  double rounding = 0.0;         // sum of TreeLeaf::rounding [m^3]
  double reach = 0.0;            // max |coordinate| of any bound, relative to c [m]
  double unit = 1.0;             // [m], of the nodes' bounds; reach <= 2^15 unit
  double grid = 1.0;  // [m]: a power of two, |coordinate| <= 2^22 grid. Leaf centres are integer multiples of
                      // it, so that their product with a number of 26 bits is exact in double.

  std::size_t num_leaves() const { return leaves.size() + double_leaves.size(); }
  SurfaceMoments<double> moments_of(std::size_t i) const;              // entry i of `moments`
  Vec3 center(const std::array<std::int32_t, 3>& leaf_center) const {  // [m], relative to c
    return grid * Vec3(leaf_center[0], leaf_center[1], leaf_center[2]);
  }
  Vec3 center_of_child(const TreeNode& node, std::uint32_t i) const {  // [m], of its bounds, relative to c
    return unit * Vec3(node.center[0][i], node.center[1][i], node.center[2][i]);
  }
  Vec3 half_of_child(const TreeNode& node, std::uint32_t i) const {  // [m], half-extents of its bounds
    return unit * Vec3(node.half[0][i], node.half[1][i], node.half[2][i]);
  }
  // Calls visit(child) with child i of a node, a TreeNode or a TreeLeaf: one step of a descent that does not
  // need the SIMD kernels of hydrostatics/node_kernels-inl.h.
  template <typename Visit>
  void visit_child(const TreeNode& node, std::uint32_t i, const Visit& visit) const {
    if (i < node.inner_nodes) {
      visit(nodes[node.first_node + i]);
    } else if (const std::uint32_t leaf = node.first_leaf + i - node.inner_nodes; leaves.empty()) {
      visit(double_leaves[leaf]);
    } else {
      visit(leaves[leaf]);
    }
  }
  std::size_t bytes() const;
};

// surface: vertices relative to c; at least one triangle, valid indices, finite coordinates. file_origin: the
// origin of the coordinates that the mesh file holds, relative to c. Where it is unknown, more meshes than
// necessary need double leaves.
MomentTree build_moment_tree(const TriangleMesh& surface, const Vec3& file_origin = Vec3::Zero());

}  // namespace buoyancy
