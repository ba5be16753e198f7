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
using RealVector = hn::Vec<Reals>;

struct BoundsQuery {
  float kx, ky, kz, h, margin;
  float per_half_diagonal;  // 1/m: 2 / L
  float per_k_a;            // 1 / |k_a|
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
  bounds.per_k_a = static_cast<float>(1.0 / std::abs(query.k[query.axes[0]]));
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

HWY_INLINE std::uint32_t present_children(const TreeNode& node) {
  return (1U << node.children) - 1U;
}

HWY_INLINE ChildMasks child_masks(const TreeNode& node, std::uint32_t wet, std::uint32_t dry) {
  const std::uint32_t present = present_children(node);
  return {wet & present, ~(wet | dry) & present};
}

template <class D>
HWY_INLINE std::uint32_t mask_bits(D d, hn::Mask<D> mask) {
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(d, mask, bits.data());
  return bits[0];
}

// append_places writes first + i for every bit i of the mask, in order, append_children child[i]; behind them
// anything, room for kTreeWidth in all. They return how many. leaf_children: a bit for
// each.
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

// The line's error and the parabola's, m: undecided_node.h. radius: m.
template <class D>
struct FitErrors {
  hn::Vec<D> line, curved;
};

template <class D>
HWY_INLINE FitErrors<D> fit_errors(D d, hn::Vec<D> below, hn::Vec<D> above, hn::Vec<D> radius,
                                   const BoundsQuery& query) {
  const auto one = hn::Set(d, 1.0F);
  const auto per_half_diagonal = hn::Set(d, query.per_half_diagonal);
  const auto line = hn::Mul(hn::Set(d, 0.5F), hn::Div(hn::Mul(below, above), hn::Add(below, above)));
  const auto farthest = hn::Max(below, above);
  const auto depth = hn::Mul(farthest, per_half_diagonal);
  const auto lever = hn::Mul(hn::Set(d, 1.71F), hn::Mul(radius, per_half_diagonal));
  const auto parabola = hn::Mul(farthest, hn::Set(d, 1.0F / 16.0F));
  return {hn::Mul(line, hn::MulAdd(hn::Set(d, 0.71F), depth, one)),
          hn::MulAdd(parabola, hn::MulAdd(hn::Set(d, 0.36F), depth, one), hn::Mul(line, lever))};
}

template <class D>
HWY_INLINE hn::Vec<D> radius(D d, const TreeNode& node, std::size_t first) {
  const auto x = hn::Load(d, node.half_x.data() + first);
  const auto y = hn::Load(d, node.half_y.data() + first);
  const auto z = hn::Load(d, node.half_z.data() + first);
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
}

HWY_INLINE ChildMasks test_children(const TreeNode& node, const BoundsQuery& query, std::size_t a,
                                    UndecidedChildren& children) {
  const Bounds d;
  const auto scale = hn::Set(d, 1.00001F * query.per_k_a);  // for what float32 rounds
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
    const auto area = hn::Mul(scale, load_upper_halves(d, node.projected_area[a], i));
    hn::Store(hn::Mul(area, errors.line), d, children.line_error.data() + i);
    hn::Store(hn::Mul(area, hn::Min(errors.line, errors.curved)), d, children.error.data() + i);
  }
  return child_masks(node, wet, dry);
}

// How the ten moments of axis a are held in vectors: those of its line, then two of the last line. Vectors of
// eight hold all of the last line, whatever belongs to the others.
class AxisVectors {
 public:
  static constexpr std::size_t kLanes = hn::MaxLanes(Reals());
  static constexpr std::size_t kInLine = NodeMoments::kInLine / kLanes;
  static constexpr std::size_t kVectors = kInLine + (kLanes == 1 ? 2 : 1);

  HWY_INLINE explicit AxisVectors(std::size_t a)
      : line_(NodeMoments::kInLine * a),
        rest_(kLanes == 8 ? NodeMoments::kLastLine : NodeMoments::slot(a, NodeMoments::kInLine)),
        skipped_(kLanes == 8 ? 2 * a : 0) {}

  HWY_INLINE RealVector load(const NodeMoments& moments, std::size_t vector) const {
    const double* const from = moments.values.data();
    return vector < kInLine ? hn::Load(Reals(), from + line_ + vector * kLanes)
                            : hn::LoadU(Reals(), from + rest_ + (vector - kInLine) * kLanes);
  }

  struct alignas(64) Values {
    std::array<double, kVectors * kLanes> values{};
  };
  // Where moment n of AxisMoments lies among Values.
  HWY_INLINE std::size_t slot(std::size_t n) const { return n < NodeMoments::kInLine ? n : n + skipped_; }

 private:
  std::size_t line_, rest_, skipped_;
};

// Sums of axis a's moments of nodes: plain within a block of 16, compensated from block to block.
class AxisSums {
 public:
  HWY_INLINE explicit AxisSums(std::size_t a) : vectors_(a) {}

  // Those of moments that are listed.
  HWY_INLINE void add(const std::vector<NodeMoments>& moments, const std::uint32_t* list, std::size_t count) {
    for (std::size_t n = 0; n < count; n += kBlock) add_block(moments, list + n, std::min(kBlock, count - n));
  }

  HWY_INLINE void add_weighted(const NodeMoments& moments, double weight) {
    const Reals d;
    const auto factor = hn::Set(d, weight);
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
      double* const sum = block_.values.data() + v * AxisVectors::kLanes;
      hn::Store(hn::MulAdd(factor, vectors_.load(moments, v), hn::Load(d, sum)), d, sum);
    }
    if (++in_block_ == kBlock) close_block();
  }

  HWY_INLINE void finish(AxisMoments& sum) {
    close_block();
    std::size_t n = 0;
    const auto next = [&] {
      const std::size_t slot = vectors_.slot(n++);
      return total_.values[slot] + rest_.values[slot];
    };
    sum.S = next();
    for (double& value : sum.N) value = next();
    for (double& value : sum.P) value = next();
  }

 private:
  static constexpr std::size_t kBlock = 16;

  HWY_INLINE void add_block(const std::vector<NodeMoments>& moments, const std::uint32_t* list,
                            std::size_t count) {
    RealVector sum[AxisVectors::kVectors];
    for (RealVector& vector : sum) vector = hn::Zero(Reals());
    for (std::size_t n = 0; n < count; ++n) {
      const NodeMoments& from = moments[list[n]];
      for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
        sum[v] = hn::Add(sum[v], vectors_.load(from, v));
      }
    }
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) add_compensated(v, sum[v]);
  }

  HWY_INLINE void add_compensated(std::size_t vector, RealVector block) {
    const Reals d;
    double* const at = total_.values.data() + vector * AxisVectors::kLanes;
    double* const rest = rest_.values.data() + vector * AxisVectors::kLanes;
    const auto total = hn::Load(d, at);
    const auto sum = hn::Add(total, block);
    const auto block_part = hn::Sub(sum, total);
    const auto error = hn::Add(hn::Sub(total, hn::Sub(sum, block_part)), hn::Sub(block, block_part));
    hn::Store(sum, d, at);
    hn::Store(hn::Add(hn::Load(d, rest), error), d, rest);
  }

  HWY_INLINE void close_block() {
    const Reals d;
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
      double* const sum = block_.values.data() + v * AxisVectors::kLanes;
      add_compensated(v, hn::Load(d, sum));
      hn::Store(hn::Zero(d), d, sum);
    }
    in_block_ = 0;
  }

  AxisVectors vectors_;
  AxisVectors::Values block_, total_, rest_;
  std::size_t in_block_ = 0;
};

// Weights with which a node's moments of axis a give int n_a dA, int z n_a dA and int z^2 n_a dA for heights
// z over the mesh's centre.
class CurvatureWeights {
 public:
  explicit CurvatureWeights(const TreeQuery& query)
      : vectors_(query.axes[0]), z_c_(-(query.h_high + query.h_low)) {
    const auto& k = query.k;
    areas_.values[vectors_.slot(0)] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      firsts_.values[vectors_.slot(1 + i)] = k[i];
      for (std::size_t j = i; j < 3; ++j) {
        const auto pair = static_cast<std::size_t>(kSymmetricPair[i][j]);
        seconds_.values[vectors_.slot(4 + pair)] = (i == j ? 1.0 : 2.0) * k[i] * k[j];
      }
    }
  }

  // int (p2 - p1) n_a dA.
  HWY_INLINE double integral(const NodeMoments& moments, const PressureFit& fit) const {
    const Reals d;
    const auto area = hn::Set(d, fit.constant + z_c_ * (fit.linear + z_c_ * fit.quadratic));
    const auto first = hn::Set(d, fit.linear + 2.0 * z_c_ * fit.quadratic);
    const auto second = hn::Set(d, fit.quadratic);
    auto sum = hn::Zero(d);
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
      const std::size_t i = v * AxisVectors::kLanes;
      const auto weight = hn::MulAdd(area, hn::Load(d, areas_.values.data() + i),
                                     hn::MulAdd(first, hn::Load(d, firsts_.values.data() + i),
                                                hn::Mul(second, hn::Load(d, seconds_.values.data() + i))));
      sum = hn::MulAdd(weight, vectors_.load(moments, v), sum);
    }
    return hn::GetLane(hn::SumOfLanes(d, sum));
  }

 private:
  AxisVectors vectors_;
  AxisVectors::Values areas_, firsts_, seconds_;
  double z_c_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
