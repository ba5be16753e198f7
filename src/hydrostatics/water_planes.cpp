#include "hydrostatics/water_planes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

// As in wetted_tree_sum.cpp.
#define HWY_BROKEN_EMU128 1

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/water_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BUOYANCY_WATER_PLANES_LANES
#define BUOYANCY_WATER_PLANES_LANES
namespace buoyancy {

constexpr std::size_t kLanes = 8;
using Lanes = std::array<double, kLanes>;

// The poses and the results of up to eight bodies, a body per lane.
struct PlaneLanes {
  alignas(64) std::array<Lanes, 4> q;  // w, x, y, z, scaled by a power of two
  std::array<Lanes, 3> p, c;           // [m]
  std::array<Lanes, 3> up, up_rest;
  Lanes h, h_rest;  // [m]
};

}  // namespace buoyancy
#endif

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The operations of double_double.h, one by one, on the lanes of a vector. Fused operations would be quicker
// and give other bits where a product underflows.
using Tag = hn::CappedTag<double, kLanes>;
using Vector = hn::Vec<Tag>;

struct DoubleDoubles {
  Vector hi, lo;
};

HWY_INLINE DoubleDoubles two_sum(Vector a, Vector b) {
  const Vector sum = hn::Add(a, b);
  const Vector b_part = hn::Sub(sum, a);
  return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part))};
}

HWY_INLINE DoubleDoubles quick_two_sum(Vector a, Vector b) {
  const Vector sum = hn::Add(a, b);
  return {sum, hn::Sub(b, hn::Sub(sum, a))};
}

HWY_INLINE DoubleDoubles two_product(Vector a, Vector b) {
  const Vector split = hn::Set(Tag(), 134217729.0);  // 2^27 + 1
  const Vector product = hn::Mul(a, b);
  const Vector a_scaled = hn::Mul(split, a);
  const Vector a_hi = hn::Sub(a_scaled, hn::Sub(a_scaled, a));
  const Vector a_lo = hn::Sub(a, a_hi);
  const Vector b_scaled = hn::Mul(split, b);
  const Vector b_hi = hn::Sub(b_scaled, hn::Sub(b_scaled, b));
  const Vector b_lo = hn::Sub(b, b_hi);
  Vector rest = hn::Sub(hn::Mul(a_hi, b_hi), product);
  rest = hn::Add(hn::Add(rest, hn::Mul(a_hi, b_lo)), hn::Mul(a_lo, b_hi));
  return {product, hn::Add(rest, hn::Mul(a_lo, b_lo))};
}

HWY_INLINE DoubleDoubles add(DoubleDoubles a, DoubleDoubles b) {
  const DoubleDoubles hi = two_sum(a.hi, b.hi);
  const DoubleDoubles lo = two_sum(a.lo, b.lo);
  const DoubleDoubles middle = quick_two_sum(hi.hi, hn::Add(hi.lo, lo.hi));
  return quick_two_sum(middle.hi, hn::Add(middle.lo, lo.lo));
}

HWY_INLINE DoubleDoubles negated(DoubleDoubles a) {
  return {hn::Neg(a.hi), hn::Neg(a.lo)};
}

HWY_INLINE DoubleDoubles subtract(DoubleDoubles a, DoubleDoubles b) {
  return add(a, negated(b));
}

HWY_INLINE DoubleDoubles multiply(DoubleDoubles a, Vector b) {
  const DoubleDoubles product = two_product(a.hi, b);
  return quick_two_sum(product.hi, hn::Add(product.lo, hn::Mul(a.lo, b)));
}

HWY_INLINE DoubleDoubles multiply(DoubleDoubles a, DoubleDoubles b) {
  const DoubleDoubles product = two_product(a.hi, b.hi);
  const Vector cross = hn::Add(hn::Mul(a.hi, b.lo), hn::Mul(a.lo, b.hi));
  return quick_two_sum(product.hi, hn::Add(product.lo, cross));
}

HWY_INLINE DoubleDoubles reciprocal(DoubleDoubles a) {
  const Vector one = hn::Set(Tag(), 1.0);
  const Vector first = hn::Div(one, a.hi);
  const DoubleDoubles product = two_product(a.hi, first);
  const Vector rest = hn::Sub(hn::Sub(hn::Sub(one, product.hi), product.lo), hn::Mul(a.lo, first));
  return quick_two_sum(first, hn::Mul(rest, first));
}

HWY_INLINE DoubleDoubles sum(DoubleDoubles a, DoubleDoubles b, DoubleDoubles c) {
  const DoubleDoubles two = two_sum(a.hi, b.hi);
  const DoubleDoubles three = two_sum(two.hi, c.hi);
  const Vector low = hn::Add(hn::Add(a.lo, b.lo), c.lo);
  return quick_two_sum(three.hi, hn::Add(hn::Add(two.lo, three.lo), low));
}

HWY_INLINE DoubleDoubles dot(const Vector a[3], const Vector b[3]) {
  return sum(two_product(a[0], b[0]), two_product(a[1], b[1]), two_product(a[2], b[2]));
}

// rotate_into_body() and water_plane_in_body() of water_plane.cpp, for the lanes from `lane` on.
HWY_INLINE void compute_planes_from(const Water& water, std::size_t lane, PlaneLanes& lanes) {
  const Tag d;
  const Vector two = hn::Set(d, 2.0);
  const Vector w = hn::Load(d, &lanes.q[0][lane]);
  Vector u[3];
  Vector p[3];
  Vector up[3];
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = hn::Load(d, &lanes.q[i + 1][lane]);
    p[i] = hn::Load(d, &lanes.p[i][lane]);
    up[i] = hn::Set(d, water.up_W[static_cast<Eigen::Index>(i)]);
  }
  const DoubleDoubles w_squared = two_product(w, w);
  const DoubleDoubles u_squared = dot(u, u);
  const DoubleDoubles per_norm_squared = reciprocal(add(w_squared, u_squared));
  const DoubleDoubles along = subtract(w_squared, u_squared);
  const DoubleDoubles u_dot_up = dot(u, up);

  DoubleDoubles k[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t l = (i + 2) % 3;
    const DoubleDoubles cross = subtract(two_product(u[j], up[l]), two_product(u[l], up[j]));
    const DoubleDoubles twice =
        subtract(multiply(u_dot_up, hn::Mul(two, u[i])), multiply(cross, hn::Mul(two, w)));
    k[i] = multiply(add(multiply(along, up[i]), twice), per_norm_squared);
    hn::Store(k[i].hi, d, &lanes.up[i][lane]);
    hn::Store(k[i].lo, d, &lanes.up_rest[i][lane]);
  }
  DoubleDoubles k_times_c[3];
  for (std::size_t i = 0; i < 3; ++i) k_times_c[i] = multiply(k[i], hn::Load(d, &lanes.c[i][lane]));
  const DoubleDoubles k_dot_c = sum(k_times_c[0], k_times_c[1], k_times_c[2]);
  const DoubleDoubles level{hn::Set(d, water.level), hn::Zero(d)};
  const DoubleDoubles h = sum(level, negated(dot(up, p)), negated(k_dot_c));
  hn::Store(h.hi, d, &lanes.h[lane]);
  hn::Store(h.lo, d, &lanes.h_rest[lane]);
}

void compute_planes(const Water& water, std::size_t count, PlaneLanes& lanes) {
  for (std::size_t lane = 0; lane < count; lane += hn::Lanes(Tag())) compute_planes_from(water, lane, lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {
namespace {

HWY_EXPORT(compute_planes);

constexpr std::size_t kMinBodies = 3;  // fewer are quicker one by one

// The power of two that brings the largest component near 1, as in water_plane.cpp; 0 if it is not a normal
// number.
double scale_of(const Eigen::Quaterniond& q) {
  constexpr unsigned kMantissaBits = 52;
  constexpr std::uint64_t kMaxExponent = 2044;  // that of the largest number with a normal inverse
  const std::uint64_t exponent =
      std::bit_cast<std::uint64_t>(q.coeffs().cwiseAbs().maxCoeff()) >> kMantissaBits;
  if (exponent == 0 || exponent > kMaxExponent) return 0.0;
  return std::bit_cast<double>((kMaxExponent + 1 - exponent) << kMantissaBits);
}

void load(std::size_t lane, const Pose& pose, double scale, const Vec3& c_B, PlaneLanes& lanes) {
  const Eigen::Quaterniond& q = pose.q_WB;
  lanes.q[0][lane] = scale * q.w();
  lanes.q[1][lane] = scale * q.x();
  lanes.q[2][lane] = scale * q.y();
  lanes.q[3][lane] = scale * q.z();
  for (std::size_t i = 0; i < 3; ++i) {
    lanes.p[i][lane] = pose.p_WB[static_cast<Eigen::Index>(i)];
    lanes.c[i][lane] = c_B[static_cast<Eigen::Index>(i)];
  }
}

WaterPlane plane_of(std::size_t lane, const PlaneLanes& lanes) {
  const auto vector = [lane](const std::array<Lanes, 3>& v) {
    return Vec3(v[0][lane], v[1][lane], v[2][lane]);
  };
  WaterPlane plane;
  plane.up_B = vector(lanes.up);
  plane.h_c = lanes.h[lane];
  plane.up_B_rest = vector(lanes.up_rest);
  plane.h_c_rest = lanes.h_rest[lane];
  return plane;
}

}  // namespace

void water_planes_in_body(std::span<const Pose> poses, const Water& water, std::span<const Vec3> centers_B,
                          std::span<WaterPlane> planes) {
  assert(poses.size() == centers_B.size() && poses.size() == planes.size());
  PlaneLanes lanes;
  std::array<bool, kLanes> by_lanes{};
  for (std::size_t first = 0; first < poses.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, poses.size() - first);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = first + std::min(lane, count - 1);  // the last body fills the lanes after it
      const double scale = scale_of(poses[i].q_WB);
      by_lanes[lane] = count >= kMinBodies && scale > 0.0;
      if (count >= kMinBodies) load(lane, poses[i], scale, centers_B[i], lanes);
    }
    if (count >= kMinBodies) HWY_DYNAMIC_DISPATCH(compute_planes)(water, count, lanes);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::size_t i = first + lane;
      planes[i] = by_lanes[lane] ? plane_of(lane, lanes) : water_plane_in_body(poses[i], water, centers_B[i]);
    }
  }
}

}  // namespace buoyancy
#endif  // HWY_ONCE
