#include "hydrostatics/wet_tree_sum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

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

// As far as a descent reads it.
HWY_INLINE void prefetch_node(const TreeNode& node, std::size_t bytes) {
  const auto* const line = reinterpret_cast<const unsigned char*>(&node);
  for (std::size_t byte = 0; byte < bytes; byte += 64) __builtin_prefetch(line + byte);
}

// What both descents share. Found nodes and leaves are queued and used when a queue is full: memory is then
// fetched for many at once.
class Descent {
 public:
  HWY_INLINE Descent(const MomentTree& tree, const TreeQuery& query, WetTreeSum& sum)
      : tree_(tree),
        query_(query),
        sum_(sum),
        bounds_(make_bounds_query(tree, query)),
        node_sums_(query.axes[0]),
        offset_sums_(query.axes[0]) {}

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
    const double* const values = tree_.moments[index].values.data();
    __builtin_prefetch(values + NodeMoments::kInLine * query_.axes[0]);
    __builtin_prefetch(values + NodeMoments::kLastLine);
  }

  // leaf: with kLeafBit.
  HWY_INLINE void clip(std::uint32_t leaf) {
    leaf_queue_[leaves_++] = leaf;
    make_room();
  }

  // After every node.
  HWY_INLINE void visited() {
    sum_.nodes_visited += 1;
    make_room();
  }

  // Not inlined: once per query for all but the largest waterlines.
  HWY_NOINLINE void drain() {
    sum_.leaves_clipped += static_cast<std::int64_t>(leaves_);
    sum_.nodes_added += static_cast<std::int64_t>(wets_);
    for (std::size_t i = 0; i < wets_; ++i) prefetch_moments(wet_queue_[i]);
    for (std::size_t i = 0; i < std::min(kAhead, leaves_); ++i) prefetch_leaf(leaf_queue_[i]);
    for (std::size_t first = 0; first < leaves_; first += LeafBatch::kRoom) {
      const std::size_t end = std::min(leaves_, first + LeafBatch::kRoom);
      batch_.clear();
      for (std::size_t i = first; i < end; ++i) {
        if (i + kAhead < leaves_) prefetch_leaf(leaf_queue_[i + kAhead]);
        const TreeLeaf& leaf = tree_.leaves[leaf_queue_[i] & ~TreeNode::kLeafBit];
        queue_wet(leaf, batch_.add(leaf, query_));
      }
      for (std::size_t i = 0; i < batch_.cut_leaves(); ++i) queue_wet(batch_.leaf(i), batch_.find_work(i));
      leaf_sums_.add(batch_, query_.axes);
      if (wets_ >= kQueue) add_queued();
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
      sum_.undecided.moment += volume * Vec3(parent.center_x[node.place], parent.center_y[node.place],
                                             parent.center_z[node.place]);
    }
    sum_.undecided.error += static_cast<double>(node.error);
    sum_.nodes_undecided += 1;
  }

  HWY_INLINE void finish() {
    drain();
    leaf_sums_.finish(sum_);
    node_sums_.finish(sum_.nodes);
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

  HWY_INLINE void make_room() {
    if (leaves_ >= kQueue || wets_ >= kQueue) drain();
  }

  HWY_INLINE void queue_wet(const TreeLeaf& leaf, bool wet) {
    wet_queue_[wets_] = leaf.moments;
    wets_ += static_cast<std::size_t>(wet);
  }

  HWY_INLINE void add_queued() {
    node_sums_.add(tree_.moments, wet_queue_.data(), wets_);
    wets_ = 0;
  }

  const MomentTree& tree_;
  const TreeQuery& query_;
  WetTreeSum& sum_;
  BoundsQuery bounds_;
  LeafBatch batch_;
  LeafSums leaf_sums_;
  AxisSums node_sums_;
  AxisSums offset_sums_;
  std::size_t leaves_ = 0, wets_ = 0;
  std::array<std::uint32_t, kQueue + kTreeWidth> leaf_queue_;
  std::array<std::uint32_t, kQueue + 2 * LeafBatch::kRoom + kTreeWidth> wet_queue_;
};

// Every node that the water crosses is looked into, the deepest first, some at a time: none of them waits for
// what the others lead to.
void sum_exactly(const MomentTree& tree, const TreeQuery& query, WetTreeSum& sum) {
  constexpr std::size_t kTogether = 8;
  // Nodes of a level are only found when none deeper are left: a level holds kTogether kTreeWidth at most.
  constexpr std::size_t kLevels = 16;
  constexpr std::size_t kRead = offsetof(TreeNode, projected_area);
  std::array<std::uint32_t, (kLevels * kTogether + 1) * kTreeWidth> stack;
  std::array<std::uint32_t, kTogether> together;
  std::size_t depth = 0;
  Descent descent(tree, query, sum);
  stack[depth++] = 0;
  while (depth > 0) {
    const std::size_t count = std::min(depth, kTogether);
    depth -= count;
    for (std::size_t n = 0; n < count; ++n) {
      together[n] = stack[depth + n];
      prefetch_node(tree.nodes[together[n]], kRead);
    }
    for (std::size_t n = 0; n < count; ++n) {
      const TreeNode& node = tree.nodes[together[n]];
      const ChildMasks masks = test_children(node, descent.bounds());
      descent.add_wet(node, masks.wet);
      depth += descent.add_crossing(node, masks.crossing, stack.data() + depth);
      assert(depth + kTreeWidth <= stack.size());
      descent.visited();
    }
  }
  descent.finish();
}

// m^3: the errors of all undecided leaves together, as far as the root's children tell. Errors go with the
// square of the size of the nodes, and so with one over their number.
double expected_of_leaves(const MomentTree& tree, const TreeQuery& query) {
  const TreeNode& root = tree.nodes[0];
  UndecidedChildren children;
  std::uint32_t rest = test_children(root, make_bounds_query(tree, query), query.axes[0], children).crossing;
  double error = 0.0;
  for (; rest != 0; rest &= rest - 1) {
    error += static_cast<double>(children.error[static_cast<std::size_t>(__builtin_ctz(rest))]);
  }
  return error * static_cast<double>(root.children) / static_cast<double>(tree.leaves.size());
}

// Level by level: as soon as all that is undecided fits into what is left of the budget, it stays so. Until
// then each node has an equal share: those that need less stay undecided, the others are looked into. What
// can stay undecided is only asked where there is hope: from a level to the next all errors together fall
// about eightfold, and undecided a leaf costs nearly as much as summed.
void sum_within_budget(const MomentTree& tree, const TreeQuery& query, BudgetLists& lists, WetTreeSum& sum) {
  constexpr double kFall = 8.0;
  constexpr double kHopeless = 4.0;  // times what is left: few nodes have an error below their share
  const std::size_t a = query.axes[0];
  if (expected_of_leaves(tree, query) > kHopeless * query.budget) {
    sum_exactly(tree, query, sum);
    return;
  }
  Descent descent(tree, query, sum);
  const CurvatureWeights weights(query);
  std::uint32_t* inner = lists.inner.data();
  std::uint32_t* next_inner = lists.next_inner.data();
  UndecidedNode* const open = lists.open.data();
  UndecidedNode* const undecided = lists.undecided.data();

  std::size_t to_look_into = 0;
  inner[to_look_into++] = 0;
  double left = query.budget;
  double error = std::numeric_limits<double>::infinity();  // of all to look into, or what may be expected
  while (to_look_into > 0) {
    std::size_t open_nodes = 0;
    std::size_t next_to_look_into = 0;
    double open_error = 0.0;
    const bool root = inner[0] == 0;
    const bool leaves_may_fit = root || error <= kFall * left;
    const bool nodes_may_fit = root || error <= kFall * kHopeless * left;
    for (std::size_t i = 0; i < to_look_into; ++i) prefetch_node(tree.nodes[inner[i]], sizeof(TreeNode));
    for (std::size_t i = 0; i < to_look_into; ++i) {
      const TreeNode& node = tree.nodes[inner[i]];
      const bool only_leaves = leaf_children(node) == present_children(node);
      if (only_leaves ? !leaves_may_fit : !nodes_may_fit) {
        const ChildMasks masks = test_children(node, descent.bounds());
        descent.add_wet(node, masks.wet);
        next_to_look_into += descent.add_crossing(node, masks.crossing, next_inner + next_to_look_into);
        descent.visited();
        continue;
      }
      UndecidedChildren children;
      const ChildMasks masks = test_children(node, descent.bounds(), a, children);
      descent.add_wet(node, masks.wet);
      for (std::uint32_t rest = masks.crossing; rest != 0; rest &= rest - 1) {
        const auto place = static_cast<std::uint32_t>(__builtin_ctz(rest));
        open[open_nodes++] = {node.child[place],
                              inner[i],
                              place,
                              children.below[place],
                              children.above[place],
                              children.error[place],
                              children.line_error[place]};
        open_error += static_cast<double>(children.error[place]);
      }
      descent.visited();
    }

    // First decide and fetch, then use: memory answers many at once.
    const bool all_fit = open_error <= left;
    const auto share = static_cast<float>(0.999999 * left / static_cast<double>(open_nodes));
    std::size_t decided = 0;
    error = nodes_may_fit ? 0.0 : error / kFall;
    for (std::size_t i = 0; i < open_nodes; ++i) {
      UndecidedNode node = open[i];
      if (!all_fit && node.line_error <= share) node.error = node.line_error;
      if (all_fit || node.error <= share) {
        descent.prefetch_undecided(node);
        undecided[decided++] = node;
      } else if ((node.child & TreeNode::kLeafBit) != 0) {
        descent.clip(node.child);
      } else {
        error += static_cast<double>(node.error);
        next_inner[next_to_look_into++] = node.child;
      }
    }
    for (std::size_t i = 0; i < decided; ++i) {
      left -= static_cast<double>(undecided[i].error);
      descent.add_undecided(undecided[i], weights);
    }
    to_look_into = next_to_look_into;
    std::swap(inner, next_inner);
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
    thread_local BudgetLists lists;
    lists.make_room(tree);
    HWY_DYNAMIC_DISPATCH(sum_within_budget)(tree, query, lists, sum);
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
