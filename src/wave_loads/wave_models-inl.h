// Models of the pressure on patches of the surface and bounds on their errors, with SIMD
// (docs/wave_mathematics.md, "Local bounds" to "Truncation"). Included once per instruction set.
//
// Positions, elevations and f are in units of 1 / k_max here, so that slopes and all derivatives are pure
// numbers. What leaves a function is in metres.
#if defined(BUOYANCY_WAVE_MODELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_MODELS_INL_H
#undef BUOYANCY_WAVE_MODELS_INL_H
#else
#define BUOYANCY_WAVE_MODELS_INL_H
#endif

#include <array>
#include <cstddef>

#include <hwy/highway.h>

#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_places-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A quadratic function of y = x - m, B axes, y in metres.
template <typename Number>
struct Quadratic {
  VectorOf<Number> value;     // [m]
  Vectors3<Number> gradient;  // [-]
  Symmetric<Number> hessian;  // [1/m]
};

// What a quadratic model about m leaves out: C[y, y, y] / 6 with a known norm of C, and the rest.
template <typename Number>
struct CubicBounds {
  VectorOf<Number> norm;    // [1/m^2], Frobenius norm of the third derivative at m as far as it is known
  VectorOf<Number> rest;    // [1/m^2], operator norm of what is not known of it
  VectorOf<Number> fourth;  // [1/m^3], M_4
};

template <typename Number>
struct PatchModel {
  Quadratic<Number> phi;            // model of the pressure over rho g
  Quadratic<Number> s;              // of the height over the surface
  VectorOf<Number> third;           // [1/m^2], M_3; 0 where the model is linear by intent
  CubicBounds<Number> cubic;        // 0 as well
  VectorOf<Number> third_of_parts;  // [1/m^2], an estimate of M_3 for patches of half the radius
  VectorOf<Number> delta_of_parts;  // [m], an estimate as well
  VectorOf<Number> curvature;       // [1/m], |H|
  VectorOf<Number> delta;           // [m], error of the model over the whole patch
  VectorOf<Number> mean_delta;      // [m], a bound on the mean of that error
  VectorOf<Number> s_third;         // [1/m^2], L_3; 0 where the model of s is linear
  CubicBounds<Number> s_cubic;
  VectorOf<Number> s_curvature;  // [1/m], |D^2 eta|, as s_third
  VectorOf<Number> s_delta;      // [m], error of the model of s over the whole patch
  // Bound on |s| over |phi| where the pressure's model alone finds a point wet, or dry.
  VectorOf<Number> s_per_phi;
  hn::Mask<LanesOf<Number>> dry, whole;  // nothing is wet; nothing is clipped
  hn::Mask<LanesOf<Number>> wet;         // all is wet, and nothing is clipped
  hn::Mask<LanesOf<Number>> too_steep;
};

// Stands for a bound where there is none: larger than any that is of use, and still a finite sum.
inline constexpr double kNoBound = 1e20;
// The least height of the water over the bed, over the depth, with which there are bounds.
inline constexpr double kShallowest = 1e-6;

template <typename Number>
HWY_INLINE CubicBounds<Number> in_metres(const PatchQuery<Number>& query, const CubicBounds<Number>& bounds,
                                         const hn::Mask<LanesOf<Number>>& valid) {
  const double k = query.k_max;
  return {hn::IfThenElseZero(valid, bounds.norm) * set<Number>(k * k),
          hn::IfThenElseZero(valid, bounds.rest) * set<Number>(k * k),
          hn::IfThenElseZero(valid, bounds.fourth) * set<Number>(k * k * k)};
}

// The columns of E, whose rows are e1, e2 and up: each B axis along these.
template <typename Number>
HWY_INLINE std::array<Vectors3<Number>, 3> body_axes_of(const PatchQuery<Number>& query) {
  const auto column = [&](std::size_t axis) HWY_ATTR {
    return axis_of<Number>({query.e1_B[axis], query.e2_B[axis], query.up_B[axis]});
  };
  return {column(0), column(1), column(2)};
}

// What follows is given along e1, e2 and up over 1 / k_max, and returned in B axes and metres.
template <typename Number>
HWY_INLINE Vectors3<Number> gradient_in_body_axes(const PatchQuery<Number>& query,
                                                  const Vectors3<Number>& gradient) {
  const auto [x, y, z] = body_axes_of<Number>(query);
  return {dot<Number>(gradient, x), dot<Number>(gradient, y), dot<Number>(gradient, z)};
}

// E^T H E
template <typename Number>
HWY_INLINE Symmetric<Number> hessian_in_body_axes(const PatchQuery<Number>& query,
                                                  const Symmetric<Number>& hessian) {
  const auto [x, y, z] = body_axes_of<Number>(query);
  const auto k = set<Number>(query.k_max);
  const Vectors3<Number> along_x = product<Number>(hessian, x);
  const Vectors3<Number> along_y = product<Number>(hessian, y);
  const Vectors3<Number> along_z = product<Number>(hessian, z);
  return {k * dot<Number>(x, along_x), k * dot<Number>(y, along_y), k * dot<Number>(z, along_z),
          k * dot<Number>(x, along_y), k * dot<Number>(x, along_z), k * dot<Number>(y, along_z)};
}

// The same of a function that does not depend on the height, by its second derivatives h_11, h_22 and h_12.
template <typename Number>
HWY_INLINE Symmetric<Number> level_hessian_in_body_axes(const PatchQuery<Number>& query,
                                                        const VectorOf<Number>& h11,
                                                        const VectorOf<Number>& h22,
                                                        const VectorOf<Number>& h12) {
  const Vectors3<Number> e1 = axis_of<Number>(query.e1_B);
  const Vectors3<Number> e2 = axis_of<Number>(query.e2_B);
  const auto k = set<Number>(query.k_max);
  const Vectors3<Number> first = scaled<Number>(k * h11, e1) + scaled<Number>(k * h12, e2);
  const Vectors3<Number> second = scaled<Number>(k * h12, e1) + scaled<Number>(k * h22, e2);
  const auto entry = [](const auto& a1, const auto& a2, const auto& b1, const auto& b2)
                         HWY_ATTR { return hn::MulAdd(a1, b1, a2 * b2); };
  return {entry(e1.x, e2.x, first.x, second.x), entry(e1.y, e2.y, first.y, second.y),
          entry(e1.z, e2.z, first.z, second.z), entry(e1.x, e2.x, first.y, second.y),
          entry(e1.x, e2.x, first.z, second.z), entry(e1.y, e2.y, first.z, second.z)};
}

// radius: [m]. spread: the root mean square of the distance from the centroid, over the radius. surface, f:
// the expansions at the place, of the elevation and of the pressure; *_bounds, *_reach: of the cells they
// come from, and how far the place is from these cells' centres, over 1 / k_max. f and its cell's are not
// used where the pressure is hydrostatic.
template <typename Number>
HWY_INLINE PatchModel<Number> model_of(const PatchQuery<Number>& query, const Place<Number>& place,
                                       const VectorOf<Number>& radius, const VectorOf<Number>& spread,
                                       const SurfaceValues<Number>& surface,
                                       const CellBounds<Number>& surface_bounds,
                                       const VectorOf<Number>& surface_reach, const VolumeValues<Number>& f,
                                       const CellBounds<Number>& volume_bounds,
                                       const VectorOf<Number>& volume_reach) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const V half = set<Number>(0.5);
  const V two = set<Number>(2.0);
  const V three = set<Number>(3.0);
  const V r = radius * set<Number>(query.k_max);
  const V rounding = set<Number>(query.rounding());
  const V over_bed = place.zeta - set<Number>(query.bed);  // of the centroid

  const V& eta = surface.eta;
  const V& eta1 = surface.eta_1;
  const V& eta2 = surface.eta_2;
  const SurfaceRange<Number> range =
      range_of<Number>(place.zeta, r, surface, surface_bounds, surface_reach, rounding);
  const V& s = range.s;
  const V& s_low = range.low;
  const V& s_high = range.high;
  const V& L1 = range.L1;
  const V& L2 = range.L2;
  const V& L3 = range.L3;
  const V& epsilon = range.epsilon;
  const V mean_truncation_of_eta =
      mean_truncation<Number>(surface_bounds, range.above, surface_reach, r, spread);

  PatchModel<Number> model;
  model.dry = hn::Gt(s_low, zero);
  const auto wet = hn::Or(hn::Lt(s_high, zero), set_mask<Number>(query.submerged));
  // Where the expansion says nothing about the surface, the volume is that under the water at rest.
  const V s_error = hn::MulAdd(L3 * set<Number>(1.0 / 6.0), r * r * r, epsilon);
  const auto known = hn::Le(s_error, set<Number>(query.amplitude));
  const auto if_known = [&](const V& number) { return hn::IfThenElseZero(known, hn::Neg(number)); };
  const V per_k = set<Number>(1.0 / query.k_max);
  model.s.value = per_k * (place.zeta + if_known(eta));
  model.s.gradient = gradient_in_body_axes<Number>(query, {if_known(eta1), if_known(eta2), one});
  model.s.hessian = level_hessian_in_body_axes<Number>(query, if_known(surface.eta_11),
                                                       if_known(surface.eta_22), if_known(surface.eta_12));
  const V s_size = hn::IfThenElse(known, hn::MulAdd(r, L1, hn::Abs(s)), hn::Abs(place.zeta)) + r;
  const V s_rest =
      hn::IfThenElse(known, epsilon, hn::MulAdd(rounding, hn::Abs(place.zeta), set<Number>(query.amplitude)));
  model.s_delta =
      (hn::MulAdd(set<Number>(query.integral_rounding), s_size, s_rest) + set<Number>(query.displacement)) *
      set<Number>(1.0 / query.k_max);
  model.s_third = hn::IfThenElseZero(known, L3) * set<Number>(query.k_max * query.k_max);
  const CubicBounds<Number> of_eta_cubic{two * surface.third, range.third_rest, range.L4};
  model.s_cubic = in_metres<Number>(query, of_eta_cubic, known);
  model.s_curvature = hn::IfThenElseZero(known, range.L2_at_point) * set<Number>(query.k_max);

  const V still = set<Number>(query.submerged ? 0.0 : 1.0);
  V value, g1, g2, g3, M3, delta, mean_delta, gamma;
  V M3_at_point;  // about M_3 of a small patch
  CubicBounds<Number> cubic = of_eta_cubic;
  V tangent_rest = zero;  // what Lemma C adds for the decay of the waves with the depth
  V steepest;             // bound on the gradient of the pressure
  const V deepest = hn::Max(hn::Neg(s_low), zero);
  const V slope_sum = set<Number>(query.slope);
  Symmetric<Number> H;
  if (query.hydrostatic) {
    value = eta - still * place.zeta;
    g1 = eta1;
    g2 = eta2;
    g3 = hn::Neg(still);
    H = {surface.eta_11, surface.eta_22, zero, surface.eta_12, zero, zero};
    M3 = L3;
    M3_at_point = surface.third;
    const V rest = hn::MulAdd(still * rounding, hn::Abs(place.zeta), range.rounded) +
                   set<Number>(query.displacement) * (still + L1 + range.above.slope);
    delta = range.above.truncation + rest;
    mean_delta = mean_truncation_of_eta + rest;
    gamma = zero;
    steepest = still + slope_sum;
    model.too_steep = hn::Gt(zero, one);
  } else {
    const V per_depth = set<Number>(query.per_depth);
    const V q = one / hn::Max(hn::MulAdd(eta, per_depth, one), set<Number>(kShallowest));
    const V b = q * q * hn::MulAdd(place.zeta, per_depth, one);
    const V b1 = hn::Neg(b) * eta1;
    const V b2 = hn::Neg(b) * eta2;
    const V lqq = per_depth * q * q;
    // Below the bed the waves do not change with the height.
    const auto above_bed = hn::Gt(over_bed, zero);
    const V f_3 = hn::IfThenElseZero(above_bed, f.f_3);
    const V f_13 = hn::IfThenElseZero(above_bed, f.f_13);
    const V f_23 = hn::IfThenElseZero(above_bed, f.f_23);
    const V f_33 = hn::IfThenElseZero(above_bed, f.f_33);
    value = hn::NegMulAdd(still, place.zeta, f.f);
    g1 = hn::MulAdd(b1, f_3, f.f_1);
    g2 = hn::MulAdd(b2, f_3, f.f_2);
    g3 = hn::MulSub(q, f_3, still);
    const V f_22 = hn::Neg(f.f_11) - f.f_33;
    const V twice_bql = two * b * q * per_depth;
    const V z11 = hn::MulSub(twice_bql * eta1, eta1, b * surface.eta_11);
    const V z12 = hn::MulSub(twice_bql * eta1, eta2, b * surface.eta_12);
    const V z22 = hn::MulSub(twice_bql * eta2, eta2, b * surface.eta_22);
    const V c1 = hn::MulAdd(b1, f_33, f_13);
    const V c2 = hn::MulAdd(b2, f_33, f_23);
    H[0] = f.f_11 + b1 * (f_13 + c1) + f_3 * z11;
    H[1] = f_22 + b2 * (f_23 + c2) + f_3 * z22;
    H[2] = q * q * f_33;
    H[3] = f.f_12 + b1 * f_23 + b2 * c1 + f_3 * z12;
    H[4] = hn::NegMulAdd(lqq * eta1, f_3, q * c1);
    H[5] = hn::NegMulAdd(lqq * eta2, f_3, q * c2);

    // Bounds on the derivatives of the stretched height over the ball, as far as it is above the bed.
    const V shallowest = hn::Max(hn::MulAdd(per_depth, eta - r * L1 - epsilon, one),
                                 hn::NegMulAdd(per_depth, set<Number>(query.amplitude), one));
    const auto below_bed = hn::Le(over_bed + r, zero);
    const V l = hn::IfThenZeroElse(below_bed, per_depth);
    const V q_max = hn::IfThenElse(below_bed, one, one / hn::Max(shallowest, set<Number>(kShallowest)));
    const V w_max = hn::IfThenZeroElse(below_bed, hn::MulAdd(l, place.zeta + r, one));
    const V qq = q_max * q_max;
    // Where a trough may reach the bed, the pressure may have any gradient, and a jump.
    const auto bounded = hn::Or(hn::Gt(shallowest, set<Number>(kShallowest)), hn::And(below_bed, wet));
    steepest = hn::IfThenElse(bounded, hn::MulAdd(slope_sum, one + q_max + w_max * qq * slope_sum, still),
                              set<Number>(kNoBound));
    const V l_L1 = l * L1;
    const V slope2 = hn::MulAdd(two * q_max * l_L1, L1, L2) * qq;
    const V Q1 = l * qq * L1;
    const V Q2 = l * slope2;
    const V b_1 = w_max * qq * L1;
    const V b_2 = w_max * slope2;
    const V slope3 = qq * (L3 + set<Number>(6.0) * q_max * l_L1 * hn::MulAdd(q_max * l_L1, L1, L2));
    const V b_3 = w_max * slope3;
    const V trace = one + qq + b_1 * b_1;
    const V root = hn::Sqrt(hn::Max(trace * trace - set<Number>(4.0) * qq, zero));
    const V V1 = hn::Max(hn::Sqrt(half * (trace + root)), one);
    const V V2 = Q1 + b_2;
    const V V3 = hn::MulAdd(set<Number>(1.1547006), Q2, b_3);
    const V ql_L1 = q_max * l_L1;
    const V b_4 = w_max * qq *
                  (range.L4 + q_max * l * hn::MulAdd(set<Number>(8.0) * L1, L3, set<Number>(6.0) * L2 * L2) +
                   ql_L1 * ql_L1 * hn::MulAdd(set<Number>(24.0) * ql_L1, L1, set<Number>(36.0) * L2));
    const V V4 = hn::MulAdd(set<Number>(1.2990382) * l, slope3, b_4);

    const V shift = w_max * qq * epsilon;
    const ReachBounds<Number> inside =
        bounds_at<Number>(volume_bounds, volume_reach + hn::MulAdd(r, V1, shift));
    const Symmetric<Number> D_f2{f.f_11, f_22, f.f_33, f.f_12, f.f_13, f.f_23};
    const V F3 = third_within<Number>(f.third, inside, r * V1, rounding);
    // The largest eigenvalue of a traceless symmetric matrix is at most sqrt(2/3) times its Frobenius norm.
    const V F2_at_point = hn::Sqrt(set<Number>(2.0 / 3.0) * frobenius_squared<Number>(D_f2));
    const V F2 = hn::MulAdd(r * V1, F3, F2_at_point);
    const V D_f = hn::Sqrt(hn::MulAdd(f.f_1, f.f_1, hn::MulAdd(f.f_2, f.f_2, f.f_3 * f.f_3)));
    const V F1 = hn::MulAdd(r * V1, F2, D_f);
    M3_at_point = f.third + three * F2_at_point * range.L2_at_point + D_f * surface.third;
    const V V1_cubed = V1 * V1 * V1;
    M3 = F3 * V1_cubed + three * F2 * V1 * V2 + F1 * V3;
    const V six = set<Number>(6.0);
    cubic.fourth = inside.fourth * V1_cubed * V1 + six * F3 * V1 * V1 * V2 +
                   F2 * hn::MulAdd(set<Number>(4.0) * V1, V3, three * V2 * V2) + F1 * V4;
    const V vertical = hn::Sqrt(hn::MulAdd(f.f_13, f.f_13, hn::MulAdd(f.f_23, f.f_23, f.f_33 * f.f_33)));
    // Frobenius norms of the derivatives of the stretched height at m.
    const V root2 = set<Number>(1.4142136);
    const V second = qq * hn::MulAdd(root2, range.L2_at_point, two * ql_L1 * L1);
    const V Z2 = hn::MulAdd(root2, Q1, w_max * second);
    const V Z3 = hn::MulAdd(
        three * l, second,
        w_max * qq * (two * surface.third + six * ql_L1 * hn::MulAdd(root2, range.L2_at_point, ql_L1 * L1)));
    const V abs_f_3 = hn::Abs(f.f_3);
    cubic.norm = set<Number>(1.5811389) * f.third * V1_cubed + three * vertical * V1 * Z2 + abs_f_3 * Z3;
    const V f_rest = hn::MulAdd(rounding, inside.third, third_rest_at<Number>(volume_bounds, volume_reach));
    cubic.rest = hn::MulAdd(f_rest, V1_cubed, abs_f_3 * w_max * qq * range.third_rest);
    const V mean_epsilon = hn::MulAdd(rounding, hn::Abs(place.zeta), range.rounded + mean_truncation_of_eta);
    const V steep = hn::MulAdd(F1 + inside.slope, hn::MulAdd(w_max * qq, range.above.slope, V1), still);
    const V rest =
        rounding * (inside.sum + still * hn::Abs(place.zeta) + r) + set<Number>(query.displacement) * steep;
    // What the model of one side of the bed is off by on the other.
    const V across = hn::Max(r - hn::Abs(over_bed), zero);
    const V bend = half * F2 * qq;
    const V at_bed = q_max * inside.slope * across;
    delta = hn::MulAdd(F1, shift, inside.truncation) + hn::MulAdd(bend * across, across, at_bed + rest);
    const V mean_across = hn::Min(across, spread * r);
    mean_delta =
        hn::MulAdd(F1 * w_max * qq, mean_epsilon,
                   mean_truncation<Number>(volume_bounds, inside, volume_reach + shift, r * V1, spread) +
                       hn::MulAdd(bend * mean_across, mean_across, at_bed + rest));

    const V z = stretched<Number>(query, place, eta);
    const V Z = hn::MulAdd(r, hn::Sqrt(hn::MulAdd(b_1, b_1, qq)), shift);
    const V column = hn::Max(Z, hn::Abs(z));
    const V R = hn::Sqrt(hn::MulAdd(r, r, column * column));
    const ReachBounds<Number> around = bounds_at<Number>(volume_bounds, volume_reach + R);
    const V third = third_within<Number>(f.third, around, R, rounding);
    gamma = q_max * (f.f_3 + R * (vertical + half * R * third) + around.slope);
    // Only where the expansion knows the surface well.
    const auto near_surface =
        hn::And(hn::Lt(hn::Abs(z), r), hn::Lt(epsilon, set<Number>(0.01 * query.amplitude)));
    model.too_steep = hn::And(hn::Ge(q * (f_3 - around.slope), one), near_surface);
    gamma = hn::IfThenElse(bounded, gamma, set<Number>(kNoBound));
    delta = hn::IfThenElse(bounded, delta, set<Number>(kNoBound));
    tangent_rest = hn::Min(deepest * q_max, hn::Neg(set<Number>(query.bed))) * slope_sum;
  }

  const auto certain = hn::Or(wet, hn::Lt(gamma, one));
  // Without a certificate: Lemma C, with the pressure of the depth under the tangent plane of the surface.
  const V tangent_delta = half * L2 * r * r + epsilon + tangent_rest;
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
  model.phi.value = per_k * model_value;
  model.phi.gradient = gradient_in_body_axes<Number>(
      query, {select(g1, eta1, zero), select(g2, eta2, zero), select(g3, hn::Neg(one), hn::Neg(still))});
  model.phi.hessian = hessian_in_body_axes<Number>(query, H);
  const V per_area = set<Number>(query.k_max * query.k_max);
  model.third = hn::IfThenElseZero(use_quadratic, M3) * per_area;
  model.cubic = in_metres<Number>(query, cubic, use_quadratic);
  // Bounds over a ball grow faster than exponentially with its radius.
  model.third_of_parts = hn::Sqrt(hn::Sqrt(M3 * M3_at_point) * M3_at_point) * per_area;
  model.curvature = hn::Sqrt(frobenius_squared<Number>(H)) * set<Number>(query.k_max);
  model.delta_of_parts = hn::IfThenElseZero(use_quadratic, mean_delta) * set<Number>(1.0 / query.k_max);
  // The rounding of the integrals themselves.
  const auto flat = hn::Not(hn::Or(use_quadratic, use_tangent));
  const V steepness = one + hn::IfThenZeroElse(flat, L1 + hn::IfThenElseZero(use_quadratic, hn::Abs(g3)));
  const V size =
      hn::Abs(model_value) + r * steepness + r * r * model.curvature * set<Number>(1.0 / query.k_max);
  const V displaced = set<Number>(query.displacement) * steepest;
  const V rounded = set<Number>(query.integral_rounding) * size;
  const V of_tangent = tangent_delta + displaced;
  const V of_flat = flat_delta + displaced;
  model.delta = per_k * (select(delta, of_tangent, of_flat) + rounded);
  model.mean_delta = per_k * (select(mean_delta, of_tangent, of_flat) + rounded);
  // Which parts are wet: the test of the surface decides for the quadratic model, the model's own sign for
  // the others.
  model.whole = hn::Or(hn::And(hn::Not(flat), wet),
                       hn::And(flat, hn::Or(hn::Lt(highest, zero), set_mask<Number>(query.submerged))));
  model.wet = hn::And(model.whole, wet);
  const V of_certificate = one / hn::Max(one - gamma - rounding, set<Number>(1e-30));
  model.s_per_phi = hn::IfThenZeroElse(model.wet, hn::IfThenElse(use_quadratic, of_certificate, one));
  model.dry = hn::Or(model.dry, hn::And(flat, hn::And(hn::Gt(place.zeta - r, amplitude),
                                                      hn::Not(set_mask<Number>(query.submerged)))));
  return model;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_MODELS_INL_H
