#include "geometry/exact_predicates.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "base/double_double.h"

namespace buoyancy {
namespace {

constexpr double kUnitRoundoff = 0x1p-53;  // half an ulp of 1
// Rounding error bounds of the determinants in double, relative to the sums of their absolute products.
constexpr double kError2d = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
constexpr double kError3d = (7.0 + 56.0 * kUnitRoundoff) * kUnitRoundoff;

// A number as the exact sum of at most kCapacity doubles, all non-zero, with non-overlapping bits, smallest
// first. The last term therefore has the sign of the sum.
template <std::size_t kCapacity>
struct Expansion {
  std::array<double, kCapacity> terms;
  std::size_t size = 0;

  // Adds a double exactly. Requires size < kCapacity.
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const auto [sum, error] = two_sum(value, terms[i]);
      if (error != 0.0) terms[kept++] = error;
      value = sum;
    }
    if (value != 0.0) terms[kept++] = value;
    size = kept;
  }

  int sign() const {
    if (size == 0) return 0;
    return terms[size - 1] > 0.0 ? 1 : -1;
  }
};

Expansion<2> difference(double a, double b) {
  Expansion<2> result;
  const auto [sum, error] = two_sum(a, -b);
  if (error != 0.0) result.terms[result.size++] = error;
  if (sum != 0.0) result.terms[result.size++] = sum;
  return result;
}

template <std::size_t kA, std::size_t kB>
Expansion<kA + kB> operator+(const Expansion<kA>& a, const Expansion<kB>& b) {
  Expansion<kA + kB> result;
  for (std::size_t i = 0; i < a.size; ++i) result.terms[i] = a.terms[i];
  result.size = a.size;
  for (std::size_t i = 0; i < b.size; ++i) result.add(b.terms[i]);
  return result;
}

template <std::size_t kA>
Expansion<kA> operator-(Expansion<kA> a) {
  for (std::size_t i = 0; i < a.size; ++i) a.terms[i] = -a.terms[i];
  return a;
}

template <std::size_t kA, std::size_t kB>
Expansion<2 * kA * kB> operator*(const Expansion<kA>& a, const Expansion<kB>& b) {
  Expansion<2 * kA * kB> result;
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t j = 0; j < b.size; ++j) {
      const auto [product, error] = two_product(a.terms[i], b.terms[j]);
      result.add(error);
      result.add(product);
    }
  }
  return result;
}

int orient_2d_exactly(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const auto ac_x = difference(a.x(), c.x());
  const auto ac_y = difference(a.y(), c.y());
  const auto bc_x = difference(b.x(), c.x());
  const auto bc_y = difference(b.y(), c.y());
  return (ac_x * bc_y + -(ac_y * bc_x)).sign();
}

using Difference3 = std::array<Expansion<2>, 3>;

Difference3 difference(const Vec3& a, const Vec3& b) {
  return {difference(a.x(), b.x()), difference(a.y(), b.y()), difference(a.z(), b.z())};
}

// Returns the part of (v x w) . u along one axis.
auto triple_product_part(const Difference3& u, const Difference3& v, const Difference3& w, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  return (v[next] * w[last] + -(v[last] * w[next])) * u[axis];
}

int orient_3d_exactly(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Difference3 b_a = difference(b, a);
  const Difference3 c_a = difference(c, a);
  const Difference3 d_a = difference(d, a);
  return (triple_product_part(d_a, b_a, c_a, 0) + triple_product_part(d_a, b_a, c_a, 1) +
          triple_product_part(d_a, b_a, c_a, 2))
      .sign();
}

int sign(double value) {
  return value > 0.0 ? 1 : (value < 0.0 ? -1 : 0);
}

struct Estimate {
  double value;
  double error;
};

Estimate estimate_orient_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double ux = b.x() - a.x();
  const double uy = b.y() - a.y();
  const double uz = b.z() - a.z();
  const double vx = c.x() - a.x();
  const double vy = c.y() - a.y();
  const double vz = c.z() - a.z();
  const double wx = d.x() - a.x();
  const double wy = d.y() - a.y();
  const double wz = d.z() - a.z();
  const double uy_vz = uy * vz;
  const double uz_vy = uz * vy;
  const double uz_vx = uz * vx;
  const double ux_vz = ux * vz;
  const double ux_vy = ux * vy;
  const double uy_vx = uy * vx;
  const double value = wx * (uy_vz - uz_vy) + wy * (uz_vx - ux_vz) + wz * (ux_vy - uy_vx);
  const double sum_of_sizes = std::abs(wx) * (std::abs(uy_vz) + std::abs(uz_vy)) +
                              std::abs(wy) * (std::abs(uz_vx) + std::abs(ux_vz)) +
                              std::abs(wz) * (std::abs(ux_vy) + std::abs(uy_vx));
  return {value, kError3d * sum_of_sizes};
}

}  // namespace

int orient_2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double value = left - right;
  const double error = kError2d * (std::abs(left) + std::abs(right));
  // If the error is 0, both products are 0 and so is the sign.
  if (std::abs(value) > error || error == 0.0) return sign(value);
  return orient_2d_exactly(a, b, c);
}

int orient_3d_filtered(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Estimate estimate = estimate_orient_3d(a, b, c, d);
  return std::abs(estimate.value) > estimate.error ? sign(estimate.value) : 0;
}

int orient_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Estimate estimate = estimate_orient_3d(a, b, c, d);
  if (std::abs(estimate.value) > estimate.error || estimate.error == 0.0) return sign(estimate.value);
  return orient_3d_exactly(a, b, c, d);
}

bool collinear(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orient_2d(project_along_axis(axis, a), project_along_axis(axis, b), project_along_axis(axis, c)) != 0)
      return false;
  }
  return true;
}

}  // namespace buoyancy
