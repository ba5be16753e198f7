#include "hydrostatics/wet_tree_sum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "hydrostatics/undecided_node.h"

// The twin without SIMD is Highway's scalar target with every compiler, and not, with some, its emulation of
// two lanes.
#define HWY_BROKEN_EMU128 1

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/wet_tree_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hydrostatics/leaf_kernels-inl.h"
#include "hydrostatics/node_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

HWY_INLINE void prefetch_node(const TreeNode& node) {
  const auto* const line = reinterpret_cast<const unsigned char*>(&node);
  for (std::size_t byte = 0; byte < sizeof(TreeNode); byte += 64) __builtin_prefetch(line + byte);
}

// What both descents share. Found nodes and leaves are queued and used when a queue is full: memory is then
// fetched for many at once.
class Descent {
 public:
  HWY_INLINE Descent(const MomentTree& tree, const TreeQuery& query, WetTreeSum& sum)
      : tree_(tree), query_(query), sum_(sum), bounds_(make_bounds_query(tree, query)) {}

  HWY_INLINE const BoundsQuery& bounds() const { return bounds_; }

  HWY_INLINE void add_wet(const TreeNode& node, std::uint32_t mask) {
    wets_ += append_places(mask, node.first_moments, wet_queue_.data() + wets_);
  }

  // Queues those of a node's children in the mask that are leaves, and writes the others to `inner`: how
  // many.
  HWY_INLINE std::size_t add_crossing(const TreeNode& node, std::uint32_t mask, std::uint32_t* inner) {
    const std::uint32_t leaves = mask & leaf_children(node);
    leaves_ += append_children(node, leaves, leaf_queue_.data() + leaves_);
    return append_children(node, mask & ~leaves, inner);
  }

  HWY_INLINE void prefetch_moments(std::uint32_t index) const {
    const NodeMoments& moments = tree_.moments[index];
    for (std::size_t i = 0; i < NodeMoments::kCount; i += 8) __builtin_prefetch(moments.values.data() + i);
  }

  // leaf: with kLeafBit.
  HWY_INLINE void clip(std::uint32_t leaf) { leaf_queue_[leaves_++] = leaf; }

  // After every node.
  HWY_INLINE void make_room() {
    sum_.nodes_visited += 1;
    if (leaves_ >= kQueue || wets_ >= kQueue) drain();
  }

  // Not inlined: once per query for all but the largest waterlines.
  HWY_NOINLINE void drain() {
    sum_.leaves_clipped += static_cast<std::int64_t>(leaves_);
    sum_.nodes_added += static_cast<std::int64_t>(wets_);
    for (std::size_t i = 0; i < wets_; ++i) prefetch_moments(wet_queue_[i]);
    for (std::size_t i = 0; i < std::min(kAhead, leaves_); ++i) prefetch_leaf(leaf_queue_[i]);
    for (std::size_t i = 0; i < leaves_; ++i) {
      if (i + kAhead < leaves_) prefetch_leaf(leaf_queue_[i + kAhead]);
      const TreeLeaf& leaf = tree_.leaves[leaf_queue_[i] & ~TreeNode::kLeafBit];
      if (leaf_sums_.add(leaf, query_) == LeafOutcome::kAddLeaf) wet_queue_[wets_++] = leaf.moments;
      if (wets_ == wet_queue_.size()) add_queued();
    }
    add_queued();
    leaves_ = 0;
  }

  HWY_INLINE void prefetch_undecided(const UndecidedNode& node) const {
    prefetch_moments(tree_.nodes[node.parent].first_moments + node.place);
  }

  HWY_INLINE void add_undecided(const UndecidedNode& node, const CurvatureWeights& weights) {
    const TreeNode& parent = tree_.nodes[node.parent];
    const NodeMoments& moments = tree_.moments[parent.first_moments + node.place];
    const bool curved = node.error < node.line_error;
    const PressureFit fit =
        fit_pressure(static_cast<double>(node.below), static_cast<double>(node.above), curved);
    node_sums_.add_weighted(moments, fit.slope);
    offset_sums_.add_weighted(moments, fit.offset);
    if (curved) {
      const double volume = weights.integral(moments, fit);
      sum_.undecided.volume += volume;
      sum_.undecided.moment[0] += volume * static_cast<double>(parent.center_x[node.place]);
      sum_.undecided.moment[1] += volume * static_cast<double>(parent.center_y[node.place]);
      sum_.undecided.moment[2] += volume * static_cast<double>(parent.center_z[node.place]);
    }
    sum_.undecided.error += static_cast<double>(node.error);
    sum_.nodes_undecided += 1;
  }

  HWY_INLINE void finish() {
    drain();
    leaf_sums_.finish(sum_);
    node_sums_.finish(sum_.wet_nodes);
    if (query_.budget > 0.0) offset_sums_.finish(sum_.undecided.offsets);
  }

 private:
  static constexpr std::size_t kQueue = 256;
  static constexpr std::size_t kAhead = 8;  // leaves
  HWY_INLINE void prefetch_leaf(std::uint32_t leaf) const {
    const auto* const line =
        reinterpret_cast<const unsigned char*>(&tree_.leaves[leaf & ~TreeNode::kLeafBit]);
    for (std::size_t byte = 0; byte < sizeof(TreeLeaf); byte += 64) __builtin_prefetch(line + byte);
  }

  HWY_INLINE void add_queued() {
    node_sums_.add(tree_.moments, wet_queue_.data(), wets_);
    wets_ = 0;
  }

  const MomentTree& tree_;
  const TreeQuery& query_;
  WetTreeSum& sum_;
  BoundsQuery bounds_;
  LeafSums leaf_sums_;
  NodeSums<NodeMoments::kCount> node_sums_;
  NodeSums<kOffsetMoments> offset_sums_;
  std::size_t leaves_ = 0, wets_ = 0;
  std::array<std::uint32_t, kQueue + kTreeWidth> leaf_queue_;
  std::array<std::uint32_t, kQueue + kTreeWidth> wet_queue_;
};

// Depth first: every node that the water crosses is looked into.
void sum_exactly(const MomentTree& tree, const TreeQuery& query, WetTreeSum& sum) {
  constexpr std::size_t kStack = 256;
  std::array<std::uint32_t, kStack + kTreeWidth> stack;
  std::size_t depth = 0;
  Descent descent(tree, query, sum);
  stack[depth++] = 0;
  while (depth > 0) {
    const TreeNode& node = tree.nodes[stack[--depth]];
    const ChildMasks masks = test_children(node, descent.bounds());
    descent.add_wet(node, masks.wet);
    const std::size_t found = descent.add_crossing(node, masks.crossing, stack.data() + depth);
    for (std::size_t i = 0; i < found; ++i) prefetch_node(tree.nodes[stack[depth + i]]);
    depth += found;
    assert(depth <= kStack);
    descent.make_room();
  }
  descent.finish();
}

// Level by level: as soon as all that is undecided fits into what is left of the budget, it stays so. Until
// then each node has an equal share: those that need less stay undecided, the others are looked into.
void sum_within_budget(const MomentTree& tree, const TreeQuery& query, UndecidedNode* level,
                       UndecidedNode* next, WetTreeSum& sum) {
  Descent descent(tree, query, sum);
  const CurvatureWeights weights(query);
  std::size_t found = 0;
  double found_error = 0.0;
  const auto look_into = [&](std::uint32_t index, UndecidedNode* into) {
    const TreeNode& node = tree.nodes[index];
    UndecidedChildren children;
    const ChildMasks masks = test_children(node, descent.bounds(), children);
    descent.add_wet(node, masks.wet);
    for (std::uint32_t rest = masks.crossing; rest != 0; rest &= rest - 1) {
      const auto place = static_cast<std::uint32_t>(__builtin_ctz(rest));
      into[found++] = {node.child[place],
                       index,
                       place,
                       children.below[place],
                       children.above[place],
                       children.error[place],
                       children.line_error[place]};
      found_error += static_cast<double>(children.error[place]);
    }
    descent.make_room();
  };

  double left = query.budget;
  look_into(0, level);
  while (found > 0) {
    const bool all_fit = found_error <= left;
    const auto share = static_cast<float>(0.999999 * left / static_cast<double>(found));
    // First decide and fetch, then use: memory answers many at once.
    std::size_t to_look_into = 0;
    std::size_t undecided = 0;
    for (std::size_t i = 0; i < found; ++i) {
      UndecidedNode node = level[i];
      if (!all_fit && node.line_error <= share) node.error = node.line_error;
      if (all_fit || node.error <= share) {
        descent.prefetch_undecided(node);
        next[undecided++] = node;
      } else if ((node.child & TreeNode::kLeafBit) != 0) {
        descent.clip(node.child);
        descent.make_room();
      } else {
        prefetch_node(tree.nodes[node.child]);
        level[to_look_into++] = node;
      }
    }
    for (std::size_t i = 0; i < undecided; ++i) {
      left -= static_cast<double>(next[i].error);
      descent.add_undecided(next[i], weights);
    }
    found = 0;
    found_error = 0.0;
    for (std::size_t i = 0; i < to_look_into; ++i) look_into(level[i].child, next);
    std::swap(level, next);
  }
  descent.finish();
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(sum_exactly);
HWY_EXPORT(sum_within_budget);

WetTreeSum sum_wet_tree(const MomentTree& tree, const TreeQuery& query) {
  WetTreeSum sum;
  if (query.budget > 0.0) {
    // A level holds every node at most once.
    thread_local std::vector<UndecidedNode> level;
    thread_local std::vector<UndecidedNode> next;
    if (level.size() < tree.moments.size()) {
      level.resize(tree.moments.size());
      next.resize(tree.moments.size());
    }
    HWY_DYNAMIC_DISPATCH(sum_within_budget)(tree, query, level.data(), next.data(), sum);
  } else {
    HWY_DYNAMIC_DISPATCH(sum_exactly)(tree, query, sum);
  }
  return sum;
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

std::string simd_target() {
  const int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

bool force_simd_target(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  bool known = name.empty();
  if (!known) {
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      if (name == hwy::TargetName(target)) {
        hwy::SetSupportedTargetsForTest(target);
        known = true;
        break;
      }
    }
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return known;
}

}  // namespace buoyancy
#endif  // HWY_ONCE
