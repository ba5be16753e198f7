#include "hydrostatics/wetted_tree_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "hydrostatics/pruned_node.h"

// The reference without SIMD is Highway's scalar target with every compiler; by default some compilers use
// its emulation of two lanes instead.
#define HWY_BROKEN_EMU128 1
// AVX-512 is compiled in two stages: later processors compress 16-bit words in one instruction.
#define HWY_WANT_AVX3_DL 1

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/wetted_tree_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hydrostatics/leaf_kernels-inl.h"
#include "hydrostatics/node_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace hydrostatics {

template <typename T>
HWY_INLINE void prefetch(const T& item) {
  const auto* const line = reinterpret_cast<const unsigned char*>(&item);
  for (std::size_t byte = 0; byte < sizeof(T); byte += 64) __builtin_prefetch(line + byte);
}

// Common part of both descents. Leaves and nodes to add are queued and evaluated when a queue is full, so
// that memory is fetched for many at once.
class Descent {
 public:
  HWY_INLINE Descent(const MomentTree& tree, const TreeQuery& query, WettedTreeSum& sum)
      : tree_(tree),
        query_(query),
        sum_(sum),
        bounds_(make_bounds_query(tree, query)),
        moments_(tree.moments[query.axes[0]].data()),
        batch_(query, tree.grid) {}

  // Expands a node exactly. Returns the number of children written to `inner`, which are prefetched.
  HWY_INLINE std::size_t expand(const TreeNode& node, std::uint32_t* inner) {
    const ChildMasks masks = test_children(node, bounds_);
    add_wet(node, masks.wet);
    const std::uint32_t crossing = masks.crossing & inner_bits(node);
    num_leaves_ += append_places((masks.crossing ^ crossing) >> node.inner_nodes, node.first_leaf,
                                 leaf_queue_.data() + num_leaves_);
    const std::size_t count = append_places(crossing, node.first_node, inner);
    for (std::size_t i = 0; i < count; ++i) prefetch(tree_.nodes[inner[i]]);
    visited();
    return count;
  }

  // Expands node n and appends the children that the water may cross to `open`.
  HWY_INLINE void expand(std::uint32_t n, PrunableNodes& open) {
    const TreeNode& node = tree_.nodes[n];
    PrunableChildren children;
    const ChildMasks masks = test_children(node, tree_.projected_areas[n], bounds_, query_.axes[0], children);
    add_wet(node, masks.wet);
    append_prunable(node, masks.crossing, children, open);
    visited();
  }

  // The mask selects some of eight elements of PrunableNodes::child. Queues the leaves among them, writes the
  // others to `inner` and returns the number of the latter.
  HWY_INLINE std::size_t add_open(const std::uint32_t* children, std::uint32_t mask, std::uint32_t* inner) {
    const std::uint32_t leaves = mask & leaf_bits(children);
    const std::size_t count = append(children, leaves, leaf_queue_.data() + num_leaves_);
    for (std::size_t i = 0; i < count; ++i) leaf_queue_[num_leaves_ + i] -= PrunableNodes::kLeafBit;
    num_leaves_ += count;
    drain_if_full();
    return append(children, mask & ~leaves, inner);
  }

  // error: [m^3], total of all of these nodes.
  HWY_INLINE void add_pruned(const PrunableNodes& nodes, double error, PrunedSums& sums) {
    sums.add(moments_, nodes, node_sums_);
    sum_.pruned.error += error;
    sum_.nodes_pruned += static_cast<std::int64_t>(nodes.size);
  }

  // Queues the leaf of a tree that has only one: its vertices decide no later than its bounds.
  HWY_INLINE void add_only_leaf() { leaf_queue_[num_leaves_++] = 0; }

  HWY_INLINE void finish() {
    drain();
    leaf_sums_.finish(sum_);
    node_sums_.finish(sum_.nodes);
  }

 private:
  static constexpr std::size_t kQueue = 256;
  static constexpr std::size_t kAhead = 12;  // leaves

  HWY_INLINE void add_wet(const TreeNode& node, std::uint32_t mask) {
    num_wet_ += append_places(mask, node.first_moments, wet_queue_.data() + num_wet_);
  }

  HWY_INLINE void visited() {
    sum_.nodes_visited += 1;
    drain_if_full();
  }

  // Must be called whenever up to eight children were added.
  HWY_INLINE void drain_if_full() {
    if (num_leaves_ >= kQueue || num_wet_ >= kQueue) drain();
  }

  HWY_INLINE void drain() {
    if (tree_.leaves.empty()) {
      drain(tree_.double_leaves.data());
    } else {
      drain(tree_.leaves.data());
    }
  }

  // Not inlined: it runs once per query for all but the longest waterlines.
  template <typename Leaf>
  HWY_NOINLINE void drain(const Leaf* leaves) {
    sum_.leaves_clipped += static_cast<std::int64_t>(num_leaves_);
    sum_.nodes_added += static_cast<std::int64_t>(num_wet_);
    for (std::size_t i = 0; i < num_wet_; ++i) AxisVectors::prefetch(moments_[wet_queue_[i]]);
    for (std::size_t i = 0; i < std::min(kAhead, num_leaves_); ++i) prefetch(leaves[leaf_queue_[i]]);
    for (std::size_t first = 0; first < num_leaves_; first += LeafBatch::kCapacity) {
      const std::size_t end = std::min(num_leaves_, first + LeafBatch::kCapacity);
      batch_.clear();
      for (std::size_t i = first; i < end; ++i) {
        if (i + kAhead < num_leaves_) prefetch(leaves[leaf_queue_[i + kAhead]]);
        const Leaf& leaf = leaves[leaf_queue_[i]];
        queue_wet(leaf, batch_.add(leaf));
      }
      for (std::size_t i = 0; i < batch_.cut_leaves(); ++i)
        queue_wet(batch_.leaf(i), batch_.template prepare<Leaf>(i));
      leaf_sums_.add(batch_, query_.axes, tree_.grid);
      if (num_wet_ >= kQueue) add_queued();
    }
    add_queued();
    num_leaves_ = 0;
  }

  HWY_INLINE void queue_wet(const LeafPatch& leaf, bool wet) {
    wet_queue_[num_wet_] = leaf.moments;
    num_wet_ += static_cast<std::size_t>(wet);
  }

  HWY_INLINE void add_queued() {
    node_sums_.add(moments_, wet_queue_.data(), num_wet_);
    num_wet_ = 0;
  }

  const MomentTree& tree_;
  const TreeQuery& query_;
  WettedTreeSum& sum_;
  BoundsQuery bounds_;
  const AxisMoments* moments_;
  LeafBatch batch_;
  LeafSums leaf_sums_;
  AxisSums node_sums_;
  std::size_t num_leaves_ = 0, num_wet_ = 0;
  std::array<std::uint32_t, kQueue + kTreeWidth> leaf_queue_;
  std::array<std::uint32_t, kQueue + 2 * LeafBatch::kCapacity + kTreeWidth> wet_queue_;
};

// Expands every node that the water crosses below the given ones, of which there are at most kTreeWidth:
// level by level while levels are small, and otherwise depth first, many nodes at a time. A node is
// prefetched when it is found, so that its memory arrives while others are expanded.
HWY_INLINE void descend_exactly(const MomentTree& tree, const std::uint32_t* nodes, std::size_t count,
                                Descent& descent) {
  constexpr std::size_t kTogether = 64;
  // Nodes of a level are added only when no deeper ones remain: a level holds at most kTogether kTreeWidth.
  std::array<std::uint32_t, (kMaxTreeLevels * kTogether + 1) * kTreeWidth> stack;
  std::array<std::uint32_t, kTogether> together;
  std::copy_n(nodes, count, stack.data());
  std::size_t depth = count;
  while (depth > 0) {
    count = std::min(depth, kTogether);
    depth -= count;
    std::copy_n(stack.data() + depth, count, together.data());
    for (std::size_t i = 0; i < count; ++i) {
      depth += descent.expand(tree.nodes[together[i]], stack.data() + depth);
    }
  }
}

void sum_exactly(const MomentTree& tree, const TreeQuery& query, WettedTreeSum& sum) {
  Descent descent(tree, query, sum);
  const std::uint32_t root = 0;
  if (tree.num_leaves() == 1) {
    descent.add_only_leaf();
  } else {
    descend_exactly(tree, &root, 1, descent);
  }
  descent.finish();
}

// Keeps the open nodes whose error is within the limit, queues the leaves among the others and appends the
// rest to `inner`. Returns the total error of the nodes kept, [m^3].
HWY_INLINE double keep_within(float limit, PrunableNodes& open, std::uint32_t* inner, std::size_t& inners,
                              Descent& descent) {
  const Reals d;
  const hn::Rebind<float, Reals> narrow;
  const std::size_t nodes = open.size;
  auto kept = hn::Zero(d);
  open.size = 0;
  for (std::size_t first = 0; first < nodes; first += kTreeWidth) {
    std::uint32_t within = 0;
    for (std::size_t i = 0; i < kTreeWidth; i += hn::Lanes(d)) {
      const auto error = hn::LoadU(narrow, open.error.data() + first + i);
      const auto fits = hn::Le(error, hn::Set(narrow, limit));
      within |= mask_bits(narrow, fits) << i;
      kept = hn::Add(kept, hn::PromoteTo(d, hn::IfThenElseZero(fits, error)));
    }
    const std::uint32_t present = first_bits(nodes - first);
    inners += descent.add_open(open.child.data() + first, present & ~within, inner + inners);
    keep_prunable(open, first, present & within);
  }
  return sum_of_lanes(kept);
}

// Descends level by level: as soon as the total error of the open nodes fits into the remaining budget, all
// of them are pruned. Until then some are pruned (limit_to_errors) and the others are expanded. A level is
// examined for nodes to prune only if that may succeed: the total error falls about eightfold from a level to
// the next.
void sum_within_budget(const MomentTree& tree, const TreeQuery& query, BudgetLists& lists,
                       WettedTreeSum& sum) {
  constexpr double kErrorDecay = 8.0;     // total error of a level over that of the next
  constexpr double kMaxErrorRatio = 6.0;  // total error over remaining budget; above, too few would be pruned
  Descent descent(tree, query, sum);
  PrunableNodes& open = lists.open;
  std::uint32_t* inner = lists.inner.data();
  std::uint32_t* next_inner = lists.next_inner.data();
  std::size_t to_expand = 0;
  const TreeNode& root = tree.nodes[0];
  open.size = 0;
  descent.expand(0, open);
  double left = query.budget;
  ErrorSurvey survey = survey_errors(open, left);
  // Errors are proportional to the square of the size of the nodes, hence to one over their number.
  const double per_leaf = static_cast<double>(root.children) / static_cast<double>(tree.num_leaves());
  if (survey.all * per_leaf > kMaxErrorRatio * left) {
    to_expand = descent.add_open(open.child.data(), first_bits(open.size), inner);
    descend_exactly(tree, inner, to_expand, descent);
    descent.finish();
    return;
  }

  PrunedSums pruned(query);
  double error = 0.0;  // [m^3], total of the nodes that were not pruned, or its estimate
  for (;;) {
    double kept = survey.all;
    if (kept > left) {
      const float limit = limit_to_errors(survey, open.size, left);
      kept = keep_within(limit, open, next_inner, to_expand, descent);
      error += survey.all - kept;
    }
    left -= kept;
    descent.add_pruned(open, kept, pruned);
    if (to_expand == 0) break;

    std::swap(inner, next_inner);
    const std::size_t count = std::exchange(to_expand, 0);
    const bool may_fit = error <= kErrorDecay * kMaxErrorRatio * left;
    error = may_fit ? 0.0 : error / kErrorDecay;
    open.size = 0;
    if (may_fit) {
      for (std::size_t i = 0; i < count; ++i) {
        prefetch(tree.nodes[inner[i]]);
        prefetch(tree.projected_areas[inner[i]]);
      }
      for (std::size_t i = 0; i < count; ++i) descent.expand(inner[i], open);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        to_expand += descent.expand(tree.nodes[inner[i]], next_inner + to_expand);
      }
    }
    survey = survey_errors(open, left);
  }
  pruned.finish(sum.pruned);
  descent.finish();
}

}  // namespace hydrostatics

using hydrostatics::sum_exactly;
using hydrostatics::sum_within_budget;

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(sum_exactly);
HWY_EXPORT(sum_within_budget);

WettedTreeSum sum_wetted_tree(const MomentTree& tree, const TreeQuery& query) {
  WettedTreeSum sum;
  if (query.budget > 0.0) {
    thread_local BudgetLists lists;
    lists.reserve(tree);
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
