#include "hydrostatics/water_plane.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

// As in wetted_tree_sum.cpp, the target without SIMD is Highway's scalar one.
#define HWY_BROKEN_EMU128 1

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/water_plane.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"

#ifndef BUOYANCY_WATER_PLANE_LANES
#define BUOYANCY_WATER_PLANE_LANES
namespace buoyancy {

constexpr std::size_t kLanes = 8;
using Lanes = std::array<double, kLanes>;

// The poses and the planes of up to eight bodies, a body per lane.
struct PlaneLanes {
  alignas(64) std::array<Lanes, 4> q;  // w, x, y, z, within_range()
  std::array<Lanes, 3> p, c;           // [m]
  std::array<Lanes, 3> up, up_rest;
  Lanes h, h_rest;  // [m]
};

}  // namespace buoyancy
#endif

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {
namespace hydrostatics {

// The operations of base/double_double.h that base/simd-inl.h does not have.
template <typename V>
HWY_INLINE DoubleDoubles<V> add(DoubleDoubles<V> a, DoubleDoubles<V> b) {
  const DoubleDoubles<V> hi = two_sum(a.hi, b.hi);
  const DoubleDoubles<V> lo = two_sum(a.lo, b.lo);
  const DoubleDoubles<V> middle = quick_two_sum(hi.hi, hn::Add(hi.lo, lo.hi));
  return quick_two_sum(middle.hi, hn::Add(middle.lo, lo.lo));
}

template <typename V>
HWY_INLINE DoubleDoubles<V> negated(DoubleDoubles<V> a) {
  return {hn::Neg(a.hi), hn::Neg(a.lo)};
}

template <typename V>
HWY_INLINE DoubleDoubles<V> subtract(DoubleDoubles<V> a, DoubleDoubles<V> b) {
  return add(a, negated(b));
}

template <typename V>
HWY_INLINE DoubleDoubles<V> multiply(DoubleDoubles<V> a, V b) {
  const DoubleDoubles<V> product = two_product(a.hi, b);
  return quick_two_sum(product.hi, hn::Add(product.lo, hn::Mul(a.lo, b)));
}

template <typename V>
HWY_INLINE DoubleDoubles<V> multiply(DoubleDoubles<V> a, DoubleDoubles<V> b) {
  const DoubleDoubles<V> product = two_product(a.hi, b.hi);
  const V cross = hn::Add(hn::Mul(a.hi, b.lo), hn::Mul(a.lo, b.hi));
  return quick_two_sum(product.hi, hn::Add(product.lo, cross));
}

template <typename V>
HWY_INLINE DoubleDoubles<V> reciprocal(DoubleDoubles<V> a) {
  const V one = all<V>(1.0);
  const V first = hn::Div(one, a.hi);
  const DoubleDoubles<V> product = two_product(a.hi, first);
  const V rest = hn::Sub(hn::Sub(hn::Sub(one, product.hi), product.lo), hn::Mul(a.lo, first));
  return quick_two_sum(first, hn::Mul(rest, first));
}

// Returns the sum of three numbers, with an error relative to the largest: T. Ogita, S. M. Rump and S. Oishi,
// "Accurate sum and dot product", SIAM Journal on Scientific Computing 26 (2005).
template <typename V>
HWY_INLINE DoubleDoubles<V> sum(DoubleDoubles<V> a, DoubleDoubles<V> b, DoubleDoubles<V> c) {
  const DoubleDoubles<V> two = two_sum(a.hi, b.hi);
  const DoubleDoubles<V> three = two_sum(two.hi, c.hi);
  const V low = hn::Add(hn::Add(a.lo, b.lo), c.lo);
  return quick_two_sum(three.hi, hn::Add(hn::Add(two.lo, three.lo), low));
}

template <typename V>
struct Vectors3 {
  V x, y, z;
};

template <typename V>
HWY_INLINE DoubleDoubles<V> dot(const Vectors3<V>& a, const Vectors3<V>& b) {
  return sum(two_product(a.x, b.x), two_product(a.y, b.y), two_product(a.z, b.z));
}

template <typename V>
struct Planes {
  DoubleDoubles<V> k_x, k_y, k_z, h;
};

// k = R_WB^T up = ((w^2 - |u|^2) up + 2 (u . up) u - 2 w (u x up)) / |q|^2 for q = (w, u) of any norm: every
// term holds two components of q, so q and -q give the same bits.
template <typename V>
HWY_INLINE Planes<V> planes_in_body(V w, const Vectors3<V>& u, const Vectors3<V>& p, const Vectors3<V>& c,
                                    const Water& water) {
  const Vectors3<V> up{all<V>(water.up_W.x()), all<V>(water.up_W.y()), all<V>(water.up_W.z())};
  const DoubleDoubles<V> w_squared = two_product(w, w);
  const DoubleDoubles<V> u_squared = dot(u, u);
  const DoubleDoubles<V> per_norm_squared = reciprocal(add(w_squared, u_squared));
  const DoubleDoubles<V> along = subtract(w_squared, u_squared);
  const DoubleDoubles<V> u_dot_up = dot(u, up);
  const V two = all<V>(2.0);
  const V two_w = hn::Mul(two, w);
  const auto component = [&](V u_i, V up_i, V u_j, V up_j, V u_l, V up_l) {
    const DoubleDoubles<V> cross = subtract(two_product(u_j, up_l), two_product(u_l, up_j));
    const DoubleDoubles<V> twice = subtract(multiply(u_dot_up, hn::Mul(two, u_i)), multiply(cross, two_w));
    return multiply(add(multiply(along, up_i), twice), per_norm_squared);
  };
  Planes<V> planes;
  planes.k_x = component(u.x, up.x, u.y, up.y, u.z, up.z);
  planes.k_y = component(u.y, up.y, u.z, up.z, u.x, up.x);
  planes.k_z = component(u.z, up.z, u.x, up.x, u.y, up.y);
  const DoubleDoubles<V> k_dot_c =
      sum(multiply(planes.k_x, c.x), multiply(planes.k_y, c.y), multiply(planes.k_z, c.z));
  const DoubleDoubles<V> level{all<V>(water.level), all<V>(0.0)};
  planes.h = sum(level, negated(dot(up, p)), negated(k_dot_c));
  return planes;
}

void compute_plane(const Eigen::Quaterniond& q, const Vec3& p, const Vec3& c, const Water& water,
                   WaterPlane& plane) {
  using V = hn::Vec<hn::CappedTag<double, 1>>;
  const auto vectors = [](const auto& v) { return Vectors3<V>{all<V>(v.x()), all<V>(v.y()), all<V>(v.z())}; };
  const Planes<V> found = planes_in_body(all<V>(q.w()), vectors(q), vectors(p), vectors(c), water);
  const auto vec3 = [](V x, V y, V z) { return Vec3(hn::GetLane(x), hn::GetLane(y), hn::GetLane(z)); };
  plane.up_B = vec3(found.k_x.hi, found.k_y.hi, found.k_z.hi);
  plane.up_B_rest = vec3(found.k_x.lo, found.k_y.lo, found.k_z.lo);
  plane.h_c = hn::GetLane(found.h.hi);
  plane.h_c_rest = hn::GetLane(found.h.lo);
}

void compute_planes(const Water& water, std::size_t count, PlaneLanes& lanes) {
  const hn::CappedTag<double, kLanes> d;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    const auto vectors = [&](const std::array<Lanes, 3>& v) {
      return Vectors3<V>{hn::Load(d, &v[0][first]), hn::Load(d, &v[1][first]), hn::Load(d, &v[2][first])};
    };
    const Vectors3<V> u{hn::Load(d, &lanes.q[1][first]), hn::Load(d, &lanes.q[2][first]),
                        hn::Load(d, &lanes.q[3][first])};
    const Planes<V> found =
        planes_in_body(hn::Load(d, &lanes.q[0][first]), u, vectors(lanes.p), vectors(lanes.c), water);
    const auto store = [&](const DoubleDoubles<V>& value, Lanes& hi, Lanes& lo) {
      hn::Store(value.hi, d, &hi[first]);
      hn::Store(value.lo, d, &lo[first]);
    };
    store(found.k_x, lanes.up[0], lanes.up_rest[0]);
    store(found.k_y, lanes.up[1], lanes.up_rest[1]);
    store(found.k_z, lanes.up[2], lanes.up_rest[2]);
    store(found.h, lanes.h, lanes.h_rest);
  }
}

}  // namespace hydrostatics

using hydrostatics::compute_plane;
using hydrostatics::compute_planes;

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {
namespace {

HWY_EXPORT(compute_plane);
HWY_EXPORT(compute_planes);

constexpr std::size_t kMinBodies = 3;  // fewer are quicker one by one

// Returns the quaternion, scaled by a power of two such that no significant square of a component over- or
// underflows. Such a scale changes no bit of a rotation.
Eigen::Quaterniond within_range(const Eigen::Quaterniond& q) {
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (largest > 0x1p-100 && largest < 0x1p100) return q;
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [exponent](double value) { return std::ldexp(value, -exponent); };
  return {scaled(q.w()), scaled(q.x()), scaled(q.y()), scaled(q.z())};
}

// Returns the point, or NaN where arithmetic without fused multiply-add would overflow: otherwise the
// instruction set would decide whether there is a result.
Vec3 nan_if_out_of_range(const Vec3& point) {
  const bool in_range = point.cwiseAbs().maxCoeff() < 0x1p996;
  return in_range ? point : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
}

void load(std::size_t lane, const Pose& pose, const Vec3& c_B, PlaneLanes& lanes) {
  const Eigen::Quaterniond q = within_range(pose.q_WB);
  lanes.q[0][lane] = q.w();
  lanes.q[1][lane] = q.x();
  lanes.q[2][lane] = q.y();
  lanes.q[3][lane] = q.z();
  const Vec3 p = nan_if_out_of_range(pose.p_WB);
  const Vec3 c = nan_if_out_of_range(c_B);
  for (std::size_t i = 0; i < 3; ++i) {
    lanes.p[i][lane] = p[static_cast<Eigen::Index>(i)];
    lanes.c[i][lane] = c[static_cast<Eigen::Index>(i)];
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

WaterPlane water_plane_in_body(const Pose& pose, const Water& water, const Vec3& c_B) {
  WaterPlane plane;
  HWY_DYNAMIC_DISPATCH(compute_plane)
  (within_range(pose.q_WB), nan_if_out_of_range(pose.p_WB), nan_if_out_of_range(c_B), water, plane);
  return plane;
}

void water_planes_in_body(std::span<const Pose> poses, const Water& water, std::span<const Vec3> centers_B,
                          std::span<WaterPlane> planes) {
  assert(poses.size() == centers_B.size() && poses.size() == planes.size());
  PlaneLanes lanes;
  for (std::size_t first = 0; first < poses.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, poses.size() - first);
    if (count < kMinBodies) {
      for (std::size_t i = first; i < poses.size(); ++i)
        planes[i] = water_plane_in_body(poses[i], water, centers_B[i]);
      break;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = first + std::min(lane, count - 1);  // the last body fills the lanes after it
      load(lane, poses[i], centers_B[i], lanes);
    }
    HWY_DYNAMIC_DISPATCH(compute_planes)(water, count, lanes);
    for (std::size_t lane = 0; lane < count; ++lane) planes[first + lane] = plane_of(lane, lanes);
  }
}

}  // namespace buoyancy
#endif  // HWY_ONCE
