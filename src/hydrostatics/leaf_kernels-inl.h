// The SIMD kernels for the leaves of the moment tree: they sum the wet parts of the triangles, many at a
// time. Included once per instruction set (wetted_tree_sum.cpp and waterline_sum.cpp), after highway.h.
#if defined(BUOYANCY_LEAF_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_LEAF_KERNELS_INL_H
#undef BUOYANCY_LEAF_KERNELS_INL_H
#else
#define BUOYANCY_LEAF_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "hydrostatics/leaf_corners-inl.h"
#include "hydrostatics/wetted_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A batch of leaves whose bounds cross the water: which of them it cuts, the heights of their vertices and
// the triangles to evaluate. Each step is done for all leaves before the next step: whether a leaf is cut
// cannot be predicted, a wrong prediction is expensive, and a processor looks ahead by only 100 to 200
// instructions.
class LeafBatch {
 public:
  static constexpr std::size_t kCapacity = 16;

  // One leaf's vertices: coordinates along b and c about its centre [m], and heights over the water [m].
  struct Vertices {
    VertexTable b, c, z;
  };

  HWY_INLINE LeafBatch(const TreeQuery& query, double grid)
      : axes_(query.axes), k_(query.k), start_high_(-query.h_high), start_low_(-query.h_low) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      k_high_[axis] = grid * query.k_high[axis];
      k_low_[axis] = grid * query.k_low[axis];
    }
  }

  HWY_INLINE std::size_t cut_leaves() const { return size_; }
  HWY_INLINE const LeafPatch& leaf(std::size_t i) const { return *leaf_[i]; }
  HWY_INLINE const Vertices& vertices(std::size_t i) const { return vertices_[i]; }
  HWY_INLINE const LeafWork& work(std::size_t i) const { return work_[i]; }

  HWY_INLINE void clear() { size_ = 0; }

  // Adds one of at most kCapacity leaves between calls of clear(). Returns true if it is fully submerged.
  template <typename Real>
  HWY_INLINE bool add(const TreeLeaf<Real>& leaf) {
    const double x = leaf.center[0];
    const double y = leaf.center[1];
    const double z = leaf.center[2];
    // z_high is exact: its terms are multiples of grid 2^-26, and fewer than 2^53 of them (TreeQuery).
    const double z_high = k_high_[0] * x + k_high_[1] * y + k_high_[2] * z + start_high_;
    const double z_low = k_low_[0] * x + k_low_[1] * y + k_low_[2] * z + start_low_;
    const std::uint32_t all = (1U << leaf.vertices) - 1U;
    const std::uint32_t wet = find_heights(leaf, z_high + z_low, vertices_[size_].z) & all;
    leaf_[size_] = &leaf;
    wet_[size_] = wet;
    const bool fully_submerged = wet == all;
    size_ += static_cast<std::size_t>(wet != 0) - static_cast<std::size_t>(fully_submerged);
    return fully_submerged;
  }

  // Finds the triangles to evaluate in cut leaf i, whose type is Leaf, and writes its vertices' coordinates
  // along b and c. Returns true if the wet part is the sum of those triangles and of the leaf's moments,
  // which the caller adds.
  template <typename Leaf>
  HWY_INLINE bool prepare(std::size_t i) {
    const Reals d;
    const auto& y = static_cast<const Leaf&>(*leaf_[i]).y;
    for (std::size_t n = 0; n < kLeafVertices; n += hn::Lanes(d)) {
      if (is_empty(*leaf_[i], n)) break;
      hn::Store(load(y[axes_[1]].data() + n), d, vertices_[i].b.values.data() + n);
      hn::Store(load(y[axes_[2]].data() + n), d, vertices_[i].c.values.data() + n);
    }
    find_work(*leaf_[i], wet_[i], work_[i]);
    return work_[i].subtract_from_leaf;
  }

 private:
  HWY_INLINE static RealVector load(const float* from) {
    return hn::PromoteTo(Reals(), hn::Load(hn::Rebind<float, Reals>(), from));
  }
  HWY_INLINE static RealVector load(const double* from) { return hn::LoadU(Reals(), from); }

  // True if the vector of vertices from n on holds none. With narrow vectors, some leaves fill only a few of
  // them; a branch for wide ones could not be predicted.
  HWY_INLINE static bool is_empty(const LeafPatch& leaf, std::size_t n) {
    return hn::Lanes(Reals()) < 8 && n >= leaf.vertices;
  }

  // Computes start + k . y of the leaf's vertices. Returns a bit for each vertex below the water; bits of
  // unused vertices are undefined.
  template <typename Real>
  HWY_INLINE std::uint32_t find_heights(const TreeLeaf<Real>& leaf, double start,
                                        VertexTable& heights) const {
    const Reals d;
    const auto x = hn::Set(d, k_[0]);
    const auto y = hn::Set(d, k_[1]);
    const auto z = hn::Set(d, k_[2]);
    const auto from = hn::Set(d, start);
    std::uint32_t wet = 0;
    for (std::size_t n = 0; n < kLeafVertices; n += hn::Lanes(d)) {
      if (is_empty(leaf, n)) break;
      const auto value = hn::MulAdd(
          x, load(leaf.y[0].data() + n),
          hn::MulAdd(y, load(leaf.y[1].data() + n), hn::MulAdd(z, load(leaf.y[2].data() + n), from)));
      hn::Store(value, d, heights.values.data() + n);
      wet |= mask_bits(d, hn::Lt(value, hn::Zero(d))) << n;
    }
    return wet;
  }

  const std::array<std::size_t, 3>& axes_;
  const std::array<double, 3>& k_;
  double start_high_, start_low_;         // [m], parts of the height of c
  std::array<double, 3> k_high_, k_low_;  // [m], parts of k times MomentTree::grid
  // The arrays have a spare element, since the next leaf overwrites one that is not cut.
  std::array<Vertices, kCapacity + 1> vertices_;
  std::array<const LeafPatch*, kCapacity + 1> leaf_;
  std::array<std::uint32_t, kCapacity + 1> wet_;  // one bit per vertex
  std::array<LeafWork, kCapacity> work_;
  std::size_t size_ = 0;
};

class LeafSums {
 public:
  // Explicit, because an implicit constructor would be compiled without the target's instructions.
  HWY_INLINE LeafSums()
      : volume6_(hn::Zero(Reals())),
        moment_b24_(hn::Zero(Reals())),
        moment_c24_(hn::Zero(Reals())),
        whole_z_squared24_(hn::Zero(Reals())),
        cut_z_squared12_(hn::Zero(Reals())) {}

  // Adds the wet part of the cut leaves' triangles, less the leaf's moments where
  // LeafWork::subtract_from_leaf.
  HWY_INLINE void add(const LeafBatch& batch, const std::array<std::size_t, 3>& axes, double grid) {
    LeafSums whole;
    for (std::size_t i = 0; i < batch.cut_leaves(); ++i) {
      whole.add_whole(batch.work(i), LeafFrame(batch, i, axes, grid));
    }
    LeafSums cut;
    for (std::size_t i = 0; i < batch.cut_leaves(); ++i) {
      cut.add_cut(batch.work(i), LeafFrame(batch, i, axes, grid));
      rounding_ += static_cast<double>(batch.leaf(i).rounding);
    }
    volume6_ = hn::Add(volume6_, hn::Add(whole.volume6_, cut.volume6_));
    moment_b24_ = hn::Add(moment_b24_, hn::Add(whole.moment_b24_, cut.moment_b24_));
    moment_c24_ = hn::Add(moment_c24_, hn::Add(whole.moment_c24_, cut.moment_c24_));
    whole_z_squared24_ = hn::Add(whole_z_squared24_, whole.whole_z_squared24_);
    cut_z_squared12_ = hn::Add(cut_z_squared12_, cut.cut_z_squared12_);
  }

  HWY_INLINE void finish(WettedTreeSum& sum) const {
    const Reals d;
    sum.rounding = rounding_;
    sum.volume6 = sum_of_lanes(volume6_);
    sum.moment_b24 = sum_of_lanes(moment_b24_);
    sum.moment_c24 = sum_of_lanes(moment_c24_);
    sum.z_squared12 = sum_of_lanes(hn::MulAdd(hn::Set(d, 0.5), whole_z_squared24_, cut_z_squared12_));
  }

 private:
  // Coordinates of a leaf's vertices along b and c, about its centre, and their heights. Areas projected
  // along a are products of differences of these coordinates, as exact as the mesh; moments are moved to the
  // mesh's centre.
  struct LeafFrame {
    HWY_INLINE LeafFrame(const LeafBatch& batch, std::size_t i, const std::array<std::size_t, 3>& axes,
                         double grid)
        : b(batch.vertices(i).b),
          c(batch.vertices(i).c),
          z(batch.vertices(i).z),
          center_b4(hn::Set(Reals(), 4.0 * grid * batch.leaf(i).center[axes[1]])),
          center_c4(hn::Set(Reals(), 4.0 * grid * batch.leaf(i).center[axes[2]])) {}

    const VertexTable& b;
    const VertexTable& c;
    const VertexTable& z;
    RealVector center_b4, center_c4;  // [m], four times the leaf's centre
  };

  // x y - z w, with the first product not rounded.
  HWY_INLINE static RealVector difference_of_products(RealVector x, RealVector y, RealVector z,
                                                      RealVector w) {
    return hn::MulSub(x, y, hn::Mul(z, w));
  }

  // Vectors of eight are nearly always one, so that evaluating one that is empty costs less than a branch.
  HWY_INLINE static std::size_t at_least_one_of_eight(std::size_t count) {
    return hn::Lanes(Reals()) == 8 ? std::max<std::size_t>(count, 1) : count;
  }

  HWY_INLINE void add_whole(const LeafWork& work, const LeafFrame& leaf) {
    const Reals d;
    const auto sign = hn::Set(d, work.subtract_from_leaf ? -1.0 : 1.0);
    // These are at most half of a leaf, and nearly always one vector of eight.
    const std::size_t num_whole = at_least_one_of_eight(work.num_whole);
    for (std::size_t i = 0; i < num_whole; i += hn::Lanes(d)) {
      const CornerIndices at = corner_indices(work.whole.data() + i);
      const auto bp = look_up(leaf.b, at.p);
      const auto bq = look_up(leaf.b, at.q);
      const auto br = look_up(leaf.b, at.r);
      const auto cp = look_up(leaf.c, at.p);
      const auto cq = look_up(leaf.c, at.q);
      const auto cr = look_up(leaf.c, at.r);
      const auto zp = look_up(leaf.z, at.p);
      const auto zq = look_up(leaf.z, at.q);
      const auto zr = look_up(leaf.z, at.r);
      // 2 n_a dA, by the edges from corner p; 0 in unused lanes.
      const auto w = hn::Mul(
          sign, difference_of_products(hn::Sub(bq, bp), hn::Sub(cr, cp), hn::Sub(br, bp), hn::Sub(cq, cp)));
      const auto z_sum = hn::Add(hn::Add(zp, zq), zr);
      const auto weight_p = hn::Add(z_sum, zp);
      const auto weight_q = hn::Add(z_sum, zq);
      const auto weight_r = hn::Add(z_sum, zr);
      const auto moment = [&](RealVector p, RealVector q, RealVector r, RealVector center4) {
        return hn::MulAdd(weight_p, p,
                          hn::MulAdd(weight_q, q, hn::MulAdd(weight_r, r, hn::Mul(z_sum, center4))));
      };
      volume6_ = hn::MulAdd(w, z_sum, volume6_);
      moment_b24_ = hn::MulAdd(w, moment(bp, bq, br, leaf.center_b4), moment_b24_);
      moment_c24_ = hn::MulAdd(w, moment(cp, cq, cr, leaf.center_c4), moment_c24_);
      // (sum z)^2 + sum z^2 = twice the sum of squares and products.
      const auto squares = hn::MulAdd(zp, weight_p, hn::MulAdd(zq, weight_q, hn::Mul(zr, weight_r)));
      whole_z_squared24_ = hn::MulAdd(w, squares, whole_z_squared24_);
    }
  }

  HWY_INLINE void add_cut(const LeafWork& work, const LeafFrame& leaf) {
    const Reals d;
    const auto four = hn::Set(d, 4.0);
    const std::size_t num_cut = at_least_one_of_eight(work.num_cut);
    for (std::size_t i = 0; i < num_cut; i += hn::Lanes(d)) {
      const CornerIndices at = corner_indices(work.cut.data() + i);
      const auto bp = look_up(leaf.b, at.p);
      const auto cp = look_up(leaf.c, at.p);
      const auto zp = look_up(leaf.z, at.p);
      const auto b_pq = hn::Sub(look_up(leaf.b, at.q), bp);
      const auto b_pr = hn::Sub(look_up(leaf.b, at.r), bp);
      const auto c_pq = hn::Sub(look_up(leaf.c, at.q), cp);
      const auto c_pr = hn::Sub(look_up(leaf.c, at.r), cp);
      // Height differences along the edges p-q and p-r, from which the parts of the edges on p's side follow.
      const auto z_pq = hn::Sub(zp, look_up(leaf.z, at.q));
      const auto z_pr = hn::Sub(zp, look_up(leaf.z, at.r));
      // This takes one division instead of two. The product is 0 in unused lanes, whose corners are all the
      // same, and where heights below 1e-154 m underflow in it: such lanes add nothing and are not divided.
      const auto both = hn::Mul(z_pq, z_pr);
      const auto scale = hn::IfThenElseZero(hn::Ne(both, hn::Zero(d)), hn::Div(zp, both));
      const auto to_q = hn::Mul(scale, z_pr);
      const auto to_r = hn::Mul(scale, z_pq);
      const auto w = difference_of_products(b_pq, c_pr, b_pr, c_pq);
      // A wet corner's part is added (z_p < 0) and a dry one's is subtracted (z_p > 0): this is the negative
      // of either contribution.
      const auto weighted = hn::Mul(hn::Mul(w, hn::Abs(zp)), hn::Mul(to_q, to_r));
      const auto moment = [&](RealVector p, RealVector pq, RealVector pr, RealVector center4) {
        return hn::MulAdd(to_q, pq, hn::MulAdd(to_r, pr, hn::MulAdd(four, p, center4)));
      };
      volume6_ = hn::Sub(volume6_, weighted);
      moment_b24_ = hn::NegMulAdd(weighted, moment(bp, b_pq, b_pr, leaf.center_b4), moment_b24_);
      moment_c24_ = hn::NegMulAdd(weighted, moment(cp, c_pq, c_pr, leaf.center_c4), moment_c24_);
      cut_z_squared12_ = hn::NegMulAdd(weighted, zp, cut_z_squared12_);
    }
  }

  RealVector volume6_;
  RealVector moment_b24_;
  RealVector moment_c24_;
  RealVector whole_z_squared24_;
  RealVector cut_z_squared12_;
  double rounding_ = 0.0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
