// Patches of the tree in lanes, and the integrals of a model of the pressure over those that are not clipped,
// with SIMD (docs/wave_mathematics.md, "What a patch contributes"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_INTEGRALS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_INTEGRALS_INL_H
#undef BUOYANCY_WAVE_INTEGRALS_INL_H
#else
#define BUOYANCY_WAVE_INTEGRALS_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "wave_loads/patch_tree.h"
#include "wave_loads/wave_models-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// What is evaluated together: kGroup patches of a block of the tree.
struct PatchGroup {
  std::uint32_t block = 0;
  std::uint32_t first = 0;  // lane of the block
  bool dry = false;         // all of its patches are
  std::uint32_t surface_cell = 0, volume_cell = 0;
  std::uint32_t next = kNone;  // in the same cell
};

template <typename Number>
using GroupsOfVector = std::array<PatchGroup, kGroupsPerVector<Number>>;

template <typename Number>
struct PatchMoments {
  Vectors3<Number> center;
  VectorOf<Number> radius, area, mu2, mu3, nu3;
  std::array<VectorOf<Number>, 3> S;
  std::array<VectorOf<Number>, 9> N;
  std::array<VectorOf<Number>, 18> P;
};

// Fetch what is read of a block later: where its patches are; how large they are and what they hold; all but
// where they are.
inline constexpr std::size_t kCacheLine = 64;
inline void prefetch_places(const PatchBlock& block) {
  static_assert(offsetof(PatchBlock, area) == kCacheLine);
  hwy::Prefetch(&block.center);
}
inline void prefetch_sizes(const PatchBlock& block) {
  static_assert(offsetof(PatchBlock, mu2) == 2 * kCacheLine);
  hwy::Prefetch(&block.area);
}
inline void prefetch_moments(const PatchBlock& block) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&block);
  for (std::size_t at = kCacheLine; at < sizeof(PatchBlock); at += kCacheLine) hwy::Prefetch(bytes + at);
}

// Calls take(first lane) for each group of a block.
template <typename Number, typename Take>
HWY_INLINE void for_each_group(const PatchBlock& block, const Take& take) {
  take(0U);  // without a look at the block, which may not be in the cache yet
  for (std::uint32_t first = kGroup<Number>; first < kSiblings && first < block.patches;
       first += kGroup<Number>) {
    take(first);
  }
}

// Reads the moments of the patches of a vector of groups.
template <typename Number>
HWY_INLINE PatchMoments<Number> read_moments(const QueryPatches& patches,
                                             const GroupsOfVector<Number>& groups) {
  std::array<const PatchBlock*, kGroupsPerVector<Number>> blocks;
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n] = &patches.block(groups[n].block);
  const auto get = [&](const auto& member) HWY_ATTR {
    return gather_groups<Number>([&](std::size_t n) { return member(*blocks[n]).data() + groups[n].first; });
  };
  PatchMoments<Number> m;
  m.center = {get([](const PatchBlock& b) -> const FourFloats& { return b.center[0]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[1]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[2]; })};
  m.radius = get([](const PatchBlock& b) -> const FourFloats& { return b.radius; });
  m.area = get([](const PatchBlock& b) -> const FourFloats& { return b.area; });
  m.mu2 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu2; });
  m.mu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu3; });
  m.nu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.nu3; });
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) {
    m.S[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.S[i]; });
  }
#pragma GCC unroll 9
  for (std::size_t i = 0; i < 9; ++i) {
    m.N[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.N[i]; });
  }
#pragma GCC unroll 18
  for (std::size_t i = 0; i < 18; ++i) {
    m.P[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.P[i]; });
  }
  return m;
}

// The patches of a vector of groups that are leaves, as bits.
template <typename Number>
HWY_INLINE std::uint32_t leaves(const QueryPatches& patches, const GroupsOfVector<Number>& groups) {
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < kLanes<Number>; ++lane) {
    const PatchGroup& group = groups[lane / kGroup<Number>];
    const bool leaf = patches.block(group.block).triangle_blocks[group.first + lane % kGroup<Number>] > 0;
    bits |= std::uint32_t{leaf} << lane;
  }
  return bits;
}

// Integrals over a patch, B axes, over rho g.
template <typename Number>
struct PatchIntegrals {
  Vectors3<Number> force;   // [m^3], -int psi n dA
  Vectors3<Number> torque;  // [m^4], about the reference point
  VectorOf<Number> volume;  // [m^3]
  Vectors3<Number> moment;  // [m^4], int (x - c) dV
  VectorOf<Number> force_error, torque_error, volume_error;
  VectorOf<Number>
      expected;  // estimate of the sum of the force errors once the patch is replaced by its children
};

// Integrals of a quadratic function over a patch: of the function times n, of the function times y_j n_k (of
// its linear part alone) and times up . n.
template <typename Number>
HWY_INLINE Vectors3<Number> integral_with_normal(const PatchMoments<Number>& m, const Quadratic<Number>& q) {
  using V = VectorOf<Number>;
  const V half = set<Number>(0.5);
  const Symmetric<Number> weights{half * q.hessian[0], half * q.hessian[1], half * q.hessian[2],
                                  q.hessian[3],        q.hessian[4],        q.hessian[5]};
  std::array<V, 3> sum;
#pragma GCC unroll 3
  for (std::size_t k = 0; k < 3; ++k) {
    V of_k = q.value * m.S[k];
    of_k = hn::MulAdd(q.gradient.x, m.N[k], of_k);
    of_k = hn::MulAdd(q.gradient.y, m.N[3 + k], of_k);
    of_k = hn::MulAdd(q.gradient.z, m.N[6 + k], of_k);
#pragma GCC unroll 6
    for (std::size_t pair = 0; pair < 6; ++pair) of_k = hn::MulAdd(weights[pair], m.P[3 * pair + k], of_k);
    sum[k] = of_k;
  }
  return {sum[0], sum[1], sum[2]};
}

// The place of y_i y_j in the order of Symmetric.
inline constexpr std::size_t kPair[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

// int (value + gradient . y) y_j n_k dA.
template <typename Number>
HWY_INLINE VectorOf<Number> integral_with_offset(const PatchMoments<Number>& m, const VectorOf<Number>& value,
                                                 const Vectors3<Number>& gradient, std::size_t j,
                                                 std::size_t k) {
  auto sum = value * m.N[3 * j + k];
  sum = hn::MulAdd(gradient.x, m.P[3 * kPair[0][j] + k], sum);
  sum = hn::MulAdd(gradient.y, m.P[3 * kPair[1][j] + k], sum);
  return hn::MulAdd(gradient.z, m.P[3 * kPair[2][j] + k], sum);
}

// The components along an axis of the moments with the normal.
template <typename Number>
struct UprightMoments {
  VectorOf<Number> S;
  std::array<VectorOf<Number>, 3> N;
  Symmetric<Number> P;
};

template <typename Number>
HWY_INLINE UprightMoments<Number> upright_moments(const PatchMoments<Number>& m, const Vectors3<Number>& up) {
  UprightMoments<Number> along;
  along.S = dot<Number>(up, {m.S[0], m.S[1], m.S[2]});
#pragma GCC unroll 3
  for (std::size_t j = 0; j < 3; ++j) {
    along.N[j] = dot<Number>(up, {m.N[3 * j], m.N[3 * j + 1], m.N[3 * j + 2]});
  }
#pragma GCC unroll 6
  for (std::size_t pair = 0; pair < 6; ++pair) {
    along.P[pair] = dot<Number>(up, {m.P[3 * pair], m.P[3 * pair + 1], m.P[3 * pair + 2]});
  }
  return along;
}

// int q(y) n_up dA.
template <typename Number>
HWY_INLINE VectorOf<Number> integral(const UprightMoments<Number>& m, const Quadratic<Number>& q) {
  const Symmetric<Number>& h = q.hessian;
  const auto diagonal = hn::MulAdd(h[0], m.P[0], hn::MulAdd(h[1], m.P[1], h[2] * m.P[2]));
  auto sum = hn::MulAdd(q.value, m.S, set<Number>(0.5) * diagonal);
  sum = hn::MulAdd(q.gradient.x, m.N[0],
                   hn::MulAdd(q.gradient.y, m.N[1], hn::MulAdd(q.gradient.z, m.N[2], sum)));
  return hn::MulAdd(h[3], m.P[3], hn::MulAdd(h[4], m.P[4], hn::MulAdd(h[5], m.P[5], sum)));
}

// int (value + gradient . y) y_j n_up dA.
template <typename Number>
HWY_INLINE VectorOf<Number> integral_with_offset(const UprightMoments<Number>& m,
                                                 const VectorOf<Number>& value,
                                                 const Vectors3<Number>& gradient, std::size_t j) {
  const auto sum = hn::MulAdd(gradient.x, m.P[kPair[0][j]], value * m.N[j]);
  return hn::MulAdd(gradient.y, m.P[kPair[1][j]], hn::MulAdd(gradient.z, m.P[kPair[2][j]], sum));
}

// Polynomials in place of max(q, 0) on a patch of this radius: a quadratic one for the force, and a linear
// one for offsets.
template <typename Number>
struct ClippedModel {
  Quadratic<Number> quadratic;
  VectorOf<Number> linear_value;
  Vectors3<Number> linear_gradient;
  VectorOf<Number> quadratic_error, linear_error;  // [m], of the linear part of q
};

template <typename Number>
HWY_INLINE ClippedModel<Number> clipped_model(const Quadratic<Number>& q, const VectorOf<Number>& radius,
                                              const hn::Mask<LanesOf<Number>>& whole) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const V half = set<Number>(0.5);
  const V tiny = set<Number>(1e-30);
  const V variation = radius * hn::Sqrt(dot<Number>(q.gradient, q.gradient));
  const V a = hn::Max(q.value + variation, zero);
  const V b = hn::Max(variation - q.value, zero);
  const V share = one / hn::Max(a + b, tiny);
  const V d = hn::Max(hn::Max(a, b), tiny);
  const V linear_error = half * a * b * share;
  const V quadratic_error = d * set<Number>(1.0 / 16.0);
  const auto linear_only = hn::Le(linear_error, quadratic_error);
  V constant = hn::IfThenElse(linear_only, linear_error, quadratic_error);
  V factor = hn::IfThenElse(linear_only, a * share, half);
  V square = hn::IfThenElse(linear_only, zero, half / d);
  constant = hn::IfThenZeroElse(whole, constant);
  factor = hn::IfThenElse(whole, one, factor);
  square = hn::IfThenZeroElse(whole, square);
  const V of_hessian = hn::IfThenElse(whole, one, half);

  ClippedModel<Number> model;
  model.quadratic.value = hn::MulAdd(q.value, hn::MulAdd(square, q.value, factor), constant);
  model.quadratic.gradient = scaled<Number>(hn::MulAdd(square + square, q.value, factor), q.gradient);
  const Vectors3<Number>& g = q.gradient;
  const V twice = square + square;
  const Symmetric<Number> squares{g.x * g.x, g.y * g.y, g.z * g.z, g.x * g.y, g.x * g.z, g.y * g.z};
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i) {
    model.quadratic.hessian[i] = hn::MulAdd(of_hessian, q.hessian[i], twice * squares[i]);
  }
  const V linear_factor = hn::IfThenElse(whole, one, a * share);
  model.linear_value = hn::MulAdd(linear_factor, q.value, hn::IfThenZeroElse(whole, linear_error));
  model.linear_gradient = scaled<Number>(linear_factor, g);
  model.quadratic_error = hn::IfThenZeroElse(whole, hn::Min(linear_error, quadratic_error));
  model.linear_error = hn::IfThenZeroElse(whole, linear_error);
  return model;
}

template <typename Number>
HWY_INLINE Quadratic<Number> negative(const Quadratic<Number>& q) {
  Quadratic<Number> result;
  result.value = hn::Neg(q.value);
  result.gradient = {hn::Neg(q.gradient.x), hn::Neg(q.gradient.y), hn::Neg(q.gradient.z)};
  for (std::size_t i = 0; i < 6; ++i) result.hessian[i] = hn::Neg(q.hessian[i]);
  return result;
}

template <typename Number>
HWY_INLINE void clear_where(const hn::Mask<LanesOf<Number>>& mask, PatchIntegrals<Number>& integrals) {
  for (VectorOf<Number>* v :
       {&integrals.force.x, &integrals.force.y, &integrals.force.z, &integrals.torque.x, &integrals.torque.y,
        &integrals.torque.z, &integrals.volume, &integrals.moment.x, &integrals.moment.y, &integrals.moment.z,
        &integrals.force_error, &integrals.torque_error, &integrals.volume_error, &integrals.expected}) {
    *v = hn::IfThenZeroElse(mask, *v);
  }
}

// Integrals of powers of the distance from m over a patch, and the norm of its third moments: nu3.
template <typename Number>
struct DistanceMoments {
  VectorOf<Number> mu3, mu4, nu3;
};

// A bound on the integral over a patch, times n, of what a quadratic model leaves out. third: M_3.
template <typename Number>
HWY_INLINE VectorOf<Number> cubic_remainder(const DistanceMoments<Number>& m, const VectorOf<Number>& third,
                                            const CubicBounds<Number>& cubic,
                                            const hn::Mask<LanesOf<Number>>& wet) {
  const VectorOf<Number> of_third = third * m.mu3 * set<Number>(1.0 / 6.0);
  const VectorOf<Number> of_fourth = hn::MulAdd(
      cubic.norm * set<Number>(1.0 / 6.0), m.nu3,
      hn::MulAdd(cubic.rest * set<Number>(1.0 / 6.0), m.mu3, cubic.fourth * m.mu4 * set<Number>(1.0 / 24.0)));
  // The order of the operands matters where the first is not a number.
  return hn::IfThenElse(wet, hn::Min(of_fourth, of_third), of_third);
}

// About what of the remainder is left once the patch is replaced by its children.
template <typename Number>
HWY_INLINE VectorOf<Number> expected_remainder(const DistanceMoments<Number>& m,
                                               const PatchModel<Number>& model) {
  const VectorOf<Number> of_third = model.third_of_children * m.mu3 * set<Number>(1.0 / 48.0);
  const VectorOf<Number> of_fourth =
      hn::MulAdd(model.cubic.norm * set<Number>(1.0 / 48.0), m.nu3,
                 hn::MulAdd(model.cubic.rest * set<Number>(1.0 / 96.0), m.mu3,
                            model.cubic.fourth * m.mu4 * set<Number>(0.7 / 384.0)));
  return hn::IfThenElse(model.wet, hn::Min(of_fourth, of_third), of_third);
}

// A bound on the integral over a patch of what the model of s leaves out [m^3].
template <typename Number>
HWY_INLINE VectorOf<Number> volume_remainder(const VectorOf<Number>& area, const DistanceMoments<Number>& m,
                                             const PatchModel<Number>& model) {
  return hn::MulAdd(model.s_delta, area, cubic_remainder<Number>(m, model.s_third, model.s_cubic, model.wet));
}

// A bound on the norm of the integral of y x n times what a quadratic model's linear part leaves out.
template <typename Number>
HWY_INLINE VectorOf<Number> offset_remainder(const DistanceMoments<Number>& m, const VectorOf<Number>& radius,
                                             const PatchModel<Number>& model) {
  const VectorOf<Number> of_second =
      set<Number>(0.5) * hn::MulAdd(model.third * radius, set<Number>(1.0 / 3.0), model.curvature) * m.mu3;
  const VectorOf<Number> of_third = hn::MulAdd(model.curvature * set<Number>(0.70710678), m.nu3,
                                               model.third * m.mu4 * set<Number>(1.0 / 6.0));
  return hn::IfThenElse(model.wet, hn::Min(of_third, of_second), of_second);
}

template <typename Number>
HWY_INLINE DistanceMoments<Number> distance_moments(const PatchMoments<Number>& m) {
  // mu3 is the root of mu2 mu4. A patch that is not used has no area.
  const VectorOf<Number> mean = hn::Min(set<Number>(1.000001) * m.mu3 / m.mu2, m.radius);
  return {m.mu3, m.mu3 * mean, m.nu3};
}

// The root mean square of the distance from the centroid, over the largest.
template <typename Number>
HWY_INLINE VectorOf<Number> spread_of(const PatchMoments<Number>& m) {
  // A patch that is not used has no area.
  return hn::Min(hn::Sqrt(m.mu2 / (m.area * m.radius * m.radius)), set<Number>(1.0));
}

// The integrals of a model over whole patches, or over patches that the surface crosses and that are not
// clipped. Of dry ones they are of no use.
template <typename Number>
HWY_INLINE PatchIntegrals<Number> integrate(const PatchQuery<Number>& query, const PatchMoments<Number>& m,
                                            const PatchModel<Number>& model) {
  using V = VectorOf<Number>;
  const V half = set<Number>(0.5);
  const ClippedModel<Number> phi = clipped_model<Number>(model.phi, m.radius, model.whole);
  PatchIntegrals<Number> result;
  const Vectors3<Number> minus_force = integral_with_normal<Number>(m, phi.quadratic);
  const auto offset = [&](std::size_t j, std::size_t k) {
    return integral_with_offset<Number>(m, phi.linear_value, phi.linear_gradient, j, k);
  };
  const Vectors3<Number> minus_local{offset(1, 2) - offset(2, 1), offset(2, 0) - offset(0, 2),
                                     offset(0, 1) - offset(1, 0)};
  result.force = {hn::Neg(minus_force.x), hn::Neg(minus_force.y), hn::Neg(minus_force.z)};
  const Vectors3<Number> lever = m.center - axis_of<Number>(query.reference);
  result.torque = cross<Number>(lever, result.force) - minus_local;

  // (-s)^+ in the place of the pressure; its component along up is minus the volume.
  const Vectors3<Number> up = axis_of<Number>(query.up_B);
  const UprightMoments<Number> upright = upright_moments<Number>(m, up);
  const ClippedModel<Number> depth = clipped_model<Number>(negative<Number>(model.s), m.radius, model.whole);
  result.volume = hn::Neg(integral<Number>(upright, depth.quadratic));
  const auto along_up = [&](std::size_t j) {
    return integral_with_offset<Number>(upright, depth.linear_value, depth.linear_gradient, j);
  };
  // int (y - s/2 up) s n_z dA; s^2 to second order, as the product of the depth with its clipped model.
  const Vectors3<Number> depth_gradient{hn::Neg(model.s.gradient.x), hn::Neg(model.s.gradient.y),
                                        hn::Neg(model.s.gradient.z)};
  Quadratic<Number> squared;
  const V depth_value = hn::Neg(model.s.value);
  squared.value = depth.linear_value * depth_value;
  squared.gradient =
      scaled<Number>(depth_value, depth.linear_gradient) + scaled<Number>(depth.linear_value, depth_gradient);
  const Vectors3<Number>& p = depth.linear_gradient;
  const Vectors3<Number>& t = depth_gradient;
  const V two = set<Number>(2.0);
  squared.hessian = {two * p.x * t.x,       two * p.y * t.y,       two * p.z * t.z,
                     p.x * t.y + p.y * t.x, p.x * t.z + p.z * t.x, p.y * t.z + p.z * t.y};
  const V of_clipped = hn::IfThenElse(model.whole, set<Number>(1.0), half);
  const V curvature_factor = hn::MulAdd(of_clipped, depth_value, depth.linear_value);
#pragma GCC unroll 6
  for (std::size_t i = 0; i < 6; ++i) {
    squared.hessian[i] = hn::NegMulAdd(curvature_factor, model.s.hessian[i], squared.hessian[i]);
  }
  const V half_square = half * integral<Number>(upright, squared);
  result.moment = scaled<Number>(result.volume, m.center) -
                  Vectors3<Number>{along_up(0), along_up(1), along_up(2)} - scaled<Number>(half_square, up);

  const V mu1 = hn::Sqrt(m.area * m.mu2);
  const DistanceMoments<Number> distances = distance_moments<Number>(m);
  const V remainder = hn::MulAdd(model.mean_delta, m.area,
                                 cubic_remainder<Number>(distances, model.third, model.cubic, model.wet));
  const V of_hessian = hn::IfThenElse(model.whole, set<Number>(0.0), set<Number>(0.25));
  const V of_crossing = phi.quadratic_error * m.area + of_hessian * model.curvature * m.mu2;
  result.force_error = remainder + of_crossing;
  // Radii halve, and the surface crosses about half of the children.
  const V quarter = set<Number>(0.25);
  // The order of the operands matters where the first is not a number.
  result.expected = hn::Min(expected_remainder<Number>(distances, model) +
                                quarter * hn::MulAdd(model.delta_of_children, m.area, of_crossing),
                            quarter * result.force_error);
  const V local =
      phi.linear_error * mu1 + model.delta * mu1 + offset_remainder<Number>(distances, m.radius, model);
  result.torque_error = hn::Sqrt(dot<Number>(lever, lever)) * result.force_error + local;
  result.volume_error =
      volume_remainder<Number>(m.area, distances, model) +
      hn::IfThenElse(model.whole, model.certificate_factor * model.mean_delta * m.area,
                     hn::MulAdd(depth.quadratic_error, m.area, quarter * model.s_curvature * m.mu2));
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_INTEGRALS_INL_H
