// The integrals of a model of the pressure over triangles that the surface clips, with SIMD
// (docs/wave_mathematics.md, "What a patch contributes"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_TRIANGLES_INL_H
#undef BUOYANCY_WAVE_TRIANGLES_INL_H
#else
#define BUOYANCY_WAVE_TRIANGLES_INL_H
#endif

#include <array>
#include <cstddef>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_models-inl.h"

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

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_TRIANGLES_INL_H
