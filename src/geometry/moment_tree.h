// The moment tree: a bounding-volume tree over a closed surface whose nodes know the surface moments of all
// that is below them, so that a wholly wet node is answered by one addition and a dry one by nothing.
//
// Flat and wide: inner nodes of up to eight children whose bounds lie side by side in float32, rounded
// outward; leaves of up to 16 triangles that index their own up to 16 vertices. Three arrays, no pointers.
// Built once per mesh and scale, never changed, shared by all bodies and threads.
//
// Coordinates are about the mesh's centre c. Moments are stored about c, not about each node's own centre:
// adding a node then needs no move, 10 additions instead of some 50 operations, and the rounding it costs,
// eps times (largest distance from c) times (area of what is wet), is a fraction of the gate G_V
// (docs/mathematics.md, "The moment tree"). What must be local is local: a leaf's vertices are about the
// leaf's own centre, so that heights and edges are rounded relative to the leaf's size and not to the body's.
//
// Build: O(n log n), below 1 us per triangle. Memory: about 60 B per triangle. Query: see hierarchical.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr int kTreeWidth = 8;       // children per inner node
inline constexpr int kLeafTriangles = 16;  // at most
inline constexpr int kLeafVertices = 16;   // at most

// The ten surface moments about c that belong to one component n_a of the normal.
struct AxisMoments {
  double S = 0.0;             // m^2: int n_a dA
  std::array<double, 3> N{};  // m^3: int y_i n_a dA
  std::array<double, 6> P{};  // m^4: int y_i y_j n_a dA by kSymmetricPair
};

// The 30 surface moments of a node about c, and the area of its triangles. Those of one component n_a lie
// together, in two lines of memory: S_a, N_ia and four of P_ija in line a, the other two in the last line.
struct alignas(64) NodeMoments {
  static constexpr std::size_t kCount = 32;
  static constexpr std::size_t kInLine = 8;              // of a component, in its own line
  static constexpr std::size_t kLastLine = 3 * kInLine;  // two of each component, the area, padding
  static constexpr std::size_t kArea = kLastLine + 6;
  std::array<double, kCount> values{};

  // Where moment n of component a lies; n counts S, N and P of AxisMoments through.
  static constexpr std::size_t slot(std::size_t a, std::size_t n) {
    return n < kInLine ? kInLine * a + n : kLastLine + 2 * a + (n - kInLine);
  }

  NodeMoments& operator+=(const NodeMoments& other) {
    for (std::size_t i = 0; i < kCount; ++i) values[i] += other.values[i];
    return *this;
  }
  SurfaceMoments<double> moments() const;
  double area() const { return values[kArea]; }  // m^2
};

// Bounds of eight children as centre and half-extents, about c, m; every vertex below child i lies within
// them.
struct alignas(64) TreeNode {
  std::array<float, kTreeWidth> center_x, center_y, center_z;
  std::array<float, kTreeWidth> half_x, half_y, half_z;
  std::array<std::uint32_t, kTreeWidth> child;  // index into nodes, or kLeafBit + index into leaves
  std::uint32_t first_moments;                  // index of child 0's moments; its siblings' follow
  std::uint32_t children;                       // 1 to kTreeWidth
  // For descents that stop early; the exact one reads none of it. Upper halves of float32, rounded up:
  // int |n_a| dA over child i's surface, m^2.
  std::array<std::array<std::uint16_t, kTreeWidth>, 3> projected_area;

  static constexpr std::uint32_t kLeafBit = 0x80000000U;
};

// A patch of the surface. Unused vertices repeat the first; unused triangles are (0, 0, 0) and enclose
// nothing.
struct alignas(64) TreeLeaf {
  std::array<std::array<double, kLeafVertices>, 3> y;  // m, about `center`, by axis
  std::array<std::uint8_t, kLeafTriangles> a, b, c;
  std::array<std::uint16_t, kLeafTriangles> corners;  // a + 16 b + 256 c, for wide registers
  std::array<double, 3> center;                       // m, about c; whole multiples of MomentTree::grid
  std::uint32_t moments;                              // index of its own
  std::uint8_t vertices;
  std::uint8_t triangles;
  // m^3: what rounding takes its share of, times eps, while the water crosses the leaf: areas of its
  // triangles are off by eps times products of their edges, whatever is left of the area, and so is what
  // their heights make of them.
  float rounding;

  Vec3 vertex(std::size_t i) const { return {y[0][i], y[1][i], y[2][i]}; }  // about `center`
};

struct MomentTree {
  std::vector<TreeNode> nodes;       // nodes[0] is the root
  std::vector<TreeLeaf> leaves;      // in the order of a depth-first walk
  std::vector<NodeMoments> moments;  // of every child of every node
  NodeMoments total;                 // of the whole surface
  double rounding = 0.0;             // m^3: of all leaves
  float reach = 0.0F;                // m: no bound reaches farther from c in any coordinate
  double grid = 1.0;  // m: a power of two, reach <= 2^22 grid. Leaf centres are whole multiples of it,
                      // so that the product with a number of 26 bits is exact in double.

  std::size_t bytes() const {
    return nodes.size() * sizeof(TreeNode) + leaves.size() * sizeof(TreeLeaf) +
           moments.size() * sizeof(NodeMoments);
  }
};

// surface: vertices about c; at least one triangle, every index valid, coordinates finite.
MomentTree build_moment_tree(const TriangleMesh& surface);

}  // namespace buoyancy
