// The moment tree: a bounding-volume tree over a closed surface whose nodes know the surface moments of all
// that is below them, so that a wholly wet node is answered by one addition and a dry one by nothing.
//
// Flat and wide: inner nodes of up to eight children whose bounds lie side by side in float32, rounded
// outward; leaves of up to 16 triangles that index their own up to 16 vertices. Three arrays, no pointers.
// Built once per mesh and scale, never changed, shared by all bodies and threads.
//
// Coordinates are about the mesh's centre c. Moments are stored about c, not about each node's own centre:
// adding a node then needs no move, 30 additions instead of some 150 operations, and the rounding it costs,
// eps times (largest distance from c) times (area of what is wet), is a fraction of the gate G_V
// (docs/mathematics.md, "The moment tree"). What must be local is local: a leaf's vertices are about the
// leaf's own centre, so that the height of a vertex is rounded relative to the leaf's size and not to the
// body's.
//
// Build: O(n log n), below 1 us per triangle. Memory: about 60 B per triangle. Query: see hierarchical.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/surface_moments.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr int kTreeWidth = 8;       // children per inner node
inline constexpr int kLeafTriangles = 16;  // at most
inline constexpr int kLeafVertices = 16;   // at most

// The 30 surface moments of a node about c, S (3), N (9) and P (18), then the area of its triangles and
// padding: eight vectors of four doubles.
struct alignas(64) NodeMoments {
  static constexpr int kCount = 32;
  static constexpr int kArea = 30;
  std::array<double, kCount> values{};

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
  // For descents that stop early; the exact one reads none of it. Upper halves of float32, of child
  // i's surface, m^2: its area, and so that int |n . k| dA <= |oriented . k| + spread for any unit k.
  std::array<std::uint16_t, kTreeWidth> area;
  alignas(64) std::array<std::uint16_t, kTreeWidth> oriented_x, oriented_y, oriented_z;
  std::array<std::uint16_t, kTreeWidth> spread;

  static constexpr std::uint32_t kLeafBit = 0x80000000U;
};

// A patch of the surface. Unused vertices repeat the first; unused triangles are (0, 0, 0) and enclose
// nothing.
struct alignas(64) TreeLeaf {
  std::array<double, kLeafVertices> x, y, z;  // m, about `center`
  std::array<std::uint8_t, kLeafTriangles> a, b, c;
  std::array<double, 3> center;  // m, about c; whole multiples of MomentTree::grid
  std::uint32_t moments;         // index of its own
  std::uint8_t vertices;
  std::uint8_t triangles;
  // m^2: what rounding takes its share of, times eps L, while the water crosses the leaf: its triangles are
  // projected on the water about c, so that their areas are off by eps L times their edges, whatever is left
  // of the area.
  float rounding;
};

struct MomentTree {
  std::vector<TreeNode> nodes;       // nodes[0] is the root
  std::vector<TreeLeaf> leaves;      // in the order of a depth-first walk
  std::vector<NodeMoments> moments;  // of every child of every node
  NodeMoments total;                 // of the whole surface
  double rounding = 0.0;             // m^2: of all leaves
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
