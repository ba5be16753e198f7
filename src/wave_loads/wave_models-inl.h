// Models of the pressure on patches of the surface and bounds on their errors, with SIMD. Included once per
// instruction set. In the order of docs/wave_mathematics.md: a patch's place and the height over the surface
// on it ("Local bounds", "Dry, wet, crossing"), the Taylor polynomials and what they leave out ("Truncation",
// "The bed"), the certificate (Lemma B), and the choice among the models of the lemmas.
//
// Positions, elevations and f are in units of 1 / k_max here, so that slopes and all derivatives are pure
// numbers. What leaves model_of() is in metres.
#if defined(BUOYANCY_WAVE_MODELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_MODELS_INL_H
#undef BUOYANCY_WAVE_MODELS_INL_H
#else
#define BUOYANCY_WAVE_MODELS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <hwy/highway.h>

#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// What is the same for all patches of a query.
template <typename Number>
struct PatchQuery {
  std::array<Number, 3> e1_B, e2_B, up_B;  // unit vectors
  std::array<Number, 3> reference;         // [m], B axes, relative to c
  double k_max = 1.0;                      // [rad/m]
  double zeta = 0.0;                       // [m], height of c over the level
  double per_depth = 0.0;                  // 1 / (k_max h); 0 in deep water
  double bed = 0.0;                        // -k_max h; below all numbers in deep water
  bool hydrostatic = false;
  // Whether the body is wet everywhere: its weight of water is added apart, and patches integrate f alone.
  bool submerged = false;
  double amplitude = 0.0;          // A_0 k_max
  double slope = 0.0;              // sum of a k, or what stands for it
  double unit_roundoff = 0.0;      // of Number
  double integral_rounding = 0.0;  // of a patch's integrals, relative
  double displacement = 0.0;       // of the surface, times k_max

  double rounding() const { return kRoundingFactor * unit_roundoff; }  // of an expansion
  double still() const { return submerged ? 0.0 : 1.0; }  // the share of -zeta that patches integrate
};

template <typename Number>
PatchQuery<Number> patch_query_of(const WaveQuery& query) {
  const auto narrow = [](const Vec3& v) {
    return std::array<Number, 3>{static_cast<Number>(v.x()), static_cast<Number>(v.y()),
                                 static_cast<Number>(v.z())};
  };
  PatchQuery<Number> patch;
  patch.e1_B = narrow(query.e1_B);
  patch.e2_B = narrow(query.e2_B);
  patch.up_B = narrow(query.up_B);
  patch.reference = narrow(query.reference);
  patch.k_max = query.k_max;
  patch.zeta = query.zeta;
  patch.per_depth = query.deep_water() ? 0.0 : 1.0 / (patch.k_max * query.depth);
  constexpr double kLowest = 0.25 * std::numeric_limits<Number>::max();
  patch.bed = -std::min(patch.k_max * query.depth, kLowest);
  patch.hydrostatic = query.hydrostatic;
  patch.submerged = query.submerged;
  patch.amplitude = query.max_elevation * patch.k_max;
  patch.slope = query.max_slope;
  patch.unit_roundoff = 0.5 * std::numeric_limits<Number>::epsilon();
  patch.integral_rounding = 16.0 * patch.unit_roundoff + std::numeric_limits<float>::epsilon();
  patch.displacement = query.displacement * patch.k_max;
  return patch;
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

// z' of the patches' centroids, which is that of the bed for points below it, and where there is no water.
template <typename Number>
HWY_INLINE VectorOf<Number> stretched(const PatchQuery<Number>& query, const Place<Number>& place,
                                      const VectorOf<Number>& eta) {
  const auto bed = set<Number>(query.bed);
  const auto column = hn::MulAdd(eta, set<Number>(query.per_depth), set<Number>(1.0));
  return hn::IfThenElse(hn::Gt(column, set<Number>(0.0)), hn::Max((place.zeta - eta) / column, bed), bed);
}

// A bound on the third derivative within a distance of a point, by that at the point and by the cell's norms.
// bounds: at the farthest reach.
template <typename Number>
HWY_INLINE VectorOf<Number> third_within(const VectorOf<Number>& at_point, const ReachBounds<Number>& bounds,
                                         const VectorOf<Number>& distance, const VectorOf<Number>& rounding) {
  const VectorOf<Number> there = hn::MulAdd(rounding, bounds.third, at_point + bounds.third_rest);
  return hn::Min(bounds.third, hn::MulAdd(distance, bounds.fourth, there));
}

// The height over the surface on a patch, over its ball, and the bounds on the derivatives of eta there.
template <typename Number>
struct SurfaceRange {
  VectorOf<Number> s, low, high;
  VectorOf<Number> L1, L2, L3, L4, L2_at_point;
  VectorOf<Number> third_rest;  // of D^3 eta at the point
  VectorOf<Number> rounded;     // error of eta by rounding
  VectorOf<Number> epsilon;     // error of s
  ReachBounds<Number> above;    // of the expansion of eta over the patch
};

// Sets L_1 and L_2, and the range of s but for its error, once L_3 is set. r: radius over 1 / k_max.
template <typename Number>
HWY_INLINE void set_variation(const VectorOf<Number>& zeta, const VectorOf<Number>& r,
                              const SurfaceValues<Number>& surface, SurfaceRange<Number>& range) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V half = set<Number>(0.5);
  range.s = zeta - surface.eta;
  const V mean = half * (surface.eta_11 + surface.eta_22);
  const V difference = half * (surface.eta_11 - surface.eta_22);
  const V deviator = hn::Sqrt(hn::MulAdd(difference, difference, surface.eta_12 * surface.eta_12));
  range.L2_at_point = hn::Abs(mean) + deviator;
  range.L2 = hn::MulAdd(r, range.L3, range.L2_at_point);
  const V slope_squared = hn::MulAdd(surface.eta_1, surface.eta_1, surface.eta_2 * surface.eta_2);
  range.L1 = hn::MulAdd(r, range.L2, hn::Sqrt(slope_squared));
  const V r_squared_half = half * r * r;
  const V variation = hn::MulAdd(r, hn::Sqrt(set<Number>(1.0) + slope_squared),
                                 r_squared_half * r * range.L3 * set<Number>(1.0 / 3.0));
  // -D^2 eta has the eigenvalues -mean -+ deviator.
  range.low = range.s - variation + r_squared_half * hn::Min(zero, hn::Neg(mean) - deviator);
  range.high = range.s + variation + r_squared_half * hn::Max(zero, deviator - mean);
}

template <typename Number>
HWY_INLINE SurfaceRange<Number> range_of(const VectorOf<Number>& zeta, const VectorOf<Number>& r,
                                         const SurfaceValues<Number>& surface,
                                         const CellBounds<Number>& bounds, const VectorOf<Number>& reach,
                                         const VectorOf<Number>& rounding) {
  SurfaceRange<Number> range;
  range.above = bounds_at<Number>(bounds, reach + r);
  range.L3 = third_within<Number>(surface.third, range.above, r, rounding);
  range.L4 = range.above.fourth;
  range.third_rest = hn::MulAdd(rounding, range.above.third, third_rest_at<Number>(bounds, reach));
  set_variation<Number>(zeta, r, surface, range);
  range.rounded = rounding * range.above.sum;
  range.epsilon = hn::MulAdd(rounding, hn::Abs(zeta), range.rounded + range.above.truncation);
  range.low = range.low - range.epsilon;
  range.high = range.high + range.epsilon;
  return range;
}

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
  Quadratic<Number> phi;               // model of the pressure over rho g
  Quadratic<Number> s;                 // of the height over the surface
  VectorOf<Number> third;              // [1/m^2], M_3; 0 where the model is linear by intent
  CubicBounds<Number> cubic;           // 0 as well
  VectorOf<Number> third_of_children;  // [1/m^2], an estimate of M_3 for patches of half the radius
  VectorOf<Number> delta_of_children;  // [m], an estimate as well
  VectorOf<Number> curvature;          // [1/m], |H|
  VectorOf<Number> delta;              // [m], error of the model over the whole patch
  VectorOf<Number> mean_delta;         // [m], a bound on the mean of that error
  VectorOf<Number> s_third;            // [1/m^2], L_3; 0 where the model of s is linear
  CubicBounds<Number> s_cubic;
  VectorOf<Number> s_curvature;  // [1/m], |D^2 eta|, as s_third
  VectorOf<Number> s_delta;      // [m], error of the model of s over the whole patch
  // c of Lemma F: a bound on |s| over |phi| where the pressure's model alone finds a point wet, or dry.
  VectorOf<Number> certificate_factor;
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

template <typename Number>
HWY_INLINE CubicBounds<Number> cubic_of_eta(const SurfaceValues<Number>& surface,
                                            const SurfaceRange<Number>& range) {
  return {set<Number>(2.0) * surface.third, range.third_rest, range.L4};
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

// Patches, and the surface of the sea above or below their centroids.
template <typename Number>
struct SurfaceField {
  Place<Number> place;
  VectorOf<Number> r;       // radius over 1 / k_max
  VectorOf<Number> spread;  // root mean square of the distance from the centroid, over the radius
  SurfaceValues<Number> surface;
};

// With the expansions of the sea, and the bounds of the cells that these come from.
template <typename Number>
struct PatchField : SurfaceField<Number> {
  const CellBounds<Number>* surface_bounds;
  VectorOf<Number> surface_reach;  // of the place from its cell's centre, over 1 / k_max
  // Not used where the pressure is hydrostatic.
  VolumeValues<Number> f;
  const CellBounds<Number>* volume_bounds;
  VectorOf<Number> volume_reach;  // the same, of Phi(m)
};

// What is known of a patch from the surface alone.
template <typename Number>
struct PatchSurface {
  SurfaceRange<Number> range;
  VectorOf<Number> mean_truncation;  // of eta
  hn::Mask<LanesOf<Number>> wet;     // all of the patch
};

template <typename Number>
HWY_INLINE PatchSurface<Number> surface_of(const PatchQuery<Number>& query, const PatchField<Number>& field) {
  PatchSurface<Number> surface;
  surface.range = range_of<Number>(field.place.zeta, field.r, field.surface, *field.surface_bounds,
                                   field.surface_reach, set<Number>(query.rounding()));
  surface.mean_truncation = mean_truncation<Number>(*field.surface_bounds, surface.range.above,
                                                    field.surface_reach, field.r, field.spread);
  surface.wet = hn::Or(hn::Lt(surface.range.high, set<Number>(0.0)), set_mask<Number>(query.submerged));
  return surface;
}

// Sets the model of s and its bounds ("Volume and its centre").
template <typename Number>
HWY_INLINE void set_height_model(const PatchQuery<Number>& query, const SurfaceField<Number>& field,
                                 const SurfaceRange<Number>& range, PatchModel<Number>& model) {
  using V = VectorOf<Number>;
  const V& r = field.r;
  const V& zeta = field.place.zeta;
  // Where the expansion says nothing about the surface, the volume is that under the water at rest.
  const V error = hn::MulAdd(range.L3 * set<Number>(1.0 / 6.0), r * r * r, range.epsilon);
  const auto known = hn::Le(error, set<Number>(query.amplitude));
  const auto if_known = [&](const V& number) { return hn::IfThenElseZero(known, hn::Neg(number)); };
  const V per_k = set<Number>(1.0 / query.k_max);
  model.s.value = per_k * (zeta + if_known(field.surface.eta));
  model.s.gradient = gradient_in_body_axes<Number>(
      query, {if_known(field.surface.eta_1), if_known(field.surface.eta_2), set<Number>(1.0)});
  model.s.hessian = level_hessian_in_body_axes<Number>(
      query, if_known(field.surface.eta_11), if_known(field.surface.eta_22), if_known(field.surface.eta_12));
  const V size = hn::IfThenElse(known, hn::MulAdd(r, range.L1, hn::Abs(range.s)), hn::Abs(zeta)) + r;
  const V rest =
      hn::IfThenElse(known, range.epsilon,
                     hn::MulAdd(set<Number>(query.rounding()), hn::Abs(zeta), set<Number>(query.amplitude)));
  model.s_delta =
      (hn::MulAdd(set<Number>(query.integral_rounding), size, rest) + set<Number>(query.displacement)) *
      per_k;
  model.s_third = hn::IfThenElseZero(known, range.L3) * set<Number>(query.k_max * query.k_max);
  model.s_cubic = in_metres<Number>(query, cubic_of_eta<Number>(field.surface, range), known);
  model.s_curvature = hn::IfThenElseZero(known, range.L2_at_point) * set<Number>(query.k_max);
}

// The Taylor polynomial of the pressure over rho g about m, along e1, e2 and up, and what bounds it.
template <typename Number>
struct PressureExpansion {
  VectorOf<Number> value;
  Vectors3<Number> gradient;
  Symmetric<Number> hessian;
  VectorOf<Number> M3;
  VectorOf<Number> M3_at_point;        // about M_3 of a small patch
  CubicBounds<Number> cubic;           // Lemma 4a
  VectorOf<Number> delta, mean_delta;  // "Truncation"
  VectorOf<Number> gamma;              // of the certificate, Lemma B
  VectorOf<Number> steepest;           // bound on the gradient of the pressure
  VectorOf<Number> tangent_rest;       // what Lemma C adds for the decay of the waves with the depth
  hn::Mask<LanesOf<Number>> too_steep;
};

// phi = -zeta + eta
template <typename Number>
HWY_INLINE PressureExpansion<Number> hydrostatic_pressure(const PatchQuery<Number>& query,
                                                          const SurfaceField<Number>& field,
                                                          const PatchSurface<Number>& surface) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V still = set<Number>(query.still());
  const SurfaceValues<Number>& at = field.surface;
  const SurfaceRange<Number>& range = surface.range;
  PressureExpansion<Number> p;
  p.value = at.eta - still * field.place.zeta;
  p.gradient = {at.eta_1, at.eta_2, hn::Neg(still)};
  p.hessian = {at.eta_11, at.eta_22, zero, at.eta_12, zero, zero};
  p.M3 = range.L3;
  p.M3_at_point = at.third;
  p.cubic = cubic_of_eta<Number>(at, range);
  const V rest = hn::MulAdd(still * set<Number>(query.rounding()), hn::Abs(field.place.zeta), range.rounded) +
                 set<Number>(query.displacement) * (still + range.L1 + range.above.slope);
  p.delta = range.above.truncation + rest;
  p.mean_delta = surface.mean_truncation + rest;
  p.gamma = zero;
  p.steepest = still + set<Number>(query.slope);
  p.tangent_rest = zero;
  p.too_steep = set_mask<Number>(false);
  return p;
}

// q = h / (h + eta) at the centroid.
template <typename Number>
HWY_INLINE VectorOf<Number> stretch_of(const PatchQuery<Number>& query, const VectorOf<Number>& eta) {
  const auto one = set<Number>(1.0);
  const auto column = hn::MulAdd(eta, set<Number>(query.per_depth), one);
  return one / hn::Max(column, set<Number>(kShallowest));
}

// f as it is continued below the bed, where the waves do not change with the height ("The bed").
template <typename Number>
HWY_INLINE VolumeValues<Number> held_at_bed(const VolumeValues<Number>& f, const VectorOf<Number>& over_bed) {
  const auto above_bed = hn::Gt(over_bed, set<Number>(0.0));
  VolumeValues<Number> held = f;
  for (VectorOf<Number>* along_z : {&held.f_3, &held.f_13, &held.f_23, &held.f_33}) {
    *along_z = hn::IfThenElseZero(above_bed, *along_z);
  }
  return held;
}

// Sets value, gradient and Hessian of phi = -zeta + f o Phi. held: f as it is continued below the bed.
template <typename Number>
HWY_INLINE void set_taylor_polynomial(const PatchQuery<Number>& query, const PatchField<Number>& field,
                                      const VolumeValues<Number>& held, PressureExpansion<Number>& p) {
  using V = VectorOf<Number>;
  const V two = set<Number>(2.0);
  const V still = set<Number>(query.still());
  const V per_depth = set<Number>(query.per_depth);
  const SurfaceValues<Number>& surface = field.surface;
  const VolumeValues<Number>& f = field.f;
  const V q = stretch_of<Number>(query, surface.eta);
  const V b = q * q * hn::MulAdd(field.place.zeta, per_depth, set<Number>(1.0));
  const V b1 = hn::Neg(b) * surface.eta_1;
  const V b2 = hn::Neg(b) * surface.eta_2;
  const V lqq = per_depth * q * q;
  p.value = hn::NegMulAdd(still, field.place.zeta, f.f);
  p.gradient = {hn::MulAdd(b1, held.f_3, f.f_1), hn::MulAdd(b2, held.f_3, f.f_2),
                hn::MulSub(q, held.f_3, still)};
  const V f_22 = hn::Neg(f.f_11) - f.f_33;
  const V twice_bql = two * b * q * per_depth;
  const V z11 = hn::MulSub(twice_bql * surface.eta_1, surface.eta_1, b * surface.eta_11);
  const V z12 = hn::MulSub(twice_bql * surface.eta_1, surface.eta_2, b * surface.eta_12);
  const V z22 = hn::MulSub(twice_bql * surface.eta_2, surface.eta_2, b * surface.eta_22);
  const V c1 = hn::MulAdd(b1, held.f_33, held.f_13);
  const V c2 = hn::MulAdd(b2, held.f_33, held.f_23);
  p.hessian[0] = f.f_11 + b1 * (held.f_13 + c1) + held.f_3 * z11;
  p.hessian[1] = f_22 + b2 * (held.f_23 + c2) + held.f_3 * z22;
  p.hessian[2] = q * q * held.f_33;
  p.hessian[3] = f.f_12 + b1 * held.f_23 + b2 * c1 + held.f_3 * z12;
  p.hessian[4] = hn::NegMulAdd(lqq * surface.eta_1, held.f_3, q * c1);
  p.hessian[5] = hn::NegMulAdd(lqq * surface.eta_2, held.f_3, q * c2);
}

// Bounds on the derivatives of the stretched height and of Phi over the ball, as far as it is above the bed.
template <typename Number>
struct StretchBounds {
  VectorOf<Number> q, qq, w, l;  // q and its square, (zeta + h)^+ / h, 1 / h
  VectorOf<Number> Q1, b1;
  VectorOf<Number> V1, V2, V3, V4;
  VectorOf<Number> shift;             // error of z' by that of eta
  hn::Mask<LanesOf<Number>> bounded;  // false where a trough may reach the bed
};

template <typename Number>
HWY_INLINE StretchBounds<Number> stretch_bounds(const PatchQuery<Number>& query,
                                                const PatchField<Number>& field,
                                                const PatchSurface<Number>& surface,
                                                const VectorOf<Number>& over_bed) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const V two = set<Number>(2.0);
  const V six = set<Number>(6.0);
  const V per_depth = set<Number>(query.per_depth);
  const V lowest_column = set<Number>(kShallowest);
  const SurfaceRange<Number>& range = surface.range;
  const V& r = field.r;
  const V& L1 = range.L1;
  const V& L2 = range.L2;
  const V& L3 = range.L3;
  const V shallowest = hn::Max(hn::MulAdd(per_depth, field.surface.eta - r * L1 - range.epsilon, one),
                               hn::NegMulAdd(per_depth, set<Number>(query.amplitude), one));
  const auto below_bed = hn::Le(over_bed + r, zero);
  StretchBounds<Number> z;
  z.bounded = hn::Or(hn::Gt(shallowest, lowest_column), hn::And(below_bed, surface.wet));
  z.l = hn::IfThenZeroElse(below_bed, per_depth);
  z.q = hn::IfThenElse(below_bed, one, one / hn::Max(shallowest, lowest_column));
  z.w = hn::IfThenZeroElse(below_bed, hn::MulAdd(z.l, field.place.zeta + r, one));
  z.qq = z.q * z.q;
  const V l_L1 = z.l * L1;
  const V slope2 = hn::MulAdd(two * z.q * l_L1, L1, L2) * z.qq;
  const V slope3 = z.qq * (L3 + six * z.q * l_L1 * hn::MulAdd(z.q * l_L1, L1, L2));
  z.Q1 = z.l * z.qq * L1;
  const V Q2 = z.l * slope2;
  z.b1 = z.w * z.qq * L1;
  const V b2 = z.w * slope2;
  const V b3 = z.w * slope3;
  const V ql_L1 = z.q * l_L1;
  const V b4 = z.w * z.qq *
               (range.L4 + z.q * z.l * hn::MulAdd(set<Number>(8.0) * L1, L3, six * L2 * L2) +
                ql_L1 * ql_L1 * hn::MulAdd(set<Number>(24.0) * ql_L1, L1, set<Number>(36.0) * L2));
  const V trace = one + z.qq + z.b1 * z.b1;
  const V root = hn::Sqrt(hn::Max(trace * trace - set<Number>(4.0) * z.qq, zero));
  z.V1 = hn::Max(hn::Sqrt(set<Number>(0.5) * (trace + root)), one);
  z.V2 = z.Q1 + b2;
  z.V3 = hn::MulAdd(set<Number>(1.1547006), Q2, b3);
  z.V4 = hn::MulAdd(set<Number>(1.2990382) * z.l, slope3, b4);
  z.shift = z.w * z.qq * range.epsilon;
  return z;
}

// Norms of the derivatives of f over the image of the ball, and of what the expansion of f leaves out there.
template <typename Number>
struct FieldBounds {
  ReachBounds<Number> inside;
  VectorOf<Number> F1, F2, F3;
  VectorOf<Number> F1_at_point, F2_at_point;
  VectorOf<Number> vertical;  // |D^2 f e_z| at the point
};

template <typename Number>
HWY_INLINE FieldBounds<Number> field_bounds(const PatchQuery<Number>& query, const PatchField<Number>& field,
                                            const StretchBounds<Number>& z) {
  using V = VectorOf<Number>;
  const VolumeValues<Number>& f = field.f;
  const V extent = field.r * z.V1;
  FieldBounds<Number> F;
  F.inside = bounds_at<Number>(*field.volume_bounds, field.volume_reach + hn::MulAdd(field.r, z.V1, z.shift));
  const V f_22 = hn::Neg(f.f_11) - f.f_33;
  const Symmetric<Number> D_f2{f.f_11, f_22, f.f_33, f.f_12, f.f_13, f.f_23};
  F.F3 = third_within<Number>(f.third, F.inside, extent, set<Number>(query.rounding()));
  // The largest eigenvalue of a traceless symmetric matrix is at most sqrt(2/3) times its Frobenius norm.
  F.F2_at_point = hn::Sqrt(set<Number>(2.0 / 3.0) * frobenius_squared<Number>(D_f2));
  F.F2 = hn::MulAdd(extent, F.F3, F.F2_at_point);
  F.F1_at_point = hn::Sqrt(hn::MulAdd(f.f_1, f.f_1, hn::MulAdd(f.f_2, f.f_2, f.f_3 * f.f_3)));
  F.F1 = hn::MulAdd(extent, F.F2, F.F1_at_point);
  F.vertical = hn::Sqrt(hn::MulAdd(f.f_13, f.f_13, hn::MulAdd(f.f_23, f.f_23, f.f_33 * f.f_33)));
  return F;
}

// Sets M_3 (Lemma 4) and what is known of the third derivative at m (Lemma 4a).
template <typename Number>
HWY_INLINE void set_third_and_fourth(const PatchQuery<Number>& query, const PatchField<Number>& field,
                                     const SurfaceRange<Number>& range, const StretchBounds<Number>& z,
                                     const FieldBounds<Number>& F, PressureExpansion<Number>& p) {
  using V = VectorOf<Number>;
  const V two = set<Number>(2.0);
  const V three = set<Number>(3.0);
  const V six = set<Number>(6.0);
  const V& third_of_f = field.f.third;
  const V& third_of_eta = field.surface.third;
  p.M3_at_point = third_of_f + three * F.F2_at_point * range.L2_at_point + F.F1_at_point * third_of_eta;
  const V V1_cubed = z.V1 * z.V1 * z.V1;
  p.M3 = F.F3 * V1_cubed + three * F.F2 * z.V1 * z.V2 + F.F1 * z.V3;
  p.cubic.fourth = F.inside.fourth * V1_cubed * z.V1 + six * F.F3 * z.V1 * z.V1 * z.V2 +
                   F.F2 * hn::MulAdd(set<Number>(4.0) * z.V1, z.V3, three * z.V2 * z.V2) + F.F1 * z.V4;
  // Frobenius norms of the derivatives of the stretched height at m.
  const V root2 = set<Number>(1.4142136);
  const V ql_L1 = z.q * (z.l * range.L1);
  const V second = z.qq * hn::MulAdd(root2, range.L2_at_point, two * ql_L1 * range.L1);
  const V Z2 = hn::MulAdd(root2, z.Q1, z.w * second);
  const V Z3 = hn::MulAdd(
      three * z.l, second,
      z.w * z.qq *
          (two * third_of_eta + six * ql_L1 * hn::MulAdd(root2, range.L2_at_point, ql_L1 * range.L1)));
  const V abs_f_3 = hn::Abs(field.f.f_3);
  p.cubic.norm =
      set<Number>(1.5811389) * third_of_f * V1_cubed + three * F.vertical * z.V1 * Z2 + abs_f_3 * Z3;
  const V rest_of_f = hn::MulAdd(set<Number>(query.rounding()), F.inside.third,
                                 third_rest_at<Number>(*field.volume_bounds, field.volume_reach));
  p.cubic.rest = hn::MulAdd(rest_of_f, V1_cubed, abs_f_3 * z.w * z.qq * range.third_rest);
}

// Sets delta and its mean: what the truncation of the expansions, rounding, the surface's displacement and
// the bed cost.
template <typename Number>
HWY_INLINE void set_truncation(const PatchQuery<Number>& query, const PatchField<Number>& field,
                               const PatchSurface<Number>& surface, const VectorOf<Number>& over_bed,
                               const StretchBounds<Number>& z, const FieldBounds<Number>& F,
                               PressureExpansion<Number>& p) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V still = set<Number>(query.still());
  const V rounding = set<Number>(query.rounding());
  const V abs_zeta = hn::Abs(field.place.zeta);
  const V& r = field.r;
  const SurfaceRange<Number>& range = surface.range;
  const V mean_epsilon = hn::MulAdd(rounding, abs_zeta, range.rounded + surface.mean_truncation);
  const V steep = hn::MulAdd(F.F1 + F.inside.slope, hn::MulAdd(z.w * z.qq, range.above.slope, z.V1), still);
  const V rest = rounding * (F.inside.sum + still * abs_zeta + r) + set<Number>(query.displacement) * steep;
  // What the model of one side of the bed is off by on the other (Lemma G).
  const V across = hn::Max(r - hn::Abs(over_bed), zero);
  const V bend = set<Number>(0.5) * F.F2 * z.qq;
  const V at_bed = z.q * F.inside.slope * across;
  p.delta = hn::MulAdd(F.F1, z.shift, F.inside.truncation) + hn::MulAdd(bend * across, across, at_bed + rest);
  const V mean_across = hn::Min(across, field.spread * r);
  p.mean_delta = hn::MulAdd(F.F1 * z.w * z.qq, mean_epsilon,
                            mean_truncation<Number>(*field.volume_bounds, F.inside,
                                                    field.volume_reach + z.shift, r * z.V1, field.spread) +
                                hn::MulAdd(bend * mean_across, mean_across, at_bed + rest));
  p.delta = hn::IfThenElse(z.bounded, p.delta, set<Number>(kNoBound));
  const V slope_sum = set<Number>(query.slope);
  // Where a trough may reach the bed, the pressure may have any gradient, and a jump.
  p.steepest =
      hn::IfThenElse(z.bounded, hn::MulAdd(slope_sum, set<Number>(1.0) + z.q + z.w * z.qq * slope_sum, still),
                     set<Number>(kNoBound));
  const V deepest = hn::Max(hn::Neg(range.low), zero);
  p.tangent_rest = hn::Min(deepest * z.q, hn::Neg(set<Number>(query.bed))) * slope_sum;
}

// Sets gamma of the certificate (Lemma B), and whether the sea is too steep for one. f_3: at the centroid,
// held at the bed.
template <typename Number>
HWY_INLINE void set_certificate(const PatchQuery<Number>& query, const PatchField<Number>& field,
                                const SurfaceRange<Number>& range, const VectorOf<Number>& f_3,
                                const StretchBounds<Number>& z, const FieldBounds<Number>& F,
                                PressureExpansion<Number>& p) {
  using V = VectorOf<Number>;
  const V& r = field.r;
  const V height = stretched<Number>(query, field.place, field.surface.eta);
  const V Z = hn::MulAdd(r, hn::Sqrt(hn::MulAdd(z.b1, z.b1, z.qq)), z.shift);
  const V column = hn::Max(Z, hn::Abs(height));
  const V R = hn::Sqrt(hn::MulAdd(r, r, column * column));
  const ReachBounds<Number> around = bounds_at<Number>(*field.volume_bounds, field.volume_reach + R);
  const V third = third_within<Number>(field.f.third, around, R, set<Number>(query.rounding()));
  const V gamma = z.q * (field.f.f_3 + R * (F.vertical + set<Number>(0.5) * R * third) + around.slope);
  p.gamma = hn::IfThenElse(z.bounded, gamma, set<Number>(kNoBound));
  // Only where the expansion knows the surface well.
  const auto near_surface =
      hn::And(hn::Lt(hn::Abs(height), r), hn::Lt(range.epsilon, set<Number>(0.01 * query.amplitude)));
  const V q = stretch_of<Number>(query, field.surface.eta);
  p.too_steep = hn::And(hn::Ge(q * (f_3 - around.slope), set<Number>(1.0)), near_surface);
}

// phi = -zeta + f o Phi, with Wheeler's stretching.
template <typename Number>
HWY_INLINE PressureExpansion<Number> stretched_pressure(const PatchQuery<Number>& query,
                                                        const PatchField<Number>& field,
                                                        const PatchSurface<Number>& surface) {
  const VectorOf<Number> over_bed = field.place.zeta - set<Number>(query.bed);  // of the centroid
  PressureExpansion<Number> p;
  const VolumeValues<Number> held = held_at_bed<Number>(field.f, over_bed);
  set_taylor_polynomial<Number>(query, field, held, p);
  const StretchBounds<Number> z = stretch_bounds<Number>(query, field, surface, over_bed);
  const FieldBounds<Number> F = field_bounds<Number>(query, field, z);
  set_third_and_fourth<Number>(query, field, surface.range, z, F, p);
  set_truncation<Number>(query, field, surface, over_bed, z, F, p);
  set_certificate<Number>(query, field, surface.range, held.f_3, z, F, p);
  return p;
}

// Sets the model of the pressure to the one of the lemmas that has the least error: T_2 where Lemma A or B
// hold, the tangent plane of Lemma C, or the water at rest of Lemma D.
template <typename Number>
HWY_INLINE void choose_model(const PatchQuery<Number>& query, const SurfaceField<Number>& field,
                             const PatchSurface<Number>& surface, const PressureExpansion<Number>& p,
                             PatchModel<Number>& model) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V one = set<Number>(1.0);
  const V& r = field.r;
  const V& zeta = field.place.zeta;
  const SurfaceRange<Number>& range = surface.range;
  const auto submerged = set_mask<Number>(query.submerged);
  const auto certain = hn::Or(surface.wet, hn::Lt(p.gamma, one));
  // Without a certificate: Lemma C, with the pressure of the depth under the tangent plane of the surface.
  const V tangent_delta = set<Number>(0.5) * range.L2 * r * r + range.epsilon + p.tangent_rest;
  // Without an expansion: Lemma D.
  const V amplitude = set<Number>(query.amplitude);
  const V highest = zeta + r;
  const auto deep = hn::Lt(highest, hn::Neg(amplitude));
  const V flat_delta = hn::IfThenElse(deep, amplitude, set<Number>(2.0) * amplitude);
  const V quadratic_error = hn::MulAdd(p.M3 * set<Number>(1.0 / 6.0), r * r * r, p.delta);

  const auto use_quadratic =
      hn::And(certain, hn::Le(quadratic_error, hn::Min(flat_delta, set<Number>(1e30))));
  const auto use_tangent =
      hn::AndNot(use_quadratic, hn::And(hn::Lt(tangent_delta, flat_delta), hn::Not(submerged)));
  const auto flat = hn::Not(hn::Or(use_quadratic, use_tangent));
  const auto select = [&](const V& of_quadratic, const V& of_tangent, const V& of_flat) {
    return hn::IfThenElse(use_quadratic, of_quadratic, hn::IfThenElse(use_tangent, of_tangent, of_flat));
  };
  const V still = set<Number>(query.still());
  const V per_k = set<Number>(1.0 / query.k_max);
  Symmetric<Number> H = p.hessian;
  for (V& entry : H) entry = hn::IfThenElseZero(use_quadratic, entry);
  const V value = select(p.value, hn::Neg(range.s), hn::Neg(still * zeta));
  model.phi.value = per_k * value;
  model.phi.gradient =
      gradient_in_body_axes<Number>(query, {select(p.gradient.x, field.surface.eta_1, zero),
                                            select(p.gradient.y, field.surface.eta_2, zero),
                                            select(p.gradient.z, hn::Neg(one), hn::Neg(still))});
  model.phi.hessian = hessian_in_body_axes<Number>(query, H);
  const V per_area = set<Number>(query.k_max * query.k_max);
  model.third = hn::IfThenElseZero(use_quadratic, p.M3) * per_area;
  model.cubic = in_metres<Number>(query, p.cubic, use_quadratic);
  // Bounds over a ball grow faster than exponentially with its radius.
  model.third_of_children = hn::Sqrt(hn::Sqrt(p.M3 * p.M3_at_point) * p.M3_at_point) * per_area;
  model.curvature = hn::Sqrt(frobenius_squared<Number>(H)) * set<Number>(query.k_max);
  model.delta_of_children = hn::IfThenElseZero(use_quadratic, p.mean_delta) * per_k;
  // The rounding of the integrals themselves.
  const V steepness =
      one + hn::IfThenZeroElse(flat, range.L1 + hn::IfThenElseZero(use_quadratic, hn::Abs(p.gradient.z)));
  const V size = hn::Abs(value) + r * steepness + r * r * model.curvature * per_k;
  const V displaced = set<Number>(query.displacement) * p.steepest;
  const V rounded = set<Number>(query.integral_rounding) * size;
  const V of_tangent = tangent_delta + displaced;
  const V of_flat = flat_delta + displaced;
  model.delta = per_k * (select(p.delta, of_tangent, of_flat) + rounded);
  model.mean_delta = per_k * (select(p.mean_delta, of_tangent, of_flat) + rounded);
  // Which parts are wet: the test of the surface decides for the quadratic model, the model's own sign for
  // the others.
  model.whole =
      hn::Or(hn::And(hn::Not(flat), surface.wet), hn::And(flat, hn::Or(hn::Lt(highest, zero), submerged)));
  model.wet = hn::And(model.whole, surface.wet);
  const V of_certificate = one / hn::Max(one - p.gamma - set<Number>(query.rounding()), set<Number>(1e-30));
  model.certificate_factor =
      hn::IfThenZeroElse(model.wet, hn::IfThenElse(use_quadratic, of_certificate, one));
  model.dry = hn::Or(hn::Gt(range.low, zero),
                     hn::And(flat, hn::And(hn::Gt(zeta - r, amplitude), hn::Not(submerged))));
  model.too_steep = p.too_steep;
}

template <typename Number>
HWY_INLINE PatchModel<Number> model_of(const PatchQuery<Number>& query, const PatchField<Number>& field) {
  PatchModel<Number> model;
  const PatchSurface<Number> surface = surface_of<Number>(query, field);
  set_height_model<Number>(query, field, surface.range, model);
  const PressureExpansion<Number> pressure = query.hydrostatic
                                                 ? hydrostatic_pressure<Number>(query, field, surface)
                                                 : stretched_pressure<Number>(query, field, surface);
  choose_model<Number>(query, field, surface, pressure, model);
  return model;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_MODELS_INL_H
