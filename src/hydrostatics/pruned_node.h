// What a node of the moment tree contributes while it is undecided: the water may cross it, but it is not
// looked into.
//
// The pressure of a point at height z is min(z, 0). Over a node whose heights lie in [-below, above] it is
// replaced by polynomials that the node's moments integrate without its triangles. With
// s = below / (below + above) and d = max(below, above)
//   the line      p1(z) = s (z - above / 2)              is off by at most s above / 2,
//   the parabola  p2(z) = z / 2 - z^2 / (2 d) - d / 16   by at most d / 16.
// The volume and the lever of the node's middle y_m take p2, which is up to four times as good; what the
// node's points are away from its middle, up to `radius`, takes p1, since the moments know no third powers of
// y:
//   int z y n_a dA  ~  y_m int p2 n_a dA + int (y - y_m) p1 n_a dA.
// With q = 1/|k_a| int |n_a| dA volume is then wrong by at most q d / 16. Torque about any point is wrong by
// that times L_r, by q s above / 2 times the radius, and by what the height's integral H takes along: the
// read-out divides it by k_a and crosses the axis with k, at most sqrt 2 times its error, half of (height of
// y_m) q d / 16 + radius q s above / 2. As L_r >= L / 2 and y_m is no higher than d / 2, both are within e
// and e L_r with
//   e = (d / 16 (1 + 0.36 d / (L / 2)) + s above / 2 (1.71 radius / (L / 2))) q;
// where the line serves both, with (s above / 2) (1 + 0.71 d / (L / 2)) q. Whichever is less is taken
// (docs/mathematics.md, "Tolerance").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/moment_tree.h"

namespace buoyancy {

// Nodes that the water may cross, side by side. Whole vectors are read and written: there is room for some
// more than there are.
struct PrunableNodes {
  static constexpr std::size_t kMore = 16;

  std::size_t size = 0;
  std::vector<std::uint32_t> child;          // as in TreeNode
  std::vector<std::uint32_t> moments;        // index of their own
  std::vector<float> below, above;           // m, >= 0
  std::vector<float> error;                  // m^3: e
  std::vector<float> curved;                 // 1: with a parabola; 0: the line serves both
  std::array<std::vector<float>, 3> center;  // m, about c: of their bounds

  std::array<std::vector<std::uint32_t>*, 2> indices() { return {&child, &moments}; }
  std::array<std::vector<float>*, 7> numbers() {
    return {&below, &above, &error, &curved, &center[0], &center[1], &center[2]};
  }

  void make_room(std::size_t nodes) {
    if (child.size() >= nodes + kMore) return;
    for (auto* const list : indices()) list->resize(nodes + kMore);
    for (auto* const list : numbers()) list->resize(nodes + kMore);
  }
};

// What a descent within a budget writes down, kept by each thread: a level holds every node at most once.
struct BudgetLists {
  std::vector<std::uint32_t> inner, next_inner;  // nodes to look into
  PrunableNodes open;                           // their children that the water may cross

  // Each on its own: of two trees one may have more nodes and the other more inner ones.
  void make_room(const MomentTree& tree) {
    const std::size_t inners = tree.nodes.size() + kTreeWidth;
    if (inner.size() < inners) inner.resize(inners);
    if (next_inner.size() < inners) next_inner.resize(inners);
    open.make_room(tree.moments.size());
  }
};

}  // namespace buoyancy
