#include "hydrostatics/waterline_sum.h"

#include <algorithm>
#include <array>
#include <cstddef>

// wetted_tree_sum.cpp explains these definitions.
#define HWY_BROKEN_EMU128 1
#define HWY_WANT_AVX3_DL 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/waterline_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hydrostatics/leaf_kernels-inl.h"
#include "hydrostatics/node_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Sums over the edges of the waterline in cut leaves.
class EdgeSums {
 public:
  HWY_INLINE EdgeSums(const PlaneCoordinate& u, const PlaneCoordinate& v)
      : u_(u),
        v_(v),
        area_(hn::Zero(Reals())),
        first_u_(hn::Zero(Reals())),
        first_v_(hn::Zero(Reals())),
        uu_(hn::Zero(Reals())),
        uv_(hn::Zero(Reals())),
        vv_(hn::Zero(Reals())),
        min_u_(hn::Set(Reals(), std::numeric_limits<double>::infinity())),
        max_u_(hn::Neg(min_u_)),
        min_v_(min_u_),
        max_v_(max_u_) {}

  // center_b, center_c: of the leaf, in the tree's unit of length.
  HWY_INLINE void add(const LeafWork& work, const LeafBatch::Vertices& leaf, double center_b,
                      double center_c) {
    const Reals d;
    const auto start_u = hn::Set(d, u_.start + u_.b * center_b + u_.c * center_c);
    const auto start_v = hn::Set(d, v_.start + v_.b * center_b + v_.c * center_c);
    const auto zero = hn::Zero(d);
    for (std::size_t i = 0; i < work.num_cut; i += hn::Lanes(d)) {
      const CornerIndices at = corner_indices(work.cut.data() + i);
      const auto bp = look_up(leaf.b, at.p);
      const auto cp = look_up(leaf.c, at.p);
      const auto zp = look_up(leaf.z, at.p);
      const auto z_pq = hn::Sub(zp, look_up(leaf.z, at.q));
      const auto z_pr = hn::Sub(zp, look_up(leaf.z, at.r));
      // Unused lanes have the same corner three times. In used ones the heights differ, since one of them is
      // negative and the other is not.
      const auto is_used = hn::Ne(z_pq, zero);
      const auto to_q = hn::IfThenElseZero(is_used, hn::Div(zp, z_pq));
      const auto to_r = hn::IfThenElseZero(is_used, hn::Div(zp, z_pr));
      const auto b_q = hn::MulAdd(to_q, hn::Sub(look_up(leaf.b, at.q), bp), bp);
      const auto c_q = hn::MulAdd(to_q, hn::Sub(look_up(leaf.c, at.q), cp), cp);
      const auto b_r = hn::MulAdd(to_r, hn::Sub(look_up(leaf.b, at.r), bp), bp);
      const auto c_r = hn::MulAdd(to_r, hn::Sub(look_up(leaf.c, at.r), cp), cp);
      const auto along = [&](const PlaneCoordinate& axis, RealVector b, RealVector c, RealVector start) {
        return hn::MulAdd(hn::Set(d, axis.b), b, hn::MulAdd(hn::Set(d, axis.c), c, start));
      };
      const auto u_q = along(u_, b_q, c_q, start_u);
      const auto v_q = along(v_, b_q, c_q, start_v);
      const auto u_r = along(u_, b_r, c_r, start_u);
      const auto v_r = along(v_, b_r, c_r, start_v);
      // The edge leads from p-q to p-r where p is wet, and back where it is dry.
      const auto forward = hn::Sub(hn::Mul(u_q, v_r), hn::Mul(u_r, v_q));
      const auto w = hn::IfThenElse(hn::Lt(zp, zero), forward, hn::Neg(forward));
      const auto u_sum = hn::Add(u_q, u_r);
      const auto v_sum = hn::Add(v_q, v_r);
      area_ = hn::Add(area_, w);
      first_u_ = hn::MulAdd(w, u_sum, first_u_);
      first_v_ = hn::MulAdd(w, v_sum, first_v_);
      uu_ = hn::MulAdd(w, hn::MulAdd(u_q, u_sum, hn::Mul(u_r, u_r)), uu_);
      vv_ = hn::MulAdd(w, hn::MulAdd(v_q, v_sum, hn::Mul(v_r, v_r)), vv_);
      uv_ = hn::MulAdd(w, hn::MulAdd(u_q, hn::Add(v_q, v_sum), hn::Mul(u_r, hn::Add(v_r, v_sum))), uv_);
      widen(is_used, u_q, u_r, min_u_, max_u_);
      widen(is_used, v_q, v_r, min_v_, max_v_);
    }
  }

  HWY_INLINE void finish(WaterlineSum& sum) const {
    const Reals d;
    sum.area = sum_of_lanes(area_);
    sum.u = sum_of_lanes(first_u_);
    sum.v = sum_of_lanes(first_v_);
    sum.uu = sum_of_lanes(uu_);
    sum.uv = sum_of_lanes(uv_);
    sum.vv = sum_of_lanes(vv_);
    sum.min_u = hn::GetLane(hn::MinOfLanes(d, min_u_));
    sum.max_u = hn::GetLane(hn::MaxOfLanes(d, max_u_));
    sum.min_v = hn::GetLane(hn::MinOfLanes(d, min_v_));
    sum.max_v = hn::GetLane(hn::MaxOfLanes(d, max_v_));
  }

 private:
  HWY_INLINE static void widen(hn::Mask<Reals> is_used, RealVector a, RealVector b, RealVector& min,
                               RealVector& max) {
    min = hn::IfThenElse(is_used, hn::Min(min, hn::Min(a, b)), min);
    max = hn::IfThenElse(is_used, hn::Max(max, hn::Max(a, b)), max);
  }

  const PlaneCoordinate& u_;
  const PlaneCoordinate& v_;
  RealVector area_, first_u_, first_v_, uu_, uv_, vv_;
  RealVector min_u_, max_u_, min_v_, max_v_;
};

class WaterlineDescent {
 public:
  HWY_INLINE WaterlineDescent(const MomentTree& tree, const TreeQuery& query, const PlaneCoordinate& u,
                              const PlaneCoordinate& v)
      : tree_(tree),
        axes_(query.axes),
        bounds_(make_bounds_query(tree, query)),
        batch_(query, tree.grid),
        sums_(u, v) {}

  HWY_INLINE void run(WaterlineSum& sum) {
    // A node taken from the stack is replaced by at most kTreeWidth children, one level deeper.
    std::array<std::uint32_t, kMaxTreeLevels * kTreeWidth> stack;
    std::size_t depth = 1;
    stack[0] = 0;
    while (depth > 0) {
      const TreeNode& node = tree_.nodes[stack[--depth]];
      const std::uint32_t crossing = test_children(node, bounds_).crossing;
      const std::uint32_t inner = crossing & inner_bits(node);
      num_leaves_ += append_places((crossing ^ inner) >> node.inner_nodes, node.first_leaf,
                                   leaf_queue_.data() + num_leaves_);
      depth += append_places(inner, node.first_node, stack.data() + depth);
      if (num_leaves_ >= kQueue) drain();
    }
    drain();
    sums_.finish(sum);
  }

 private:
  static constexpr std::size_t kQueue = 64;

  HWY_INLINE void drain() {
    if (tree_.leaves.empty()) {
      drain(tree_.double_leaves.data());
    } else {
      drain(tree_.leaves.data());
    }
  }

  template <typename Leaf>
  HWY_NOINLINE void drain(const Leaf* leaves) {
    for (std::size_t first = 0; first < num_leaves_; first += LeafBatch::kCapacity) {
      const std::size_t end = std::min(num_leaves_, first + LeafBatch::kCapacity);
      batch_.clear();
      for (std::size_t i = first; i < end; ++i) batch_.add(leaves[leaf_queue_[i]]);
      for (std::size_t i = 0; i < batch_.cut_leaves(); ++i) batch_.template prepare<Leaf>(i);
      for (std::size_t i = 0; i < batch_.cut_leaves(); ++i) {
        const auto& center = batch_.leaf(i).center;
        sums_.add(batch_.work(i), batch_.vertices(i), tree_.grid * center[axes_[1]],
                  tree_.grid * center[axes_[2]]);
      }
    }
    num_leaves_ = 0;
  }

  const MomentTree& tree_;
  const std::array<std::size_t, 3>& axes_;
  BoundsQuery bounds_;
  LeafBatch batch_;
  EdgeSums sums_;
  std::size_t num_leaves_ = 0;
  std::array<std::uint32_t, kQueue + kTreeWidth> leaf_queue_;
};

void sum_edges(const MomentTree& tree, const TreeQuery& query, const PlaneCoordinate& u,
               const PlaneCoordinate& v, WaterlineSum& sum) {
  WaterlineDescent(tree, query, u, v).run(sum);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(sum_edges);

WaterlineSum sum_waterline(const MomentTree& tree, const TreeQuery& query, const PlaneCoordinate& u,
                           const PlaneCoordinate& v) {
  WaterlineSum sum;
  HWY_DYNAMIC_DISPATCH(sum_edges)(tree, query, u, v, sum);
  return sum;
}

}  // namespace buoyancy
#endif  // HWY_ONCE
