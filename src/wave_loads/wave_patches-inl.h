// Models of the pressure on patches of the surface, and their integrals, with SIMD (docs/wave_mathematics.md,
// "Local bounds" to "What a patch contributes"). Included once per instruction set, after wave_cells-inl.h.
//
// Positions, elevations and f are in units of 1 / k_max here, so that slopes and all derivatives are pure
// numbers. What leaves a function is in metres.
#if defined(BUOYANCY_WAVE_PATCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_PATCHES_INL_H
#undef BUOYANCY_WAVE_PATCHES_INL_H
#else
#define BUOYANCY_WAVE_PATCHES_INL_H
#endif

#include <array>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

#include "wave_loads/wave_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

template <typename Number>
struct Vectors3 {
  VectorOf<Number> x, y, z;
};

template <typename Number>
HWY_INLINE VectorOf<Number> dot(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
template <typename Number>
HWY_INLINE Vectors3<Number> cross(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z), hn::MulSub(a.x, b.y, a.y * b.x)};
}
template <typename Number>
HWY_INLINE Vectors3<Number> operator-(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Number>
HWY_INLINE Vectors3<Number> operator+(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Number>
HWY_INLINE Vectors3<Number> scaled(const VectorOf<Number>& s, const Vectors3<Number>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

// Symmetric 3 x 3 matrices: xx, yy, zz, xy, xz, yz.
template <typename Number>
using Symmetric = std::array<VectorOf<Number>, 6>;

template <typename Number>
HWY_INLINE Vectors3<Number> product(const Symmetric<Number>& h, const Vectors3<Number>& y) {
  return {hn::MulAdd(h[0], y.x, hn::MulAdd(h[3], y.y, h[4] * y.z)),
          hn::MulAdd(h[3], y.x, hn::MulAdd(h[1], y.y, h[5] * y.z)),
          hn::MulAdd(h[4], y.x, hn::MulAdd(h[5], y.y, h[2] * y.z))};
}
template <typename Number>
HWY_INLINE VectorOf<Number> frobenius_squared(const Symmetric<Number>& h) {
  const auto two = set<Number>(2.0);
  const auto off = hn::MulAdd(h[3], h[3], hn::MulAdd(h[4], h[4], h[5] * h[5]));
  return hn::MulAdd(two, off, hn::MulAdd(h[0], h[0], hn::MulAdd(h[1], h[1], h[2] * h[2])));
}

template <typename Number>
HWY_INLINE hn::Mask<LanesOf<Number>> set_mask(bool all) {
  return hn::Gt(set<Number>(all ? 1.0 : 0.0), set<Number>(0.0));
}

// What is the same for all patches of a query.
template <typename Number>
struct PatchQuery {
  std::array<Number, 3> e1_B, e2_B, up_B;  // unit vectors
  std::array<Number, 3> reference;         // [m], B axes, relative to c
  double k_max = 1.0;                      // [rad/m]
  double zeta = 0.0;                       // [m], height of c over the level
  double per_depth = 0.0;                  // 1 / (k_max h); 0 in deep water
  bool hydrostatic = false;
  // Whether the body is wet everywhere: its weight of water is added apart, and patches integrate f alone.
  bool submerged = false;
  double amplitude = 0.0;      // sum of a k_max
  double slope = 0.0;          // sum of a k
  double unit_roundoff = 0.0;  // of Number
};

// A quadratic function of y = x - m, B axes, y in metres.
template <typename Number>
struct Quadratic {
  VectorOf<Number> value;     // [m]
  Vectors3<Number> gradient;  // [-]
  Symmetric<Number> hessian;  // [1/m]
};

template <typename Number>
struct PatchModel {
  Quadratic<Number> phi;                 // model of the pressure over rho g
  Quadratic<Number> s;                   // of the height over the surface
  VectorOf<Number> third;                // [1/m^2], M_3; 0 where the model is linear by intent
  VectorOf<Number> curvature;            // [1/m], |H|
  VectorOf<Number> delta;                // [m], error of the model over the whole patch
  hn::Mask<LanesOf<Number>> dry, whole;  // nothing is wet; all is, so that nothing is clipped
  hn::Mask<LanesOf<Number>> too_steep;
};

template <typename Number>
HWY_INLINE Quadratic<Number> in_body_axes(const PatchQuery<Number>& query, const VectorOf<Number>& value,
                                          const Vectors3<Number>& gradient,
                                          const Symmetric<Number>& hessian) {
  const LanesOf<Number> d;
  const auto per_k = set<Number>(1.0 / query.k_max);
  const auto k = set<Number>(query.k_max);
  std::array<std::array<VectorOf<Number>, 3>, 3> e{};
  for (std::size_t i = 0; i < 3; ++i) {
    e[0][i] = hn::Set(d, query.e1_B[i]);
    e[1][i] = hn::Set(d, query.e2_B[i]);
    e[2][i] = hn::Set(d, query.up_B[i]);
  }
  const auto combined = [&](std::size_t i) {
    return hn::MulAdd(gradient.x, e[0][i], hn::MulAdd(gradient.y, e[1][i], gradient.z * e[2][i]));
  };
  Quadratic<Number> q;
  q.value = value * per_k;
  q.gradient = {combined(0), combined(1), combined(2)};
  // E^T H E
  std::array<std::array<VectorOf<Number>, 3>, 3> he{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vectors3<Number> column = product<Number>(hessian, {e[0][i], e[1][i], e[2][i]});
    he[0][i] = column.x;
    he[1][i] = column.y;
    he[2][i] = column.z;
  }
  const auto entry = [&](std::size_t i, std::size_t j) {
    return k * hn::MulAdd(e[0][i], he[0][j], hn::MulAdd(e[1][i], he[1][j], e[2][i] * he[2][j]));
  };
  q.hessian = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
  return q;
}

// The place of patches in the sea, over 1 / k_max: from the body's centre along the horizontal axes, and over
// the level.
template <typename Number>
struct Place {
  VectorOf<Number> x1, x2, zeta;
};

template <typename Number>
HWY_INLINE Place<Number> place_of(const PatchQuery<Number>& query, const Vectors3<Number>& center) {
  const LanesOf<Number> d;
  const auto along = [&](const std::array<Number, 3>& axis) {
    return hn::MulAdd(center.x, hn::Set(d, axis[0]),
                      hn::MulAdd(center.y, hn::Set(d, axis[1]), center.z * hn::Set(d, axis[2])));
  };
  const auto k = set<Number>(query.k_max);
  return {k * along(query.e1_B), k * along(query.e2_B), k * (along(query.up_B) + set<Number>(query.zeta))};
}

template <typename Number>
struct SurfaceAtPatch {
  SurfaceValues<Number> values;
  VectorOf<Number> reach;  // distance of m from the cell's centre
};

// z' of the patches' centroids.
template <typename Number>
HWY_INLINE VectorOf<Number> stretched(const PatchQuery<Number>& query, const Place<Number>& place,
                                      const VectorOf<Number>& eta) {
  const auto one = set<Number>(1.0);
  return (place.zeta - eta) / hn::MulAdd(eta, set<Number>(query.per_depth), one);
}

// radius: [m]. surface, surface_cells: the cell of the surface; f: of the volume, unused where the pressure
// is hydrostatic.
template <typename Number>
HWY_INLINE PatchModel<Number> model_of(const PatchQuery<Number>& query, const Place<Number>& place,
                                       const VectorOf<Number>& radius, const SurfaceValues<Number>& surface,
                                       const CellBounds<Number>& surface_bounds, std::size_t surface_cell,
                                       const VectorOf<Number>& surface_reach, const VolumeValues<Number>& f,
                                       const CellBounds<Number>& volume_bounds, std::size_t volume_cell,
                                       const VectorOf<Number>& volume_reach) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const V half = set<Number>(0.5);
  const V two = set<Number>(2.0);
  const V r = radius * set<Number>(query.k_max);
  const V l = set<Number>(query.per_depth);
  const V rounding = set<Number>(100.0 * query.unit_roundoff);

  const V& eta = surface.eta;
  const V& eta1 = surface.eta_1;
  const V& eta2 = surface.eta_2;
  const V s = place.zeta - eta;

  // The surface over the ball of radius r.
  const ReachBounds<Number> above = bounds_at<Number>(surface_bounds, surface_cell, surface_reach + r);
  const V mean = half * (surface.eta_11 + surface.eta_22);
  const V difference = half * (surface.eta_11 - surface.eta_22);
  const V deviator = hn::Sqrt(hn::MulAdd(difference, difference, surface.eta_12 * surface.eta_12));
  const V L3 = above.third;
  const V L2 = hn::MulAdd(r, L3, hn::Abs(mean) + deviator);
  const V slope_squared = hn::MulAdd(eta1, eta1, eta2 * eta2);
  const V L1 = hn::MulAdd(r, L2, hn::Sqrt(slope_squared));
  const V epsilon = hn::MulAdd(rounding, above.sum + hn::Abs(place.zeta), above.truncation);
  const V r_squared_half = half * r * r;
  const V s_variation =
      hn::MulAdd(r, hn::Sqrt(one + slope_squared), r_squared_half * r * L3 * set<Number>(1.0 / 3.0));
  // -D^2 eta has the eigenvalues -mean -+ deviator.
  const V s_low = s - s_variation + r_squared_half * hn::Min(zero, hn::Neg(mean) - deviator) - epsilon;
  const V s_high = s + s_variation + r_squared_half * hn::Max(zero, deviator - mean) + epsilon;

  PatchModel<Number> model;
  model.dry = hn::Gt(s_low, zero);
  const auto wet = hn::Or(hn::Lt(s_high, zero), set_mask<Number>(query.submerged));
  model.s = in_body_axes<Number>(
      query, s, {hn::Neg(eta1), hn::Neg(eta2), one},
      {hn::Neg(surface.eta_11), hn::Neg(surface.eta_22), zero, hn::Neg(surface.eta_12), zero, zero});

  const V still = set<Number>(query.submerged ? 0.0 : 1.0);
  V value, g1, g2, g3, M3, delta, gamma;
  V stretch = one;  // bound on q
  Symmetric<Number> H;
  if (query.hydrostatic) {
    value = eta - still * place.zeta;
    g1 = eta1;
    g2 = eta2;
    g3 = hn::Neg(still);
    H = {surface.eta_11, surface.eta_22, zero, surface.eta_12, zero, zero};
    M3 = L3;
    delta = epsilon;
    gamma = zero;
    model.too_steep = hn::Gt(zero, one);
  } else {
    const V q = one / hn::MulAdd(eta, l, one);
    const V b = q * q * hn::MulAdd(place.zeta, l, one);
    const V b1 = hn::Neg(b) * eta1;
    const V b2 = hn::Neg(b) * eta2;
    const V lqq = l * q * q;
    value = hn::NegMulAdd(still, place.zeta, f.f);
    g1 = hn::MulAdd(b1, f.f_3, f.f_1);
    g2 = hn::MulAdd(b2, f.f_3, f.f_2);
    g3 = hn::MulSub(q, f.f_3, still);
    const V f_22 = hn::Neg(f.f_11) - f.f_33;
    const V twice_bql = two * b * q * l;
    const V z11 = hn::MulSub(twice_bql * eta1, eta1, b * surface.eta_11);
    const V z12 = hn::MulSub(twice_bql * eta1, eta2, b * surface.eta_12);
    const V z22 = hn::MulSub(twice_bql * eta2, eta2, b * surface.eta_22);
    const V c1 = hn::MulAdd(b1, f.f_33, f.f_13);
    const V c2 = hn::MulAdd(b2, f.f_33, f.f_23);
    H[0] = f.f_11 + b1 * (f.f_13 + c1) + f.f_3 * z11;
    H[1] = f_22 + b2 * (f.f_23 + c2) + f.f_3 * z22;
    H[2] = q * q * f.f_33;
    H[3] = f.f_12 + b1 * f.f_23 + b2 * c1 + f.f_3 * z12;
    H[4] = hn::NegMulAdd(lqq * eta1, f.f_3, q * c1);
    H[5] = hn::NegMulAdd(lqq * eta2, f.f_3, q * c2);

    // Bounds on the derivatives of the stretched height over the ball.
    const V lowest = hn::Max(hn::MulAdd(l, eta - r * L1 - epsilon, one), set<Number>(1e-6));
    const V q_max = one / lowest;
    stretch = q_max;
    const V w_max = hn::Max(hn::MulAdd(l, place.zeta + r, one), zero);
    const V qq = q_max * q_max;
    const V lL1 = l * L1;
    const V slope2 = hn::MulAdd(two * q_max * lL1, L1, L2) * qq;
    const V Q1 = l * qq * L1;
    const V Q2 = l * slope2;
    const V b_1 = w_max * qq * L1;
    const V b_2 = w_max * slope2;
    const V b_3 = w_max * qq * (L3 + set<Number>(6.0) * q_max * lL1 * hn::MulAdd(q_max * lL1, L1, L2));
    const V trace = one + qq + b_1 * b_1;
    const V root = hn::Sqrt(hn::Max(trace * trace - set<Number>(4.0) * qq, zero));
    const V V1 = hn::Max(hn::Sqrt(half * (trace + root)), one);
    const V V2 = Q1 + b_2;
    const V V3 = hn::MulAdd(set<Number>(1.1547006), Q2, b_3);

    const V shift = w_max * qq * epsilon;
    const ReachBounds<Number> inside =
        bounds_at<Number>(volume_bounds, volume_cell, volume_reach + hn::MulAdd(r, V1, shift));
    const Symmetric<Number> Df2{f.f_11, f_22, f.f_33, f.f_12, f.f_13, f.f_23};
    const V F3 = inside.third;
    // The largest eigenvalue of a traceless symmetric matrix is at most sqrt(2/3) times its Frobenius norm.
    const V F2 = hn::MulAdd(r * V1, F3, hn::Sqrt(set<Number>(2.0 / 3.0) * frobenius_squared<Number>(Df2)));
    const V Df = hn::Sqrt(hn::MulAdd(f.f_1, f.f_1, hn::MulAdd(f.f_2, f.f_2, f.f_3 * f.f_3)));
    const V F1 = hn::MulAdd(r * V1, F2, Df);
    M3 = F3 * V1 * V1 * V1 + set<Number>(3.0) * F2 * V1 * V2 + F1 * V3;
    delta =
        hn::MulAdd(F1, shift, inside.truncation) + rounding * (inside.sum + still * hn::Abs(place.zeta) + r);

    const V z = stretched<Number>(query, place, eta);
    const V Z = hn::MulAdd(r, hn::Sqrt(hn::MulAdd(b_1, b_1, qq)), shift);
    const V column = hn::Max(Z, hn::Abs(z));
    const V R = hn::Sqrt(hn::MulAdd(r, r, column * column));
    const ReachBounds<Number> around = bounds_at<Number>(volume_bounds, volume_cell, volume_reach + R);
    const V vertical = hn::Sqrt(hn::MulAdd(f.f_13, f.f_13, hn::MulAdd(f.f_23, f.f_23, f.f_33 * f.f_33)));
    gamma = q_max * (f.f_3 + R * (vertical + half * R * around.third) + around.slope);
    model.too_steep = hn::And(hn::Ge(q * f.f_3, one), hn::Lt(hn::Abs(z), r));
  }

  const auto certain = hn::Or(wet, hn::Lt(gamma, one));
  // Without a certificate: Lemma C, with the pressure of the depth under the tangent plane of the surface.
  const V deepest = hn::Max(hn::Neg(s_low), zero);
  const V tangent_delta = half * L2 * r * r + epsilon + deepest * stretch * set<Number>(query.slope);
  // Without an expansion: Lemma D.
  const V amplitude = set<Number>(query.amplitude);
  const V highest = place.zeta + r;
  const auto deep = hn::Lt(highest, hn::Neg(amplitude));
  const V flat_delta = hn::IfThenElse(deep, amplitude, two * amplitude);
  const V quadratic_error = hn::MulAdd(M3 * set<Number>(1.0 / 6.0), r * r * r, delta);

  const auto use_quadratic =
      hn::And(certain, hn::Le(quadratic_error, hn::Min(flat_delta, set<Number>(1e30))));
  const auto use_tangent = hn::AndNot(
      use_quadratic, hn::And(hn::Lt(tangent_delta, flat_delta), hn::Not(set_mask<Number>(query.submerged))));
  const auto select = [&](const V& quadratic, const V& tangent, const V& flat) {
    return hn::IfThenElse(use_quadratic, quadratic, hn::IfThenElse(use_tangent, tangent, flat));
  };
  const V minus_zeta = hn::Neg(still * place.zeta);
  for (V& entry : H) entry = hn::IfThenElseZero(use_quadratic, entry);
  const V model_value = select(value, hn::Neg(s), minus_zeta);
  model.phi = in_body_axes<Number>(
      query, model_value,
      {select(g1, eta1, zero), select(g2, eta2, zero), select(g3, hn::Neg(one), hn::Neg(still))}, H);
  model.third = hn::IfThenElseZero(use_quadratic, M3) * set<Number>(query.k_max * query.k_max);
  model.curvature = hn::Sqrt(frobenius_squared<Number>(H)) * set<Number>(query.k_max);
  // The rounding of the integrals themselves.
  const auto flat = hn::Not(hn::Or(use_quadratic, use_tangent));
  const V steepness = one + hn::IfThenZeroElse(flat, L1 + hn::IfThenElseZero(use_quadratic, hn::Abs(g3)));
  const V size =
      hn::Abs(model_value) + r * steepness + r * r * model.curvature * set<Number>(1.0 / query.k_max);
  model.delta = (select(delta, tangent_delta, flat_delta) + set<Number>(16.0 * query.unit_roundoff) * size) *
                set<Number>(1.0 / query.k_max);
  // Which parts are wet: the test of the surface decides for the quadratic model, the model's own sign for
  // the others.
  model.whole = hn::Or(hn::And(hn::Not(flat), wet),
                       hn::And(flat, hn::Or(hn::Lt(highest, zero), set_mask<Number>(query.submerged))));
  model.dry = hn::Or(model.dry, hn::And(flat, hn::And(hn::Gt(place.zeta - r, amplitude),
                                                      hn::Not(set_mask<Number>(query.submerged)))));
  return model;
}

// Integrals over a patch, B axes, over rho g.
template <typename Number>
struct PatchIntegrals {
  Vectors3<Number> force;   // [m^3], -int psi n dA
  Vectors3<Number> torque;  // [m^4], about the reference point
  VectorOf<Number> volume;  // [m^3]
  Vectors3<Number> moment;  // [m^4], int (x - c) dV
  VectorOf<Number> force_error, torque_error;
};

template <typename Number>
struct PatchMoments {
  Vectors3<Number> center;
  VectorOf<Number> radius, area, mu2, mu3;
  std::array<VectorOf<Number>, 3> S;
  std::array<VectorOf<Number>, 9> N;
  std::array<VectorOf<Number>, 18> P;
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

// int (value + gradient . y) y_j n_k dA.
template <typename Number>
HWY_INLINE VectorOf<Number> integral_with_offset(const PatchMoments<Number>& m, const VectorOf<Number>& value,
                                                 const Vectors3<Number>& gradient, std::size_t j,
                                                 std::size_t k) {
  constexpr std::size_t kPair[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  auto sum = value * m.N[3 * j + k];
  sum = hn::MulAdd(gradient.x, m.P[3 * kPair[0][j] + k], sum);
  sum = hn::MulAdd(gradient.y, m.P[3 * kPair[1][j] + k], sum);
  return hn::MulAdd(gradient.z, m.P[3 * kPair[2][j] + k], sum);
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
HWY_INLINE Vectors3<Number> axis_of(const std::array<Number, 3>& axis) {
  const LanesOf<Number> d;
  return {hn::Set(d, axis[0]), hn::Set(d, axis[1]), hn::Set(d, axis[2])};
}

template <typename Number>
HWY_INLINE void clear_where(const hn::Mask<LanesOf<Number>>& mask, PatchIntegrals<Number>& integrals) {
  for (VectorOf<Number>* v :
       {&integrals.force.x, &integrals.force.y, &integrals.force.z, &integrals.torque.x, &integrals.torque.y,
        &integrals.torque.z, &integrals.volume, &integrals.moment.x, &integrals.moment.y, &integrals.moment.z,
        &integrals.force_error, &integrals.torque_error}) {
    *v = hn::IfThenZeroElse(mask, *v);
  }
}

// The integrals of a model over whole patches, or over patches that the surface crosses and that are not
// clipped.
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
  const ClippedModel<Number> depth = clipped_model<Number>(negative<Number>(model.s), m.radius, model.whole);
  result.volume = hn::Neg(dot<Number>(up, integral_with_normal<Number>(m, depth.quadratic)));
  const auto along_up = [&](std::size_t j) {
    const auto of = [&](std::size_t k) {
      return integral_with_offset<Number>(m, depth.linear_value, depth.linear_gradient, j, k);
    };
    return hn::Neg(dot<Number>(up, {of(0), of(1), of(2)}));
  };
  // int (y - s/2 up) s n_z dA; s^2 as the product of the linear models.
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
  const V half_square = half * dot<Number>(up, integral_with_normal<Number>(m, squared));
  result.moment = scaled<Number>(result.volume, m.center) +
                  Vectors3<Number>{along_up(0), along_up(1), along_up(2)} - scaled<Number>(half_square, up);

  const V mu1 = hn::Sqrt(m.area * m.mu2);
  const V remainder = model.third * m.mu3 * set<Number>(1.0 / 6.0) + model.delta * m.area;
  const V of_hessian = hn::IfThenElse(model.whole, set<Number>(0.0), set<Number>(0.25));
  result.force_error = remainder + phi.quadratic_error * m.area + of_hessian * model.curvature * m.mu2;
  const V local = phi.linear_error * mu1 + model.delta * mu1 +
                  half * hn::MulAdd(model.third * m.radius, set<Number>(1.0 / 3.0), model.curvature) * m.mu3;
  result.torque_error = hn::Sqrt(dot<Number>(lever, lever)) * result.force_error + local;
  clear_where<Number>(model.dry, result);
  return result;
}

// Triangles relative to their patch's centroid, and what is integrated over them.
template <typename Number>
struct TriangleLanes {
  std::array<Vectors3<Number>, 3> corners;
  Quadratic<Number> phi, s;
  VectorOf<Number> curvature;
  hn::Mask<LanesOf<Number>> whole, none;
};

template <typename Number>
struct TriangleIntegrals {
  Vectors3<Number> force;          // int phi n dA
  Vectors3<Number> offset_torque;  // int y x phi n dA
  VectorOf<Number> volume;         // int s n_z dA
  Vectors3<Number> moment;         // int (y - s/2 up) s n_z dA
  VectorOf<Number> strip;          // [m^3], the error of clipping
  VectorOf<Number> cubic;          // [m^4], what the offset torque leaves out
};

template <typename Number>
HWY_INLINE VectorOf<Number> value_at(const Quadratic<Number>& q, const Vectors3<Number>& y) {
  const Vectors3<Number> h = product<Number>(q.hessian, y);
  return q.value + dot<Number>(q.gradient, y) + set<Number>(0.5) * dot<Number>(h, y);
}

// Adds `weight` times the integrals over a triangle with these corners and this area vector.
template <typename Number>
HWY_INLINE void add_triangle(const std::array<Vectors3<Number>, 3>& corners,
                             const Vectors3<Number>& area_vector, const VectorOf<Number>& weight,
                             const Vectors3<Number>& up, const TriangleLanes<Number>& t,
                             TriangleIntegrals<Number>& sum) {
  using V = VectorOf<Number>;
  const V third = set<Number>(1.0 / 3.0);
  const V half = set<Number>(0.5);
  const Vectors3<Number> mid = scaled<Number>(third, corners[0] + corners[1] + corners[2]);
  Symmetric<Number> c;
  for (V& entry : c) entry = set<Number>(0.0);
  V far = set<Number>(0.0);
  for (const Vectors3<Number>& corner : corners) {
    const Vectors3<Number> y = corner - mid;
    c[0] = hn::MulAdd(y.x, y.x, c[0]);
    c[1] = hn::MulAdd(y.y, y.y, c[1]);
    c[2] = hn::MulAdd(y.z, y.z, c[2]);
    c[3] = hn::MulAdd(y.x, y.y, c[3]);
    c[4] = hn::MulAdd(y.x, y.z, c[4]);
    c[5] = hn::MulAdd(y.y, y.z, c[5]);
    far = hn::Max(far, dot<Number>(y, y));
  }
  for (V& entry : c) entry = entry * set<Number>(1.0 / 12.0);
  const auto contraction = [&](const Symmetric<Number>& h) {
    return hn::MulAdd(h[0], c[0], hn::MulAdd(h[1], c[1], h[2] * c[2])) +
           set<Number>(2.0) * hn::MulAdd(h[3], c[3], hn::MulAdd(h[4], c[4], h[5] * c[5]));
  };
  const auto integrate_one = [&](const Quadratic<Number>& q, V& mean, Vectors3<Number>& offset, V& middle,
                                 Vectors3<Number>& gradient) {
    gradient = q.gradient + product<Number>(q.hessian, mid);
    middle = value_at<Number>(q, mid);
    mean = hn::MulAdd(half, contraction(q.hessian), middle);
    offset = scaled<Number>(mean, mid) + product<Number>(c, gradient);
  };
  V mean, middle;
  Vectors3<Number> offset, gradient;
  const Vectors3<Number> area = scaled<Number>(weight, area_vector);
  integrate_one(t.phi, mean, offset, middle, gradient);
  sum.force = sum.force + scaled<Number>(mean, area);
  sum.offset_torque = sum.offset_torque + cross<Number>(offset, area);
  integrate_one(t.s, mean, offset, middle, gradient);
  const V vertical = dot<Number>(up, area);
  sum.volume = hn::MulAdd(vertical, mean, sum.volume);
  const V half_square =
      half * hn::MulAdd(middle, middle, dot<Number>(gradient, product<Number>(c, gradient)));
  sum.moment = sum.moment + scaled<Number>(vertical, offset - scaled<Number>(half_square, up));
  const V trace = c[0] + c[1] + c[2];
  sum.cubic =
      hn::MulAdd(half * t.curvature * hn::Abs(weight) * hn::Sqrt(dot<Number>(area_vector, area_vector)),
                 trace * hn::Sqrt(far), sum.cubic);
}

// The corner that is alone on its side of 0, and the others in cyclic order.
template <typename Number>
struct LoneCorner {
  hn::Mask<LanesOf<Number>> second, third;  // it is the second, the third; otherwise the first
  hn::Mask<LanesOf<Number>> lone_positive, lone_negative, all_positive;

  template <typename T>
  HWY_INLINE T pick(const T& first, const T& if_second, const T& if_third) const {
    return hn::IfThenElse(second, if_second, hn::IfThenElse(third, if_third, first));
  }
};

template <typename Number>
HWY_INLINE LoneCorner<Number> lone_corner(const std::array<VectorOf<Number>, 3>& t) {
  const auto zero = set<Number>(0.0);
  const auto p0 = hn::Gt(t[0], zero);
  const auto p1 = hn::Gt(t[1], zero);
  const auto p2 = hn::Gt(t[2], zero);
  LoneCorner<Number> lone;
  const auto same02 = hn::Not(hn::Xor(p0, p2));
  const auto same01 = hn::Not(hn::Xor(p0, p1));
  lone.second = hn::And(same02, hn::Xor(p0, p1));
  lone.third = hn::And(same01, hn::Xor(p0, p2));
  const auto any = hn::Or(p0, hn::Or(p1, p2));
  lone.all_positive = hn::And(p0, hn::And(p1, p2));
  const auto mixed = hn::AndNot(lone.all_positive, any);
  const auto two = hn::Or(hn::And(p0, p1), hn::Or(hn::And(p0, p2), hn::And(p1, p2)));
  lone.lone_positive = hn::AndNot(two, mixed);
  lone.lone_negative = hn::And(two, mixed);
  return lone;
}

// The mean of max(u, 0) over a triangle on which u is linear.
template <typename Number>
HWY_INLINE VectorOf<Number> mean_of_positive_part(const std::array<VectorOf<Number>, 3>& u) {
  using V = VectorOf<Number>;
  const LoneCorner<Number> lone = lone_corner<Number>(u);
  const V p = lone.pick(u[0], u[1], u[2]);
  const V q = lone.pick(u[1], u[2], u[0]);
  const V r = lone.pick(u[2], u[0], u[1]);
  const V mean = (u[0] + u[1] + u[2]) * set<Number>(1.0 / 3.0);
  const auto mixed = hn::Or(lone.lone_positive, lone.lone_negative);
  const V product = hn::IfThenElse(mixed, (p - q) * (p - r), set<Number>(1.0));
  const V tip = p * p * p * set<Number>(1.0 / 3.0) / hn::Max(product, set<Number>(1e-37));
  return hn::IfThenElse(
      lone.all_positive, mean,
      hn::IfThenElse(lone.lone_positive, tip, hn::IfThenElseZero(lone.lone_negative, mean - tip)));
}

template <typename Number>
HWY_INLINE TriangleIntegrals<Number> integrate(const PatchQuery<Number>& query,
                                               const TriangleLanes<Number>& t) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const Vectors3<Number> up = axis_of<Number>(query.up_B);
  const Vectors3<Number> normal = cross<Number>(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
  const Vectors3<Number> area = scaled<Number>(set<Number>(0.5), normal);
  std::array<V, 3> values;
  for (std::size_t i = 0; i < 3; ++i) values[i] = value_at<Number>(t.phi, t.corners[i]);
  const LoneCorner<Number> lone = lone_corner<Number>(values);

  TriangleIntegrals<Number> sum{{zero, zero, zero}, {zero, zero, zero}, zero, {zero, zero, zero}, zero, zero};
  const auto counts = hn::Or(t.whole, hn::Or(lone.all_positive, lone.lone_negative));
  const V of_whole = hn::IfThenZeroElse(t.none, hn::IfThenElseZero(counts, one));
  add_triangle<Number>(t.corners, area, of_whole, up, t, sum);

  const auto pick = [&](std::size_t first) {
    const Vectors3<Number>& a = t.corners[first];
    const Vectors3<Number>& b = t.corners[(first + 1) % 3];
    const Vectors3<Number>& c = t.corners[(first + 2) % 3];
    return Vectors3<Number>{lone.pick(a.x, b.x, c.x), lone.pick(a.y, b.y, c.y), lone.pick(a.z, b.z, c.z)};
  };
  const Vectors3<Number> p = pick(0);
  const Vectors3<Number> q = pick(1);
  const Vectors3<Number> r = pick(2);
  const V value_p = lone.pick(values[0], values[1], values[2]);
  const V value_q = lone.pick(values[1], values[2], values[0]);
  const V value_r = lone.pick(values[2], values[0], values[1]);
  const auto clipped = hn::AndNot(hn::Or(t.whole, t.none), hn::Or(lone.lone_positive, lone.lone_negative));
  const V to_q = hn::IfThenElseZero(clipped, value_p / hn::IfThenElse(clipped, value_p - value_q, one));
  const V to_r = hn::IfThenElseZero(clipped, value_p / hn::IfThenElse(clipped, value_p - value_r, one));
  const V sign = hn::IfThenElseZero(clipped, hn::IfThenElse(lone.lone_positive, one, hn::Neg(one)));
  add_triangle<Number>({p, p + scaled<Number>(to_q, q - p), p + scaled<Number>(to_r, r - p)},
                       scaled<Number>(to_q * to_r, area), sign, up, t, sum);

  const Vectors3<Number> mid =
      scaled<Number>(set<Number>(1.0 / 3.0), t.corners[0] + t.corners[1] + t.corners[2]);
  V far = zero;
  for (const Vectors3<Number>& corner : t.corners) {
    const Vectors3<Number> y = corner - mid;
    far = hn::Max(far, dot<Number>(y, y));
  }
  const V D = set<Number>(0.5) * t.curvature * far;
  const auto shifted = [&](const V& by) {
    return std::array<V, 3>{values[0] + by, values[1] + by, values[2] + by};
  };
  const V largest = hn::Max(hn::Abs(values[0]), hn::Max(hn::Abs(values[1]), hn::Abs(values[2])));
  const V difference = mean_of_positive_part<Number>(shifted(D)) -
                       set<Number>(2.0) * mean_of_positive_part<Number>(values) +
                       mean_of_positive_part<Number>(shifted(hn::Neg(D)));
  const V strip =
      hn::Min(hn::Max(difference, zero), D) + set<Number>(16.0 * query.unit_roundoff) * (largest + D);
  sum.strip = hn::IfThenZeroElse(hn::Or(t.whole, t.none), strip * hn::Sqrt(dot<Number>(area, area)));
  return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_PATCHES_INL_H
