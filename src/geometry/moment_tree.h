// The moment tree: a bounding-volume tree over a closed surface whose nodes store the surface moments of
// their subtrees, so that a fully submerged node costs one addition and a dry node costs nothing.
//
// The tree is flat and wide: inner nodes have up to eight children, whose bounds are stored side by side in
// float32, rounded outward; leaves have up to 16 triangles, which index up to 16 vertices of the leaf. It
// consists of three arrays without pointers. It is built once per mesh and scale, is immutable, and is shared
// by all bodies and threads.
//
// Coordinates are relative to the mesh's centre c. Moments are stored about c, not about each node's own
// centre: adding a node then takes 10 additions instead of about 50 operations for a change of centre. The
// rounding error of this choice, eps times (max distance from c) times (wetted area), is a fraction of the
// volume tolerance G_V (docs/mathematics.md, "The moment tree"). A leaf's vertices are relative to the leaf's
// own centre, so that heights and edges are rounded relative to the size of the leaf and not of the body.
//
// Complexity: build O(n log n), below 1 us per triangle. Memory: about 60 to 110 B per
// triangle (docs/measurements.md, "The tree"). Query: hierarchical.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr int kTreeWidth = 8;       // children per inner node, at most
inline constexpr int kLeafTriangles = 16;  // per leaf, at most
inline constexpr int kLeafVertices = 16;   // per leaf, at most

// The ten surface moments about c that belong to one component n_a of the normal.
struct AxisMoments {
  double S = 0.0;             // int n_a dA [m^2]
  std::array<double, 3> N{};  // int y_i n_a dA [m^3]
  std::array<double, 6> P{};  // int y_i y_j n_a dA [m^4], indexed by kSymmetricPair
};

// The 30 surface moments of a node about c, and the area of its triangles. The moments of one component n_a
// take two cache lines: S_a, N_ia and four of P_ija are in line a, the other two of P_ija in the last line.
struct alignas(64) NodeMoments {
  static constexpr std::size_t kCount = 32;
  static constexpr std::size_t kInLine = 8;              // moments of a component in its own line
  static constexpr std::size_t kLastLine = 3 * kInLine;  // two moments per component, the area, padding
  static constexpr std::size_t kArea = kLastLine + 6;
  std::array<double, kCount> values{};

  // Returns the index of moment n of component a; n numbers S, N and P of AxisMoments consecutively.
  static constexpr std::size_t slot(std::size_t a, std::size_t n) {
    return n < kInLine ? kInLine * a + n : kLastLine + 2 * a + (n - kInLine);
  }

  NodeMoments& operator+=(const NodeMoments& other) {
    for (std::size_t i = 0; i < kCount; ++i) values[i] += other.values[i];
    return *this;
  }
  SurfaceMoments<double> moments() const;
  double area() const { return values[kArea]; }  // [m^2]
};

// Bounds of eight children: centre and half-extents [m], relative to c. They contain every vertex below child
// i.
struct alignas(64) TreeNode {
  std::array<float, kTreeWidth> center_x, center_y, center_z;
  std::array<float, kTreeWidth> half_x, half_y, half_z;
  std::array<std::uint32_t, kTreeWidth> child;  // index into nodes, or kLeafBit + index into leaves
  std::uint32_t first_moments;                  // index of child 0's moments; its siblings' follow
  std::uint32_t children;                       // 1 to kTreeWidth
  // int |n_a| dA over child i's surface [m^2], as the upper half of a float32, rounded up. Only pruned
  // descents read it; the exact descent does not.
  std::array<std::array<std::uint16_t, kTreeWidth>, 3> projected_area;

  static constexpr std::uint32_t kLeafBit = 0x80000000U;
};

// A patch of the surface. Unused vertices repeat the first vertex; unused triangles are (0, 0, 0) and
// contribute nothing.
struct alignas(64) TreeLeaf {
  std::array<std::array<double, kLeafVertices>, 3> y;  // relative to `center` [m], by axis
  std::array<std::uint8_t, kLeafTriangles> a, b, c;
  std::array<std::uint16_t, kLeafTriangles> corners;  // a + 16 b + 256 c, for wide SIMD registers
  std::array<double, 3> center;  // relative to c [m]; integer multiples of MomentTree::grid
  std::uint32_t moments;         // index of the leaf's moments
  std::uint8_t vertices;
  std::uint8_t triangles;
  // [m^3]: eps times this value bounds the rounding error while the water plane cuts the leaf. The areas of
  // its triangles have errors of eps times products of edge lengths, however small the area itself; their
  // products with heights inherit these errors.
  float rounding;

  Vec3 vertex(std::size_t i) const { return {y[0][i], y[1][i], y[2][i]}; }  // relative to `center`
};

struct MomentTree {
  std::vector<TreeNode> nodes;       // nodes[0] is the root
  std::vector<TreeLeaf> leaves;      // in depth-first order
  std::vector<NodeMoments> moments;  // one entry per child of each node
  NodeMoments total;                 // moments of the whole surface
  double rounding = 0.0;             // sum of TreeLeaf::rounding [m^3]
  float reach = 0.0F;                // max |coordinate| of any bound, relative to c [m]
  double grid = 1.0;  // [m]: a power of two, reach <= 2^22 grid. Leaf centres are integer multiples of it,
                      // so that their product with a number of 26 bits is exact in double.

  std::size_t bytes() const {
    return nodes.size() * sizeof(TreeNode) + leaves.size() * sizeof(TreeLeaf) +
           moments.size() * sizeof(NodeMoments);
  }
};

// surface: vertices relative to c; at least one triangle, valid indices, finite coordinates.
MomentTree build_moment_tree(const TriangleMesh& surface);

}  // namespace buoyancy
