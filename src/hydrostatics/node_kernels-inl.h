// The SIMD kernels for the inner nodes of the moment tree: children tested eight at once, node moments
// summed. Included once per instruction set (wet_tree_sum.cpp), after highway.h.
#if defined(BUOYANCY_NODE_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_NODE_KERNELS_INL_H
#undef BUOYANCY_NODE_KERNELS_INL_H
#else
#define BUOYANCY_NODE_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "hydrostatics/undecided_node.h"
#include "hydrostatics/wet_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Bounds = hn::CappedTag<float, kTreeWidth>;
using Reals = hn::CappedTag<double, 8>;

struct BoundsQuery {
  float kx, ky, kz, h, margin;
  float per_half_diagonal;  // 1/m: 2 / L
};

HWY_INLINE BoundsQuery make_bounds_query(const MomentTree& tree, const TreeQuery& query) {
  BoundsQuery bounds{};
  bounds.kx = static_cast<float>(query.k[0]);
  bounds.ky = static_cast<float>(query.k[1]);
  bounds.kz = static_cast<float>(query.k[2]);
  bounds.h = static_cast<float>(query.h_high + query.h_low);
  // float32 rounds k, h, each product and sum: at most 12 half-ulps of 3 reach + |h| together.
  bounds.margin = 1e-6F * (3.0F * tree.reach + std::abs(bounds.h));
  bounds.per_half_diagonal = static_cast<float>(1.0 / query.half_diagonal);
  return bounds;
}

// Heights between which some children of a node lie, m, rounded outward.
template <class D>
struct HeightBounds {
  hn::Vec<D> low, high;
};

template <class D>
HWY_INLINE HeightBounds<D> height_bounds(D d, const TreeNode& node, std::size_t first,
                                         const BoundsQuery& query) {
  const auto kx = hn::Set(d, query.kx);
  const auto ky = hn::Set(d, query.ky);
  const auto kz = hn::Set(d, query.kz);
  const auto center = hn::Sub(hn::MulAdd(kx, hn::Load(d, node.center_x.data() + first),
                                         hn::MulAdd(ky, hn::Load(d, node.center_y.data() + first),
                                                    hn::Mul(kz, hn::Load(d, node.center_z.data() + first)))),
                              hn::Set(d, query.h));
  const auto reach = hn::MulAdd(
      hn::Abs(kx), hn::Load(d, node.half_x.data() + first),
      hn::MulAdd(hn::Abs(ky), hn::Load(d, node.half_y.data() + first),
                 hn::MulAdd(hn::Abs(kz), hn::Load(d, node.half_z.data() + first), hn::Set(d, query.margin))));
  return {hn::Sub(center, reach), hn::Add(center, reach)};
}

// Which children of a node lie wholly below the water, and which are cut by it or too close to tell.
struct ChildMasks {
  std::uint32_t wet, crossing;
};

HWY_INLINE ChildMasks child_masks(const TreeNode& node, std::uint32_t wet, std::uint32_t dry) {
  const std::uint32_t present = (1U << node.children) - 1U;
  return {wet & present, ~(wet | dry) & present};
}

template <class D>
HWY_INLINE std::uint32_t mask_bits(D d, hn::Mask<D> mask) {
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(d, mask, bits.data());
  return bits[0];
}

// append_places writes first + i for every bit i of the mask, in order, append_children child[i]; behind them
// anything, room for kTreeWidth in all. They return how many. leaf_children: a bit for each.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

using ChildWords = hn::FixedTag<std::uint32_t, kTreeWidth>;

HWY_INLINE std::size_t append_words(hn::Vec<ChildWords> words, std::uint32_t mask, std::uint32_t* to) {
  const ChildWords d;
  hn::StoreU(hn::Compress(words, hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&mask))), d, to);
  return static_cast<std::size_t>(__builtin_popcount(mask));
}
HWY_INLINE std::size_t append_places(std::uint32_t mask, std::uint32_t first, std::uint32_t* to) {
  const ChildWords d;
  return append_words(hn::Add(hn::Iota(d, 0), hn::Set(d, first)), mask, to);
}
HWY_INLINE std::size_t append_children(const TreeNode& node, std::uint32_t mask, std::uint32_t* to) {
  return append_words(hn::Load(ChildWords(), node.child.data()), mask, to);
}
HWY_INLINE std::uint32_t leaf_children(const TreeNode& node) {
  const hn::FixedTag<std::int32_t, kTreeWidth> d;
  return mask_bits(d, hn::Lt(hn::BitCast(d, hn::Load(ChildWords(), node.child.data())), hn::Zero(d)));
}

#else

HWY_INLINE std::size_t append_places(std::uint32_t mask, std::uint32_t first, std::uint32_t* to) {
  std::size_t count = 0;
  for (; mask != 0; mask &= mask - 1) to[count++] = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
  return count;
}
HWY_INLINE std::size_t append_children(const TreeNode& node, std::uint32_t mask, std::uint32_t* to) {
  std::size_t count = 0;
  for (; mask != 0; mask &= mask - 1) to[count++] = node.child[static_cast<std::size_t>(__builtin_ctz(mask))];
  return count;
}
HWY_INLINE std::uint32_t leaf_children(const TreeNode& node) {
  std::uint32_t leaves = 0;
  for (std::size_t i = 0; i < kTreeWidth; ++i) leaves |= node.child[i] >> 31U << i;
  return leaves;
}

#endif

HWY_INLINE ChildMasks test_children(const TreeNode& node, const BoundsQuery& query) {
  const Bounds d;
  std::uint32_t wet = 0;
  std::uint32_t dry = 0;
  for (std::size_t i = 0; i < kTreeWidth; i += hn::Lanes(d)) {
    const auto heights = height_bounds(d, node, i, query);
    wet |= mask_bits(d, hn::Lt(heights.high, hn::Zero(d))) << i;
    dry |= mask_bits(d, hn::Gt(heights.low, hn::Zero(d))) << i;
  }
  return child_masks(node, wet, dry);
}

// What is known of a node's children while they are undecided (undecided_node.h).
struct alignas(32) UndecidedChildren {
  std::array<float, kTreeWidth> below, above;       // m
  std::array<float, kTreeWidth> error, line_error;  // m^3
};

template <class D>
HWY_INLINE hn::Vec<D> load_upper_halves(D d, const std::array<std::uint16_t, kTreeWidth>& halves,
                                        std::size_t first) {
  const hn::RebindToUnsigned<D> words;
  const hn::Rebind<std::uint16_t, D> half_words;
  return hn::BitCast(d,
                     hn::ShiftLeft<16>(hn::PromoteTo(words, hn::LoadU(half_words, halves.data() + first))));
}

// int |n . k| dA at most.
template <class D>
HWY_INLINE hn::Vec<D> projected_area(D d, const TreeNode& node, std::size_t first, const BoundsQuery& query) {
  const auto along =
      hn::MulAdd(hn::Set(d, query.kx), load_upper_halves(d, node.oriented_x, first),
                 hn::MulAdd(hn::Set(d, query.ky), load_upper_halves(d, node.oriented_y, first),
                            hn::Mul(hn::Set(d, query.kz), load_upper_halves(d, node.oriented_z, first))));
  return hn::Min(hn::Add(hn::Abs(along), load_upper_halves(d, node.spread, first)),
                 load_upper_halves(d, node.area, first));
}

// The line's error and the parabola's, m: undecided_node.h. radius: m.
template <class D>
struct FitErrors {
  hn::Vec<D> line, curved;
};

template <class D>
HWY_INLINE FitErrors<D> fit_errors(D d, hn::Vec<D> below, hn::Vec<D> above, hn::Vec<D> radius,
                                   const BoundsQuery& query) {
  const auto line = hn::Mul(hn::Set(d, 0.5F), hn::Div(hn::Mul(below, above), hn::Add(below, above)));
  const auto lever = hn::Mul(radius, hn::Set(d, query.per_half_diagonal));
  const auto curved = hn::MulAdd(hn::Max(below, above), hn::Set(d, 1.0F / 16.0F), hn::Mul(line, lever));
  return {line, curved};
}

template <class D>
HWY_INLINE hn::Vec<D> radius(D d, const TreeNode& node, std::size_t first) {
  const auto x = hn::Load(d, node.half_x.data() + first);
  const auto y = hn::Load(d, node.half_y.data() + first);
  const auto z = hn::Load(d, node.half_z.data() + first);
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
}

HWY_INLINE ChildMasks test_children(const TreeNode& node, const BoundsQuery& query,
                                    UndecidedChildren& children) {
  const Bounds d;
  const auto rounding = hn::Set(d, 1.00001F);
  std::uint32_t wet = 0;
  std::uint32_t dry = 0;
  for (std::size_t i = 0; i < kTreeWidth; i += hn::Lanes(d)) {
    const auto heights = height_bounds(d, node, i, query);
    wet |= mask_bits(d, hn::Lt(heights.high, hn::Zero(d))) << i;
    dry |= mask_bits(d, hn::Gt(heights.low, hn::Zero(d))) << i;
    const auto below = hn::Max(hn::Neg(heights.low), hn::Zero(d));
    const auto above = hn::Max(heights.high, hn::Zero(d));
    const auto errors = fit_errors(d, below, above, radius(d, node, i), query);
    hn::Store(below, d, children.below.data() + i);
    hn::Store(above, d, children.above.data() + i);
    const auto area = hn::Mul(rounding, projected_area(d, node, i, query));
    hn::Store(hn::Mul(area, errors.line), d, children.line_error.data() + i);
    hn::Store(hn::Mul(area, hn::Min(errors.line, errors.curved)), d, children.error.data() + i);
  }
  return child_masks(node, wet, dry);
}

// Sums of the first kCount node moments: plain within a block of 16, compensated from block to block.
template <std::size_t kCount>
class NodeSums {
 public:
  // Those of moments that are listed.
  HWY_INLINE void add(const std::vector<NodeMoments>& moments, const std::uint32_t* list, std::size_t count) {
    for (std::size_t n = 0; n < count; n += kBlock) add_block(moments, list + n, std::min(kBlock, count - n));
  }

  HWY_INLINE void add_weighted(const NodeMoments& moments, double weight) {
    const Reals d;
    const auto factor = hn::Set(d, weight);
    for (std::size_t i = 0; i < kCount; i += hn::Lanes(d)) {
      hn::Store(
          hn::MulAdd(factor, hn::Load(d, moments.values.data() + i), hn::Load(d, block_.values.data() + i)),
          d, block_.values.data() + i);
    }
    if (++in_block_ == kBlock) close_block();
  }

  HWY_INLINE void finish(NodeMoments& sum) {
    close_block();
    for (std::size_t i = 0; i < kCount; ++i) sum.values[i] = total_.values[i] + rest_.values[i];
  }

 private:
  static constexpr std::size_t kBlock = 16;

  // Four vectors at a time, which stay in registers.
  HWY_INLINE void add_block(const std::vector<NodeMoments>& moments, const std::uint32_t* list,
                            std::size_t count) {
    const Reals d;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = 0; i < kCount; i += 4 * lanes) {
      auto sum0 = hn::Zero(d);
      auto sum1 = hn::Zero(d);
      auto sum2 = hn::Zero(d);
      auto sum3 = hn::Zero(d);
      for (std::size_t n = 0; n < count; ++n) {
        const double* const from = moments[list[n]].values.data() + i;
        sum0 = hn::Add(sum0, hn::Load(d, from));
        sum1 = hn::Add(sum1, hn::Load(d, from + lanes));
        sum2 = hn::Add(sum2, hn::Load(d, from + 2 * lanes));
        sum3 = hn::Add(sum3, hn::Load(d, from + 3 * lanes));
      }
      add_compensated(i, sum0);
      add_compensated(i + lanes, sum1);
      add_compensated(i + 2 * lanes, sum2);
      add_compensated(i + 3 * lanes, sum3);
    }
  }

  HWY_INLINE void add_compensated(std::size_t i, hn::Vec<Reals> block) {
    const Reals d;
    const auto total = hn::Load(d, total_.values.data() + i);
    const auto sum = hn::Add(total, block);
    const auto block_part = hn::Sub(sum, total);
    const auto error = hn::Add(hn::Sub(total, hn::Sub(sum, block_part)), hn::Sub(block, block_part));
    hn::Store(sum, d, total_.values.data() + i);
    hn::Store(hn::Add(hn::Load(d, rest_.values.data() + i), error), d, rest_.values.data() + i);
  }

  HWY_INLINE void close_block() {
    const Reals d;
    for (std::size_t i = 0; i < kCount; i += hn::Lanes(d)) {
      add_compensated(i, hn::Load(d, block_.values.data() + i));
      hn::Store(hn::Zero(d), d, block_.values.data() + i);
    }
    in_block_ = 0;
  }

  struct alignas(64) Values {
    std::array<double, kCount> values{};
  };
  Values block_, total_, rest_;
  std::size_t in_block_ = 0;
};

// S and N, and what it takes to fill the vectors.
inline constexpr std::size_t kOffsetMoments = 16;

// Weights with which a node's moments give int n_k dA, int z n_k dA and int z^2 n_k dA for heights z over the
// mesh's centre.
class CurvatureWeights {
 public:
  explicit CurvatureWeights(const TreeQuery& query) : z_c_(-(query.h_high + query.h_low)) {
    const auto& k = query.k;
    std::size_t slot = 0;
    for (std::size_t n = 0; n < 3; ++n) areas_.values[slot++] = k[n];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t n = 0; n < 3; ++n) firsts_.values[slot++] = k[i] * k[n];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = i; j < 3; ++j) {
        const auto pair = static_cast<std::size_t>(kSymmetricPair[i][j]);
        const double weight = (i == j ? 1.0 : 2.0) * k[i] * k[j];
        for (std::size_t n = 0; n < 3; ++n) seconds_.values[slot + 3 * pair + n] = weight * k[n];
      }
    }
  }

  // int (p2 - p1) n_k dA.
  HWY_INLINE double integral(const NodeMoments& moments, const PressureFit& fit) const {
    const Reals d;
    const auto area = hn::Set(d, fit.constant + z_c_ * (fit.linear + z_c_ * fit.quadratic));
    const auto first = hn::Set(d, fit.linear + 2.0 * z_c_ * fit.quadratic);
    const auto second = hn::Set(d, fit.quadratic);
    auto sum = hn::Zero(d);
    for (std::size_t i = 0; i < NodeMoments::kCount; i += hn::Lanes(d)) {
      const auto weight = hn::MulAdd(area, hn::Load(d, areas_.values.data() + i),
                                     hn::MulAdd(first, hn::Load(d, firsts_.values.data() + i),
                                                hn::Mul(second, hn::Load(d, seconds_.values.data() + i))));
      sum = hn::MulAdd(weight, hn::Load(d, moments.values.data() + i), sum);
    }
    return hn::GetLane(hn::SumOfLanes(d, sum));
  }

 private:
  NodeMoments areas_, firsts_, seconds_;
  double z_c_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
