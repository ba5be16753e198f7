// Where patches are in the sea: their places, the height over the surface on them and the bounds on its
// derivatives, with SIMD (docs/wave_mathematics.md, "Local bounds" and "Dry, wet, crossing"). Included once
// per instruction set.
//
// Positions and elevations are in units of 1 / k_max here, so that slopes and all derivatives are pure
// numbers.
#if defined(BUOYANCY_WAVE_PLACES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_PLACES_INL_H
#undef BUOYANCY_WAVE_PLACES_INL_H
#else
#define BUOYANCY_WAVE_PLACES_INL_H
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
  double amplitude = 0.0;          // sum of a k_max
  double slope = 0.0;              // sum of a k
  double unit_roundoff = 0.0;      // of Number
  double integral_rounding = 0.0;  // of a patch's integrals, relative
  double displacement = 0.0;       // of the surface, times k_max

  double rounding() const { return kRoundingFactor * unit_roundoff; }  // of an expansion
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
  patch.k_max = query.expansion->k_max;
  patch.zeta = query.zeta;
  patch.per_depth = query.deep_water() ? 0.0 : 1.0 / (patch.k_max * query.depth);
  constexpr double kLowest = 0.25 * std::numeric_limits<Number>::max();
  patch.bed = -std::min(patch.k_max * query.depth, kLowest);
  patch.hydrostatic = query.hydrostatic;
  patch.submerged = query.submerged;
  const double factor = query.sea->amplitude_factor();
  patch.amplitude = factor * query.expansion->amplitude_sums[0] * patch.k_max;
  patch.slope = factor * query.expansion->amplitude_sums[1];
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

// r: radius over 1 / k_max.
template <typename Number>
HWY_INLINE SurfaceRange<Number> range_of(const VectorOf<Number>& zeta, const VectorOf<Number>& r,
                                         const SurfaceValues<Number>& surface,
                                         const CellBounds<Number>& bounds, const VectorOf<Number>& reach,
                                         const VectorOf<Number>& rounding) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V half = set<Number>(0.5);
  SurfaceRange<Number> range;
  range.s = zeta - surface.eta;
  range.above = bounds_at<Number>(bounds, reach + r);
  const V mean = half * (surface.eta_11 + surface.eta_22);
  const V difference = half * (surface.eta_11 - surface.eta_22);
  const V deviator = hn::Sqrt(hn::MulAdd(difference, difference, surface.eta_12 * surface.eta_12));
  range.L3 = third_within<Number>(surface.third, range.above, r, rounding);
  range.L4 = range.above.fourth;
  range.third_rest = hn::MulAdd(rounding, range.above.third, third_rest_at<Number>(bounds, reach));
  range.L2_at_point = hn::Abs(mean) + deviator;
  range.L2 = hn::MulAdd(r, range.L3, range.L2_at_point);
  const V slope_squared = hn::MulAdd(surface.eta_1, surface.eta_1, surface.eta_2 * surface.eta_2);
  range.L1 = hn::MulAdd(r, range.L2, hn::Sqrt(slope_squared));
  range.rounded = rounding * range.above.sum;
  range.epsilon = hn::MulAdd(rounding, hn::Abs(zeta), range.rounded + range.above.truncation);
  const V r_squared_half = half * r * r;
  const V variation = hn::MulAdd(r, hn::Sqrt(set<Number>(1.0) + slope_squared),
                                 r_squared_half * r * range.L3 * set<Number>(1.0 / 3.0));
  // -D^2 eta has the eigenvalues -mean -+ deviator.
  range.low = range.s - variation + r_squared_half * hn::Min(zero, hn::Neg(mean) - deviator) - range.epsilon;
  range.high = range.s + variation + r_squared_half * hn::Max(zero, deviator - mean) + range.epsilon;
  return range;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_PLACES_INL_H
