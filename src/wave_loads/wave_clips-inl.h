// Patches that the surface of the water crosses, once they are refined without the sea, with SIMD
// (docs/wave_mathematics.md, "What a patch contributes", "Inherited models"): the integrals over triangles
// that the surface clips, the models that were kept of such patches, children that inherit one, and leaves
// that are clipped with one. Included once per instruction set.
#if defined(BUOYANCY_WAVE_CLIPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_CLIPS_INL_H
#undef BUOYANCY_WAVE_CLIPS_INL_H
#else
#define BUOYANCY_WAVE_CLIPS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "wave_loads/patch_tree.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_load_sum-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Triangles relative to their patch's centroid, and what is integrated over them.
template <typename Number>
struct TriangleLanes {
  std::array<Vectors3<Number>, 3> corners;
  Quadratic<Number> phi, s;
  VectorOf<Number> curvature;
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

// Of a quadratic function over a triangle.
template <typename Number>
struct TriangleMeans {
  VectorOf<Number> mean;
  VectorOf<Number> at_mid;     // the value at the triangle's centroid
  VectorOf<Number> curvature;  // the contraction of the Hessian with the triangle's second moments
  Vectors3<Number> offset;     // mean of the function times y; of its linear part about the centroid alone
  Vectors3<Number> gradient;   // at the centroid
};

// mid: the triangle's centroid. c: the mean of (y - mid) (y - mid)^T.
template <typename Number>
HWY_INLINE TriangleMeans<Number> means_of(const Quadratic<Number>& q, const Vectors3<Number>& mid,
                                          const Symmetric<Number>& c) {
  TriangleMeans<Number> m;
  m.gradient = q.gradient + product<Number>(q.hessian, mid);
  m.at_mid = value_at<Number>(q, mid);
  const Symmetric<Number>& h = q.hessian;
  m.curvature = hn::MulAdd(h[0], c[0], hn::MulAdd(h[1], c[1], h[2] * c[2])) +
                set<Number>(2.0) * hn::MulAdd(h[3], c[3], hn::MulAdd(h[4], c[4], h[5] * c[5]));
  m.mean = hn::MulAdd(set<Number>(0.5), m.curvature, m.at_mid);
  m.offset = scaled<Number>(m.mean, mid) + product<Number>(c, m.gradient);
  return m;
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
  const Vectors3<Number> area = scaled<Number>(weight, area_vector);
  const TriangleMeans<Number> phi = means_of<Number>(t.phi, mid, c);
  sum.force = sum.force + scaled<Number>(phi.mean, area);
  sum.offset_torque = sum.offset_torque + cross<Number>(phi.offset, area);
  const TriangleMeans<Number> s = means_of<Number>(t.s, mid, c);
  const V vertical = dot<Number>(up, area);
  sum.volume = hn::MulAdd(vertical, s.mean, sum.volume);
  // The mean of s^2 to second order.
  const V half_square = half * hn::MulAdd(s.at_mid, s.at_mid + s.curvature,
                                          dot<Number>(s.gradient, product<Number>(c, s.gradient)));
  sum.moment = sum.moment + scaled<Number>(vertical, s.offset - scaled<Number>(half_square, up));
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
  const V of_whole = hn::IfThenElseZero(hn::Or(lone.all_positive, lone.lone_negative), one);
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
  const auto clipped = hn::Or(lone.lone_positive, lone.lone_negative);
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
  sum.strip = strip * hn::Sqrt(dot<Number>(area, area));
  return sum;
}

// Integrals of triangles as those of patches; what the model leaves out is not part of the errors. lever:
// centroid from the reference point. radius, certificate_factor: of the patch.
template <typename Number>
HWY_INLINE PatchIntegrals<Number> to_patch(const TriangleIntegrals<Number>& sums,
                                           const Vectors3<Number>& lever, const Vectors3<Number>& center,
                                           const VectorOf<Number>& radius,
                                           const VectorOf<Number>& certificate_factor) {
  PatchIntegrals<Number> result;
  result.force = {hn::Neg(sums.force.x), hn::Neg(sums.force.y), hn::Neg(sums.force.z)};
  result.torque = cross<Number>(lever, result.force) - sums.offset_torque;
  result.volume = sums.volume;
  result.moment = scaled<Number>(sums.volume, center) + sums.moment;
  result.force_error = sums.strip;
  result.expected = sums.strip;
  result.torque_error = hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)) + radius, sums.strip, sums.cubic);
  result.volume_error = certificate_factor * sums.strip;
  return result;
}

// Where a kept model is.
struct CachedModel {
  std::uint32_t models = kNone;
  std::uint32_t lane = 0;

  bool operator==(const CachedModel&) const = default;
};

// Kept models in lanes, in rows.
template <typename Number>
struct CachedModelLanes {
  using V = VectorOf<Number>;

  // The places of the rows. A quadratic function has ten: value, gradient and Hessian; a vector three.
  enum Row : std::size_t {
    kPhi = 0,  // phi, s: about the patch's centroid
    kS = kPhi + 10,
    kCurvature = kS + 10,
    kRadius,
    kLever,
    kCenter = kLever + 3,
    // What neither clipping nor an inherited model changes of the bounds of the force, the torque and the
    // volume.
    kForceRemainder = kCenter + 3,
    kTorqueRemainder,
    kVolumeRemainder,
    kCertificateFactor,
    kRowsForClips,
    // What only inherited models need.
    kThird = kRowsForClips,
    kDelta,
    kSThird,
    kSDelta,
    kSCurvature,
    kOrigin,  // the point about which the Taylor polynomials were made
    kRows = kOrigin + 3
  };

  std::array<V, kRows> rows;

  HWY_INLINE Quadratic<Number> phi() const { return quadratic(kPhi); }
  HWY_INLINE Quadratic<Number> s() const { return quadratic(kS); }
  HWY_INLINE const V& curvature() const { return rows[kCurvature]; }
  HWY_INLINE const V& radius() const { return rows[kRadius]; }
  HWY_INLINE Vectors3<Number> lever() const { return vector(kLever); }
  HWY_INLINE Vectors3<Number> center() const { return vector(kCenter); }
  HWY_INLINE const V& certificate_factor() const { return rows[kCertificateFactor]; }
  HWY_INLINE const V& third() const { return rows[kThird]; }
  HWY_INLINE const V& delta() const { return rows[kDelta]; }
  HWY_INLINE const V& s_third() const { return rows[kSThird]; }
  HWY_INLINE const V& s_delta() const { return rows[kSDelta]; }
  HWY_INLINE const V& s_curvature() const { return rows[kSCurvature]; }
  HWY_INLINE Vectors3<Number> origin() const { return vector(kOrigin); }

 private:
  HWY_INLINE Vectors3<Number> vector(std::size_t row) const {
    return {rows[row], rows[row + 1], rows[row + 2]};
  }
  HWY_INLINE Quadratic<Number> quadratic(std::size_t row) const {
    return {rows[row],
            vector(row + 1),
            {rows[row + 4], rows[row + 5], rows[row + 6], rows[row + 7], rows[row + 8], rows[row + 9]}};
  }
};

template <typename Number>
class ModelCache {
 public:
  using V = VectorOf<Number>;
  using Lanes = CachedModelLanes<Number>;
  using Row = typename Lanes::Row;

  void clear() { count_ = 0; }

  // Keeps the models of a batch of groups if the surface may cross a patch of theirs. origin: as in
  // CachedModelLanes.
  HWY_INLINE CachedOfBatch keep_crossing(const QueryPatches& patches, const GroupsOfVector<Number>& groups,
                                         const hn::Mask<LanesOf<Number>>& crossing,
                                         const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                         const PatchModel<Number>& model, const Vectors3<Number>& origin) {
    CachedOfBatch kept;
    kept.lanes = bits_of<Number>(crossing);
    if (kept.lanes == 0) return kept;
    kept.leaves = kept.lanes & leaves<Number>(patches, groups);
    kept.models = keep(query, moments, model, origin);
    return kept;
  }

  // One number of a model.
  Number number(const CachedModel& at, Row row) const { return models_[at.models].rows[row][at.lane]; }

  // The model at(n) in all lanes of the n-th group, its first kCount rows. of_one: at(n) is the same for all
  // n.
  template <std::size_t kCount, typename At>
  HWY_INLINE CachedModelLanes<Number> lanes(bool of_one, const At& at) const {
    CachedModelLanes<Number> kept;
    for (std::size_t row = 0; row < kCount; ++row) {
      const auto place = [&](std::size_t n) { return &models_[at(n).models].rows[row][at(n).lane]; };
      kept.rows[row] = of_one ? hn::Set(LanesOf<Number>(), *place(0)) : spread_groups<Number>(place);
    }
    return kept;
  }

 private:
  struct Models {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, Lanes::kRows> rows;
  };

  // Keeps the models of a batch and returns their number.
  HWY_INLINE std::uint32_t keep(const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                const PatchModel<Number>& model, const Vectors3<Number>& origin) {
    const Vectors3<Number> lever = moments.center - axis_of<Number>(query.reference);
    const V sixth = set<Number>(1.0 / 6.0);
    const V mu1 = hn::Sqrt(moments.area * moments.mu2);
    const V remainder = hn::MulAdd(model.third * moments.mu3, sixth, model.mean_delta * moments.area);
    const V local = hn::MulAdd(model.delta, mu1, sixth * model.third * moments.mu3 * moments.radius);
    const V of_volume = volume_remainder<Number>(moments.area, distance_moments<Number>(moments), model);
    if (count_ == models_.size()) models_.emplace_back();
    auto& rows = models_[count_].rows;
    const auto put = [&](std::size_t row, const auto&... numbers)
                         HWY_ATTR { (hn::Store(numbers, LanesOf<Number>(), rows[row++].data()), ...); };
    const auto put_vector = [&](std::size_t row, const Vectors3<Number>& v)
                                HWY_ATTR { put(row, v.x, v.y, v.z); };
    const auto put_quadratic = [&](std::size_t row, const Quadratic<Number>& q) HWY_ATTR {
      put(row, q.value, q.gradient.x, q.gradient.y, q.gradient.z, q.hessian[0], q.hessian[1], q.hessian[2],
          q.hessian[3], q.hessian[4], q.hessian[5]);
    };
    put_quadratic(Lanes::kPhi, model.phi);
    put_quadratic(Lanes::kS, model.s);
    put(Lanes::kCurvature, model.curvature);
    put(Lanes::kRadius, moments.radius);
    put_vector(Lanes::kLever, lever);
    put_vector(Lanes::kCenter, moments.center);
    put(Lanes::kForceRemainder, remainder);
    put(Lanes::kTorqueRemainder, hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)), remainder, local));
    put(Lanes::kVolumeRemainder, hn::MulAdd(model.certificate_factor, remainder, of_volume));
    put(Lanes::kCertificateFactor, model.certificate_factor);
    put(Lanes::kThird, model.third);
    put(Lanes::kDelta, model.delta);
    put(Lanes::kSThird, model.s_third);
    put(Lanes::kSDelta, model.s_delta);
    put(Lanes::kSCurvature, model.s_curvature);
    put_vector(Lanes::kOrigin, origin);
    return static_cast<std::uint32_t>(count_++);
  }

  // Kept from query to query, so that no models are set to zero before they are written.
  std::vector<Models> models_;
  std::size_t count_ = 0;
};

// The quadratic function about another point, at y from its own.
template <typename Number>
HWY_INLINE Quadratic<Number> moved(const Quadratic<Number>& q, const Vectors3<Number>& y) {
  const Vectors3<Number> change = product<Number>(q.hessian, y);
  Quadratic<Number> result;
  result.value = q.value + dot<Number>(q.gradient, y) + set<Number>(0.5) * dot<Number>(change, y);
  result.gradient = q.gradient + change;
  result.hessian = q.hessian;
  return result;
}

// A bound on what the rounding of moved() adds to the function's value over the patch.
template <typename Number>
HWY_INLINE VectorOf<Number> rounding_of_move(const PatchQuery<Number>& query, const Quadratic<Number>& q,
                                             const VectorOf<Number>& distance, const VectorOf<Number>& radius,
                                             const VectorOf<Number>& curvature) {
  const VectorOf<Number> slope = hn::Sqrt(dot<Number>(q.gradient, q.gradient));
  const VectorOf<Number> reach = distance + radius;
  return set<Number>(query.integral_rounding) *
         hn::MulAdd(hn::MulAdd(curvature, reach, slope), reach, hn::Abs(q.value));
}

// The moments of a patch, and its model made from one that was kept.
template <typename Number>
struct Inherited {
  PatchMoments<Number> moments;  // mu3: a bound on the integral of |x - origin|^3
  PatchModel<Number> model;
};

template <typename Number>
HWY_INLINE Inherited<Number> inherit(const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                     const CachedModelLanes<Number>& kept) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V half = set<Number>(0.5);
  const V& r = moments.radius;
  const Vectors3<Number> y = moments.center - kept.center();
  const Vectors3<Number> of_origin = moments.center - kept.origin();
  const V from_kept = hn::Sqrt(dot<Number>(y, y));
  const V squared = dot<Number>(of_origin, of_origin);
  const V reach = hn::Sqrt(squared) + r;

  Inherited<Number> result;
  result.moments = moments;
  // The displacement is more than that of a centroid on the grid.
  const V off_centroid = set<Number>(2.0 * query.displacement / query.k_max) * hn::Sqrt(squared);
  result.moments.mu3 =
      set<Number>(1.00001) * reach * hn::MulAdd(squared + off_centroid, moments.area, moments.mu2);

  PatchModel<Number>& model = result.model;
  model.phi = moved<Number>(kept.phi(), y);
  model.s = moved<Number>(kept.s(), y);
  model.third = kept.third();
  model.cubic = {zero, zero, zero};
  model.third_of_children = set<Number>(8.0) * kept.third();  // parts inherit it
  model.curvature = kept.curvature();
  model.delta = kept.delta() + rounding_of_move<Number>(query, kept.phi(), from_kept, r, kept.curvature());
  model.mean_delta = model.delta;
  model.delta_of_children = model.delta;
  model.s_third = kept.s_third();
  model.s_cubic = {zero, zero, zero};
  model.s_curvature = kept.s_curvature();
  model.s_delta =
      kept.s_delta() + rounding_of_move<Number>(query, kept.s(), from_kept, r, kept.s_curvature());

  const V variation =
      r * hn::MulAdd(half * kept.s_curvature(), r,
                     hn::Sqrt(dot<Number>(model.s.gradient, model.s.gradient))) +
      hn::MulAdd(kept.s_third() * set<Number>(1.0 / 6.0), reach * reach * reach, model.s_delta);
  model.dry = hn::Gt(model.s.value - variation, zero);
  model.whole = hn::Lt(model.s.value + variation, zero);
  model.wet = set_mask<Number>(false);  // what it selects is of no use here
  model.certificate_factor = hn::IfThenZeroElse(model.whole, kept.certificate_factor());
  model.too_steep = set_mask<Number>(false);
  return result;
}

// Patches of a round that inherit their models.
template <typename Number>
class InheritingPatches {
 public:
  using Lanes = CachedModelLanes<Number>;

  // cache: the models; must outlive the query.
  void start(ModelCache<Number>& cache) {
    cache_ = &cache;
    tasks_.clear();
  }

  std::size_t count() const { return tasks_.size(); }

  // Adds a block of patches that the patch of the model holds.
  void add_block(const QueryPatches& patches, std::uint32_t block, const CachedModel& model) {
    prefetch_places(patches.block(block));
    prefetch_moments(patches.block(block));
    for_each_group<Number>(patches.block(block), [&](std::uint32_t first) {
      tasks_.push_back({block, first, model});
    });
  }

  // Evaluates what was added and appends the results. Returns the number of patches that are not dry.
  std::size_t finish(const QueryPatches& patches, const PatchQuery<Number>& query, LoadSum<Number>& sum) {
    std::size_t wet = 0;
    for (std::size_t n = 0; n < tasks_.size(); n += kGroupsPerVector<Number>) {
      wet += evaluate(patches, query, &tasks_[n], std::min(kGroupsPerVector<Number>, tasks_.size() - n), sum);
    }
    tasks_.clear();
    return wet;
  }

 private:
  // kGroup patches of a block.
  struct Task {
    std::uint32_t block, first;
    CachedModel model;
  };

  HWY_NOINLINE std::size_t evaluate(const QueryPatches& patches, const PatchQuery<Number>& query,
                                    const Task* tasks, std::size_t count, LoadSum<Number>& sum) {
    GroupsOfVector<Number> groups;
    bool of_one = true;
    for (std::size_t n = 0; n < groups.size(); ++n) {
      const Task& task = tasks[n < count ? n : 0];
      groups[n].block = task.block;
      groups[n].first = task.first;
      of_one &= task.model == tasks[0].model;
    }
    const Lanes kept = cache_->template lanes<Lanes::kRows>(
        of_one, [&](std::size_t n) -> const CachedModel& { return tasks[n < count ? n : 0].model; });
    const Inherited<Number> inherited = inherit<Number>(query, read_moments<Number>(patches, groups), kept);
    const auto counts =
        hn::AndNot(inherited.model.dry, hn::FirstN(LanesOf<Number>(), count * kGroup<Number>));
    PatchIntegrals<Number> integrals = integrate<Number>(query, inherited.moments, inherited.model);
    clear_where<Number>(hn::Not(counts), integrals);
    sum.add(groups, integrals,
            cache_->keep_crossing(patches, groups, hn::AndNot(inherited.model.whole, counts), query,
                                  inherited.moments, inherited.model, kept.origin()));
    return hn::CountTrue(LanesOf<Number>(), counts);
  }

  ModelCache<Number>* cache_ = nullptr;
  std::vector<Task> tasks_;
};

// Leaves of the tree that the surface of the water crosses, clipped with the models that were kept of them.
// Triangles of all leaves of a round are clipped together.
template <typename Number>
class ClippedLeaves {
 public:
  using V = VectorOf<Number>;
  using Lanes = CachedModelLanes<Number>;

  // cache: the models to clip with; must outlive the query.
  void start(const ModelCache<Number>& cache) {
    cache_ = &cache;
    leaves_.clear();
    tasks_.clear();
  }

  // Notes a leaf that is to be clipped, which has been removed from the results.
  void add(const QueryPatches& patches, const PatchBlock& block, std::size_t place, const CachedModel& model,
           std::size_t result) {
    for (std::uint32_t b = 0; b < block.triangle_blocks[place]; ++b) {
      for (std::uint32_t first = 0; first < kSiblings; first += kGroup<Number>) {
        tasks_.push_back({block.child[place] + b, first, model, result});
      }
      // They are read after the other patches of the round have been evaluated.
      const TriangleBlock& triangles = patches.triangles(block.child[place] + b);
      for (std::size_t row = 0; row < triangles.corners.size(); row += 4) {
        hwy::Prefetch(triangles.corners[row].data());
      }
    }
    leaves_.push_back({model, result});
  }

  // Clips what was noted and puts it in the place of the results.
  void finish(const QueryPatches& patches, const PatchQuery<Number>& query, LoadSum<Number>& sum) {
    for (const Leaf& leaf : leaves_) {
      sum.add_errors(leaf.result, cache_->number(leaf.model, Lanes::kForceRemainder),
                     cache_->number(leaf.model, Lanes::kTorqueRemainder),
                     cache_->number(leaf.model, Lanes::kVolumeRemainder));
    }
    for (std::size_t n = 0; n < tasks_.size(); n += kGroupsPerVector<Number>) {
      const std::size_t count = std::min(kGroupsPerVector<Number>, tasks_.size() - n);
      clip(patches, query, &tasks_[n], count, sum);
    }
    for (const Leaf& leaf : leaves_) sum.finish(leaf.result);
    leaves_.clear();
    tasks_.clear();
  }

 private:
  struct Leaf {
    CachedModel model;
    std::size_t result;
  };
  // kGroup triangles of a leaf.
  struct Task {
    std::uint32_t triangle_block;
    std::uint32_t first;  // lane of the block
    CachedModel model;
    std::size_t result;
  };

  HWY_NOINLINE void clip(const QueryPatches& patches, const PatchQuery<Number>& query, const Task* tasks,
                         std::size_t count, LoadSum<Number>& sum) const {
    const auto task = [&](std::size_t n) -> const Task& { return tasks[n < count ? n : 0]; };
    const auto corner = [&](std::size_t row) HWY_ATTR {
      return gather_groups<Number>([&](std::size_t n) {
        return patches.triangles(task(n).triangle_block).corners[row].data() + task(n).first;
      });
    };
    // Most often all triangles are of one leaf.
    bool of_one = true;
    for (std::size_t n = 1; n < count; ++n) of_one &= tasks[n].result == tasks[0].result;
    const Lanes kept = cache_->template lanes<Lanes::kRowsForClips>(
        of_one, [&](std::size_t n) -> const CachedModel& { return task(n).model; });
    TriangleLanes<Number> t;
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) t.corners[i] = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
    t.phi = kept.phi();
    t.s = kept.s();
    t.curvature = kept.curvature();
    const PatchIntegrals<Number> integrals = to_patch<Number>(
        integrate<Number>(query, t), kept.lever(), kept.center(), kept.radius(), kept.certificate_factor());
    add_sums(integrals, tasks, count, sum);
  }

  // Adds the sums over the lanes of each group to the group's result.
  static HWY_INLINE void add_sums(const PatchIntegrals<Number>& integrals, const Task* tasks,
                                  std::size_t count, LoadSum<Number>& sum) {
    constexpr std::size_t kRows = LoadSum<Number>::kRows;
    const std::array<V, kRows> rows = LoadSum<Number>::rows_of(integrals);
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> numbers;
    for (std::size_t row = 0; row < kRows; ++row) {
      hn::Store(sums_of_groups<Number>(rows[row]), LanesOf<Number>(), numbers[row].data());
    }
    for (std::size_t n = 0; n < count; ++n) {
      sum.add_to(tasks[n].result, &numbers[0][n * kGroup<Number>], kLanes<Number>);
    }
  }

  const ModelCache<Number>* cache_ = nullptr;
  std::vector<Leaf> leaves_;
  std::vector<Task> tasks_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_CLIPS_INL_H
