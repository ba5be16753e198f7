// The SIMD kernels for the inner nodes of the moment tree: they test eight children at once, sum node
// moments, and select and sum the nodes to prune. Included once per instruction set (wetted_tree_sum.cpp
// and waterline_sum.cpp), after highway.h.
#if defined(BUOYANCY_NODE_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_NODE_KERNELS_INL_H
#undef BUOYANCY_NODE_KERNELS_INL_H
#else
#define BUOYANCY_NODE_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "hydrostatics/pruned_node.h"
#include "hydrostatics/wetted_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

using Bounds = hn::CappedTag<float, kTreeWidth>;
using Reals = hn::CappedTag<double, 8>;
using RealVector = hn::Vec<Reals>;

// The water plane in units of MomentTree::unit, except where units are stated.
struct BoundsQuery {
  float kx, ky, kz, h, margin;
  float unit;               // [m]
  float per_half_diagonal;  // [1/m], 2 / L
  float per_k_a;            // 1 / |k_a|
};

HWY_INLINE BoundsQuery make_bounds_query(const MomentTree& tree, const TreeQuery& query) {
  constexpr float kReach = 32768.0F;
  BoundsQuery bounds{};
  bounds.kx = static_cast<float>(query.k[0]);
  bounds.ky = static_cast<float>(query.k[1]);
  bounds.kz = static_cast<float>(query.k[2]);
  bounds.h = static_cast<float>((query.h_high + query.h_low) / tree.unit);
  // float32 rounds k, h and each product and sum: together at most 12 half-ulps of 3 reach + |h|.
  bounds.margin = 1e-6F * (3.0F * kReach + std::abs(bounds.h));
  bounds.unit = static_cast<float>(tree.unit);
  bounds.per_half_diagonal = static_cast<float>(1.0 / query.half_diagonal);
  bounds.per_k_a = static_cast<float>(1.0 / std::abs(query.k[query.axes[0]]));
  return bounds;
}

// Reads 16-bit numbers as float32.
template <class D, typename Short>
HWY_INLINE hn::Vec<D> load_short(D d, const std::array<Short, kTreeWidth>& numbers, std::size_t first) {
  const hn::Rebind<std::int32_t, D> words;
  const hn::Rebind<Short, D> shorts;
  return hn::ConvertTo(d, hn::PromoteTo(words, hn::LoadU(shorts, numbers.data() + first)));
}

// Bounds on the heights of some children of a node, rounded outward, in units of MomentTree::unit.
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
  const auto center = hn::Sub(hn::MulAdd(kx, load_short(d, node.center[0], first),
                                         hn::MulAdd(ky, load_short(d, node.center[1], first),
                                                    hn::Mul(kz, load_short(d, node.center[2], first)))),
                              hn::Set(d, query.h));
  const auto reach = hn::MulAdd(
      hn::Abs(kx), load_short(d, node.half[0], first),
      hn::MulAdd(hn::Abs(ky), load_short(d, node.half[1], first),
                 hn::MulAdd(hn::Abs(kz), load_short(d, node.half[2], first), hn::Set(d, query.margin))));
  return {hn::Sub(center, reach), hn::Add(center, reach)};
}

// Bit masks of a node's children: fully submerged, and crossing the water or too close to it to decide.
struct ChildMasks {
  std::uint32_t wet, crossing;
};

// A bit mask of the first `count` of eight.
HWY_INLINE std::uint32_t first_bits(std::size_t count) {
  return (1U << std::min(count, std::size_t{kTreeWidth})) - 1U;
}

HWY_INLINE ChildMasks child_masks(const TreeNode& node, std::uint32_t wet, std::uint32_t dry) {
  const std::uint32_t present = first_bits(node.children);
  return {wet & present, ~(wet | dry) & present};
}

// A bit mask of the children that are inner nodes.
HWY_INLINE std::uint32_t inner_bits(const TreeNode& node) {
  return (1U << node.inner_nodes) - 1U;
}

// append() writes those of eight items whose bit in the mask is set, in order; append_places() writes first +
// i for every set bit i. Both may write up to kTreeWidth elements in all, with undefined values after the
// last item, and return the number of items.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

template <class T>
using EightOf = hn::FixedTag<T, kTreeWidth>;

template <class D>
HWY_INLINE std::size_t append_lanes(D d, hn::Vec<D> items, std::uint32_t mask, hn::TFromD<D>* to) {
  hn::StoreU(hn::Compress(items, hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&mask))), d, to);
  return static_cast<std::size_t>(__builtin_popcount(mask));
}
template <class T>
HWY_INLINE std::size_t append(const T* from, std::uint32_t mask, T* to) {
  const EightOf<T> d;
  return append_lanes(d, hn::LoadU(d, from), mask, to);
}
HWY_INLINE std::size_t append_places(std::uint32_t mask, std::uint32_t first, std::uint32_t* to) {
  const EightOf<std::uint32_t> d;
  return append_lanes(d, hn::Add(hn::Iota(d, 0), hn::Set(d, first)), mask, to);
}

#else

template <class T>
HWY_INLINE std::size_t append(const T* from, std::uint32_t mask, T* to) {
  std::size_t count = 0;
  for (; mask != 0; mask &= mask - 1) to[count++] = from[__builtin_ctz(mask)];
  return count;
}
HWY_INLINE std::size_t append_places(std::uint32_t mask, std::uint32_t first, std::uint32_t* to) {
  std::size_t count = 0;
  for (; mask != 0; mask &= mask - 1) to[count++] = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
  return count;
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

// The values of PrunableNodes for a node's eight children.
struct alignas(32) PrunableChildren {
  std::array<float, kTreeWidth> below, above, error, curved;
  std::array<std::array<float, kTreeWidth>, 3> center;
};

template <class D>
HWY_INLINE hn::Vec<D> load_upper_halves(D d, const std::array<std::uint16_t, kTreeWidth>& halves,
                                        std::size_t first) {
  const hn::RebindToUnsigned<D> words;
  const hn::Rebind<std::uint16_t, D> half_words;
  return hn::BitCast(d,
                     hn::ShiftLeft<16>(hn::PromoteTo(words, hn::LoadU(half_words, halves.data() + first))));
}

// [m], the errors of the line and of the parabola (pruned_node.h). radius: [m].
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

// Returns the radii of some children in units of MomentTree::unit.
template <class D>
HWY_INLINE hn::Vec<D> radius(D d, const TreeNode& node, std::size_t first) {
  const auto x = load_short(d, node.half[0], first);
  const auto y = load_short(d, node.half[1], first);
  const auto z = load_short(d, node.half[2], first);
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
}

HWY_INLINE ChildMasks test_children(const TreeNode& node, const ProjectedAreas& projected,
                                    const BoundsQuery& query, std::size_t a, PrunableChildren& children) {
  const Bounds d;
  const auto unit = hn::Set(d, query.unit);
  const auto scale = hn::Set(d, 1.00001F * query.per_k_a);  // covers the rounding of float32
  std::uint32_t wet = 0;
  std::uint32_t dry = 0;
  for (std::size_t i = 0; i < kTreeWidth; i += hn::Lanes(d)) {
    const auto heights = height_bounds(d, node, i, query);
    wet |= mask_bits(d, hn::Lt(heights.high, hn::Zero(d))) << i;
    dry |= mask_bits(d, hn::Gt(heights.low, hn::Zero(d))) << i;
    const auto below = hn::Mul(unit, hn::Max(hn::Neg(heights.low), hn::Zero(d)));
    const auto above = hn::Mul(unit, hn::Max(heights.high, hn::Zero(d)));
    const auto errors = fit_errors(d, below, above, hn::Mul(unit, radius(d, node, i)), query);
    hn::Store(below, d, children.below.data() + i);
    hn::Store(above, d, children.above.data() + i);
    const auto area = hn::Mul(scale, load_upper_halves(d, projected.values[a], i));
    hn::Store(hn::Mul(area, hn::Min(errors.line, errors.curved)), d, children.error.data() + i);
    hn::Store(hn::IfThenElseZero(hn::Lt(errors.curved, errors.line), hn::Set(d, 1.0F)), d,
              children.curved.data() + i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::Store(hn::Mul(unit, load_short(d, node.center[axis], i)), d, children.center[axis].data() + i);
    }
  }
  return child_masks(node, wet, dry);
}

HWY_INLINE void append_prunable(const TreeNode& node, std::uint32_t mask, const PrunableChildren& children,
                                PrunableNodes& nodes) {
  const std::size_t at = nodes.size;
  const std::uint32_t inner = mask & inner_bits(node);
  const std::size_t inners = append_places(inner, node.first_node, nodes.child.data() + at);
  append_places((mask ^ inner) >> node.inner_nodes, PrunableNodes::kLeafBit + node.first_leaf,
                nodes.child.data() + at + inners);
  append(children.below.data(), mask, nodes.below.data() + at);
  append(children.above.data(), mask, nodes.above.data() + at);
  append(children.error.data(), mask, nodes.error.data() + at);
  append(children.curved.data(), mask, nodes.curved.data() + at);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    append(children.center[axis].data(), mask, nodes.center[axis].data() + at);
  }
  nodes.size += append_places(mask, node.first_moments, nodes.moments.data() + at);
}

// Returns a bit for each of eight elements of PrunableNodes::child that is a leaf.
HWY_INLINE std::uint32_t leaf_bits(const std::uint32_t* children) {
  std::uint32_t leaves = 0;
  for (std::size_t i = 0; i < kTreeWidth; ++i) leaves |= children[i] >> 31U << i;
  return leaves;
}

// Keeps those of the eight nodes from index `from` on whose bit in the mask is set, by moving them to
// nodes.size, which is at most `from`.
HWY_INLINE void keep_prunable(PrunableNodes& nodes, std::size_t from, std::uint32_t mask) {
  const std::size_t at = nodes.size;
  for (auto* const list : nodes.numbers()) append(list->data() + from, mask, list->data() + at);
  for (auto* const list : nodes.indices()) append(list->data() + from, mask, list->data() + at);
  nodes.size += static_cast<std::size_t>(__builtin_popcount(mask));
}

// Statistics of the nodes' errors that decide which nodes are pruned; [m^3], except `leaves`.
struct ErrorSurvey {
  // Candidates for the limit on one node's error, in equal shares of the remaining budget.
  static constexpr std::array<float, 5> kLimits{1.5F, 2.0F, 3.0F, 4.5F, 7.0F};

  float share = 0.0F;
  double all = 0.0;                             // total of all errors
  std::array<double, kLimits.size()> within{};  // total of the errors within each limit
  std::size_t leaves = 0;                       // number of leaves among the nodes
};

HWY_INLINE ErrorSurvey survey_errors(PrunableNodes& nodes, double left) {
  const Reals d;
  const hn::Rebind<float, Reals> narrow;
  std::fill_n(nodes.error.data() + nodes.size, kTreeWidth, 0.0F);
  auto all = hn::Zero(d);
  RealVector within[ErrorSurvey::kLimits.size()];
  for (RealVector& sum : within) sum = hn::Zero(d);
  ErrorSurvey survey;
  survey.share = static_cast<float>(left / static_cast<double>(std::max<std::size_t>(nodes.size, 1)));
  for (std::size_t first = 0; first < nodes.size; first += kTreeWidth) {
    for (std::size_t i = first; i < first + kTreeWidth; i += hn::Lanes(d)) {
      const auto error = hn::PromoteTo(d, hn::LoadU(narrow, nodes.error.data() + i));
      all = hn::Add(all, error);
      for (std::size_t limit = 0; limit < ErrorSurvey::kLimits.size(); ++limit) {
        const float max_error = ErrorSurvey::kLimits[limit] * survey.share;
        const auto fits = hn::Le(error, hn::Set(d, static_cast<double>(max_error)));
        within[limit] = hn::Add(within[limit], hn::IfThenElseZero(fits, error));
      }
    }
    const std::uint32_t leaves = leaf_bits(nodes.child.data() + first) & first_bits(nodes.size - first);
    survey.leaves += static_cast<std::size_t>(__builtin_popcount(leaves));
  }
  survey.all = sum_of_lanes(all);
  for (std::size_t limit = 0; limit < ErrorSurvey::kLimits.size(); ++limit) {
    survey.within[limit] = sum_of_lanes(within[limit]);
  }
  return survey;
}

// [m^3], the limit on the error of one pruned node such that all of them fit into the remaining budget. If
// most nodes are leaves, below which the budget cannot be used, the limit prunes as many nodes as kLimits
// allow; otherwise it prunes those that need no more than their share.
HWY_INLINE float limit_to_errors(const ErrorSurvey& survey, std::size_t nodes, double left) {
  float limit = 0.999999F * survey.share;
  if (2 * survey.leaves > nodes) {
    for (std::size_t i = 0; i < survey.within.size(); ++i) {
      if (survey.within[i] <= 0.999999 * left) limit = ErrorSurvey::kLimits[i] * survey.share;
    }
  }
  return limit;
}

// The ten moments of an axis in vectors; the last one holds the last two and zeros.
class AxisVectors {
  static constexpr std::size_t kCount = sizeof(AxisMoments) / sizeof(double);
  static_assert(kCount == 10);

 public:
  static constexpr std::size_t kLanes = hn::MaxLanes(Reals());
  static constexpr std::size_t kVectors = (kCount + kLanes - 1) / kLanes;

  struct alignas(64) Values {
    std::array<double, kVectors * kLanes> values{};
  };

  HWY_INLINE static RealVector load(const AxisMoments& moments, std::size_t vector) {
    const double* const from = &moments.S + vector * kLanes;
    if (kLanes > 2 && vector + 1 == kVectors) return load_two(from);
    return hn::LoadU(Reals(), from);
  }

  HWY_INLINE static void prefetch(const AxisMoments& moments) {
    __builtin_prefetch(&moments);
    __builtin_prefetch(reinterpret_cast<const unsigned char*>(&moments + 1) - 1);
  }

 private:
  // A whole vector would read from the next cache line.
  HWY_INLINE static RealVector load_two(const double* from) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
    return RealVector{_mm512_zextpd128_pd512(_mm_loadu_pd(from))};
#elif HWY_TARGET == HWY_AVX2 && HWY_ARCH_X86
    return RealVector{_mm256_zextpd128_pd256(_mm_loadu_pd(from))};
#else
    return hn::LoadU(Reals(), from);
#endif
  }
};

// Sums the nodes' moments of axis a: plainly within a block of 16, compensated from block to block.
class AxisSums {
 public:
  // Adds the listed elements of `moments`.
  HWY_INLINE void add(const AxisMoments* moments, const std::uint32_t* list, std::size_t count) {
    for (std::size_t n = 0; n < count; n += kBlock) add_block(moments, list + n, std::min(kBlock, count - n));
  }

  // Adds the sums of a block.
  HWY_INLINE void add(const RealVector (&block)[AxisVectors::kVectors]) {
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) add_compensated(v, block[v]);
  }

  HWY_INLINE void finish(AxisMoments& sum) const {
    std::size_t n = 0;
    const auto next = [&] {
      const double value = total_.values[n] + rest_.values[n];
      ++n;
      return value;
    };
    sum.S = next();
    for (double& value : sum.N) value = next();
    for (double& value : sum.P) value = next();
  }

 private:
  static constexpr std::size_t kBlock = 16;

  HWY_INLINE void add_block(const AxisMoments* moments, const std::uint32_t* list, std::size_t count) {
    RealVector sum[AxisVectors::kVectors];
    for (RealVector& vector : sum) vector = hn::Zero(Reals());
    for (std::size_t n = 0; n < count; ++n) {
      const AxisMoments& from = moments[list[n]];
      for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
        sum[v] = hn::Add(sum[v], AxisVectors::load(from, v));
      }
    }
    add(sum);
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

  AxisVectors::Values total_, rest_;
};

// Sums the contributions of the pruned nodes.
class PrunedSums {
 public:
  HWY_INLINE explicit PrunedSums(const TreeQuery& query)
      : z_c_(-(query.h_high + query.h_low)),
        volume_(hn::Zero(Reals())),
        moment_{hn::Zero(Reals()), hn::Zero(Reals()), hn::Zero(Reals())} {
    const auto& k = query.k;
    one_.values[0] = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      height_.values[1 + i] = k[i];
      for (std::size_t j = i; j < 3; ++j) {
        const auto pair = static_cast<std::size_t>(kSymmetricPair[i][j]);
        height_squared_.values[4 + pair] = (i == j ? 1.0 : 2.0) * k[i] * k[j];
      }
    }
  }

  // slopes: receives the nodes' slopes times their moments.
  HWY_INLINE void add(const AxisMoments* moments, const PrunableNodes& nodes, AxisSums& slopes) {
    prefetch(moments, nodes, 0, 2 * kBlock);
    for (std::size_t first = 0; first < nodes.size; first += kBlock) {
      prefetch(moments, nodes, first + 2 * kBlock, first + 3 * kBlock);
      add_block(moments, nodes, first, std::min(kBlock, nodes.size - first), slopes);
    }
  }

  HWY_INLINE void finish(PrunedSum& sum) const {
    offsets_.finish(sum.offsets);
    sum.volume = sum_of_lanes(volume_);
    for (int i = 0; i < 3; ++i) sum.moment[i] = sum_of_lanes(moment_[i]);
  }

 private:
  static constexpr std::size_t kBlock = PrunableNodes::kPadding;
  // The number of AxisVectors that hold S and N.
  static constexpr std::size_t kOffsetVectors = (4 + AxisVectors::kLanes - 1) / AxisVectors::kLanes;

  // For each node p1 = slope z + offset, and p2 - p1 as a polynomial of the height over the mesh's centre,
  // which is zero if p1 replaces p2; middle: [m], the node's centre about c.
  struct alignas(64) Fits {
    std::array<double, kBlock> slope, offset, constant, linear, quadratic;
    std::array<std::array<double, kBlock>, 3> middle;
  };

  HWY_INLINE void prefetch(const AxisMoments* moments, const PrunableNodes& nodes, std::size_t first,
                           std::size_t end) const {
    for (std::size_t i = first; i < std::min(end, nodes.size); ++i)
      AxisVectors::prefetch(moments[nodes.moments[i]]);
  }

  // Computes the fits of kBlock nodes, including the padding after the last.
  HWY_INLINE void fit(const PrunableNodes& nodes, std::size_t first, Fits& fits) const {
    const Reals d;
    const hn::Rebind<float, Reals> narrow;
    const auto half = hn::Set(d, 0.5);
    const auto z_c = hn::Set(d, z_c_);
    for (std::size_t i = 0; i < kBlock; i += hn::Lanes(d)) {
      const auto read = [&](const std::vector<float>& numbers) {
        return hn::PromoteTo(d, hn::LoadU(narrow, numbers.data() + first + i));
      };
      const auto below = read(nodes.below);
      const auto above = read(nodes.above);
      const auto curved = read(nodes.curved);
      const auto farthest = hn::Max(below, above);
      const auto range = hn::Add(below, above);
      const auto inverse = hn::Div(hn::Set(d, 1.0), hn::Mul(range, farthest));
      const auto slope = hn::Mul(hn::Mul(below, farthest), inverse);
      const auto offset = hn::Neg(hn::Mul(half, hn::Mul(slope, above)));
      const auto quadratic = hn::Neg(hn::Mul(curved, hn::Mul(half, hn::Mul(range, inverse))));
      const auto linear = hn::Mul(curved, hn::Sub(half, slope));
      const auto constant = hn::Neg(hn::Mul(curved, hn::MulAdd(farthest, hn::Set(d, 1.0 / 16.0), offset)));
      // Converts from heights over the water to heights over the mesh's centre.
      const auto moved = hn::Mul(quadratic, z_c);
      hn::Store(slope, d, fits.slope.data() + i);
      hn::Store(offset, d, fits.offset.data() + i);
      hn::Store(hn::MulAdd(z_c, hn::Add(linear, moved), constant), d, fits.constant.data() + i);
      hn::Store(hn::Add(linear, hn::Add(moved, moved)), d, fits.linear.data() + i);
      hn::Store(quadratic, d, fits.quadratic.data() + i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        hn::Store(read(nodes.center[axis]), d, fits.middle[axis].data() + i);
      }
    }
  }

  HWY_INLINE void add_block(const AxisMoments* moments, const PrunableNodes& nodes, std::size_t first,
                            std::size_t count, AxisSums& slope_sums) {
    const Reals d;
    Fits fits;
    fit(nodes, first, fits);
    RealVector slopes[AxisVectors::kVectors];
    RealVector offsets[AxisVectors::kVectors];
    RealVector one[AxisVectors::kVectors];
    RealVector height[AxisVectors::kVectors];
    RealVector height_squared[AxisVectors::kVectors];
    for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
      slopes[v] = hn::Zero(d);
      offsets[v] = hn::Zero(d);
      one[v] = hn::Load(d, one_.values.data() + v * AxisVectors::kLanes);
      height[v] = hn::Load(d, height_.values.data() + v * AxisVectors::kLanes);
      height_squared[v] = hn::Load(d, height_squared_.values.data() + v * AxisVectors::kLanes);
    }
    for (std::size_t n = 0; n < count; ++n) {
      const AxisMoments& node = moments[nodes.moments[first + n]];
      const auto slope = hn::Set(d, fits.slope[n]);
      const auto offset = hn::Set(d, fits.offset[n]);
      const auto constant = hn::Set(d, fits.constant[n]);
      const auto linear = hn::Set(d, fits.linear[n]);
      const auto quadratic = hn::Set(d, fits.quadratic[n]);
      auto volume = hn::Zero(d);  // int (p2 - p1) n_a dA
      for (std::size_t v = 0; v < AxisVectors::kVectors; ++v) {
        const auto values = AxisVectors::load(node, v);
        slopes[v] = hn::MulAdd(slope, values, slopes[v]);
        if (v < kOffsetVectors) offsets[v] = hn::MulAdd(offset, values, offsets[v]);
        const auto weight = hn::MulAdd(constant, one[v],
                                       hn::MulAdd(linear, height[v], hn::Mul(quadratic, height_squared[v])));
        volume = hn::MulAdd(weight, values, volume);
      }
      volume_ = hn::Add(volume_, volume);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        moment_[axis] = hn::MulAdd(hn::Set(d, fits.middle[axis][n]), volume, moment_[axis]);
      }
    }
    slope_sums.add(slopes);
    offsets_.add(offsets);
  }

  double z_c_;
  AxisSums offsets_;
  RealVector volume_;
  RealVector moment_[3];
  // Weights by which the moments of axis a give int n_a dA, int (k . y) n_a dA and int (k . y)^2 n_a dA.
  AxisVectors::Values one_, height_, height_squared_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
