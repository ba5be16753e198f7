// The contribution of a pruned node of the moment tree: the water may cross it, but the descent stops at it.
//
// The pressure of a point at height z is min(z, 0). Over a node whose heights lie in [-below, above] it is
// replaced by polynomials that the node's moments integrate without its triangles. With
// s = below / (below + above) and d = max(below, above)
//   the line      p1(z) = s (z - above / 2)              has an error of at most s above / 2,
//   the parabola  p2(z) = z / 2 - z^2 / (2 d) - d / 16   has an error of at most d / 16.
// The volume and the lever of the node's centre y_m take p2, whose error is up to four times smaller; the
// offsets of the node's points from its centre, up to `radius`, take p1, since the moments include no third
// powers of y:
//   int z y n_a dA  ~  y_m int p2 n_a dA + int (y - y_m) p1 n_a dA.
// With q = 1/|k_a| int |n_a| dA the error of the volume is then at most q d / 16. The error of the torque
// about any point is at most the sum of that times L_r, of q s above / 2 times the radius, and of the
// contribution of the height's integral H: the conversion to volume integrals divides H by k_a and takes the
// cross product of the axis with k, which gives at most sqrt 2 times the error of H, which is half of
// ((height of y_m) q d / 16 + radius q s above / 2). Since L_r >= L / 2 and the height of y_m is at most
// d / 2, both errors are within e and e L_r with
//   e = (d / 16 (1 + 0.36 d / (L / 2)) + s above / 2 (1.71 radius / (L / 2))) q;
// if p1 replaces p2 as well, with e = (s above / 2) (1 + 0.71 d / (L / 2)) q. The smaller of the two is used
// (docs/mathematics.md, "Tolerance").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/moment_tree.h"

namespace buoyancy {

// Nodes that the water may cross, as a structure of arrays. Whole vectors are read and written, so each array
// has kPadding more elements than nodes.
struct PrunableNodes {
  static constexpr std::size_t kPadding = 16;

  static constexpr std::uint32_t kLeafBit = 0x80000000U;

  std::size_t size = 0;
  std::vector<std::uint32_t> child;          // index of an inner node, or kLeafBit + index of a leaf
  std::vector<std::uint32_t> moments;        // index of the node's moments
  std::vector<float> below, above;           // [m], >= 0
  std::vector<float> error;                  // [m^3], e
  std::vector<float> curved;                 // 1: with p2; 0: with p1 alone
  std::array<std::vector<float>, 3> center;  // [m], about c: of the node's bounds

  std::array<std::vector<std::uint32_t>*, 2> indices() { return {&child, &moments}; }
  std::array<std::vector<float>*, 7> numbers() {
    return {&below, &above, &error, &curved, &center[0], &center[1], &center[2]};
  }

  void reserve(std::size_t nodes) {
    if (child.size() >= nodes + kPadding) return;
    for (auto* const list : indices()) list->resize(nodes + kPadding);
    for (auto* const list : numbers()) list->resize(nodes + kPadding);
  }
};

// A thread's working memory for descents within a budget. Its lists have room for every node of a tree.
struct BudgetLists {
  std::vector<std::uint32_t> inner, next_inner;  // nodes to expand
  PrunableNodes open;                            // their children that the water may cross

  // Checks each list on its own: of two trees one may have more children and the other more inner nodes.
  void reserve(const MomentTree& tree) {
    const std::size_t inners = tree.nodes.size() + kTreeWidth;
    if (inner.size() < inners) inner.resize(inners);
    if (next_inner.size() < inners) next_inner.resize(inners);
    open.reserve(tree.areas.size());
  }
};

}  // namespace buoyancy
