#include "hydrostatics/water_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hydrostatics/double_double.h"

namespace buoyancy {
namespace {

using DoubleDouble3 = std::array<DoubleDouble, 3>;

DoubleDouble dot(const Vec3& a, const Vec3& b) {
  return sum(two_product(a.x(), b.x()), two_product(a.y(), b.y()), two_product(a.z(), b.z()));
}

// Returns the quaternion, scaled by a power of two so that no square of a component that matters over- or
// underflows. Such a scale changes no bit of a rotation.
Eigen::Quaterniond within_range(const Eigen::Quaterniond& q) {
  const double largest = q.coeffs().cwiseAbs().maxCoeff();
  if (largest > 0x1p-100 && largest < 0x1p100) return q;
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [exponent](double value) { return std::ldexp(value, -exponent); };
  return {scaled(q.w()), scaled(q.x()), scaled(q.y()), scaled(q.z())};
}

// R_WB^T up = ((w^2 - |u|^2) up + 2 (u . up) u - 2 w (u x up)) / |q|^2 for q = (w, u) of any norm: every term
// holds two components of q, so q and -q give the same bits.
DoubleDouble3 rotate_into_body(const Eigen::Quaterniond& q_WB, const Vec3& up_W) {
  const Eigen::Quaterniond q = within_range(q_WB);
  const double w = q.w();
  const Vec3 u = q.vec();

  const DoubleDouble w_squared = two_product(w, w);
  const DoubleDouble u_squared = dot(u, u);
  const DoubleDouble per_norm_squared = reciprocal(w_squared + u_squared);
  const DoubleDouble along = w_squared - u_squared;
  const DoubleDouble u_dot_up = dot(u, up_W);

  DoubleDouble3 k;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int l = (i + 2) % 3;
    const DoubleDouble cross = two_product(u[j], up_W[l]) - two_product(u[l], up_W[j]);
    const DoubleDouble twice = u_dot_up * (2.0 * u[i]) - cross * (2.0 * w);
    k[static_cast<std::size_t>(i)] = (along * up_W[i] + twice) * per_norm_squared;
  }
  return k;
}

}  // namespace

WaterPlane water_plane_in_body(const Pose& pose, const Water& water, const Vec3& c_B) {
  const DoubleDouble3 k = rotate_into_body(pose.q_WB, water.up_W);
  const DoubleDouble k_dot_c = sum(k[0] * c_B.x(), k[1] * c_B.y(), k[2] * c_B.z());
  const DoubleDouble h_c = sum(DoubleDouble{water.level, 0.0}, -dot(water.up_W, pose.p_WB), -k_dot_c);
  return {{k[0].hi, k[1].hi, k[2].hi}, h_c.hi, {k[0].lo, k[1].lo, k[2].lo}, h_c.lo};
}

}  // namespace buoyancy
