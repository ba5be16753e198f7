#include "hydrostatics/lowest_vertex.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace buoyancy {
namespace {

class LowestVertexSearch {
 public:
  LowestVertexSearch(const MomentTree& tree, const Vec3& up_B) : tree_(tree), up_B_(up_B) {
    visit(tree.nodes[0]);
  }

  double lowest() const { return lowest_; }

 private:
  // Visits the lowest children first, so that the others can be skipped.
  void visit(const TreeNode& node) {
    std::array<std::pair<double, std::uint32_t>, kTreeWidth> bounds;
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const double bound =
          up_B_.dot(tree_.center_of_child(node, i)) - up_B_.cwiseAbs().dot(tree_.half_of_child(node, i));
      std::size_t n = i;
      for (; n > 0 && bounds[n - 1].first > bound; --n) bounds[n] = bounds[n - 1];
      bounds[n] = {bound, i};
    }
    for (std::size_t n = 0; n < node.children; ++n) {
      const auto [bound, i] = bounds[n];
      if (bound >= lowest_) return;
      tree_.visit_child(node, i, [this](const auto& child) { visit(child); });
    }
  }

  template <typename Real>
  void visit(const TreeLeaf<Real>& leaf) {
    const double center = up_B_.dot(tree_.center(leaf.center));
    for (std::size_t i = 0; i < leaf.vertices; ++i) {
      lowest_ = std::min(lowest_, center + up_B_.dot(leaf.vertex(i)));
    }
  }

  const MomentTree& tree_;
  const Vec3& up_B_;
  double lowest_ = std::numeric_limits<double>::infinity();  // in the tree's unit of length
};

}  // namespace

double lowest_vertex(const MomentTree& tree, const Vec3& up_B) {
  return tree.scale * LowestVertexSearch(tree, up_B).lowest() + up_B.dot(tree.offset);
}

}  // namespace buoyancy
