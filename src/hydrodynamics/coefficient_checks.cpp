#include "hydrodynamics/coefficient_checks.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/format.h"
#include "hydrodynamics/linear_algebra.h"

namespace buoyancy {

const char* const kNegativeSignHint =
    "Negate: here positive numbers oppose the motion and add inertia; gz-sim and Fossen write the other sign";

namespace {

// The allowed asymmetry relative to the elements. Matrices are often given with seven digits.
constexpr double kAsymmetry = 1e-6;
// The allowed magnitude of a negative eigenvalue of the matrix scaled to a diagonal of ones.
constexpr double kIndefinite = 1e-6;

std::string element(Eigen::Index row, Eigen::Index column) {
  return "row " + std::to_string(row + 1) + ", column " + std::to_string(column + 1);
}

std::optional<CoefficientFault> find_negative_diagonal(const Mat6& matrix) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (matrix(i, i) >= 0.0) continue;
    return CoefficientFault{"no negative number on the diagonal (here " + element(i, i) + " is " +
                                format_number(matrix(i, i), 6) + ")",
                            "the sign convention of another program", kNegativeSignHint};
  }
  return std::nullopt;
}

// Checks a symmetric matrix without negative diagonal elements, scaled to a diagonal of ones since its
// elements have different units.
std::optional<CoefficientFault> find_indefinite(const Mat6& matrix) {
  const CoefficientFault fault{
      "a matrix whose symmetric part is positive semidefinite", "",
      "Check the elements off the diagonal, their signs, and the order of the axes: x, y, z, then the "
      "rotations about x, y, z"};
  Mat6 scaled = matrix;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < 6; ++j) {
      if (i == j || matrix(i, j) == 0.0) continue;
      const double scale = std::sqrt(matrix(i, i)) * std::sqrt(matrix(j, j));
      if (!(std::abs(matrix(i, j)) <= (1.0 + kIndefinite) * scale)) {
        CoefficientFault too_large = fault;
        too_large.cause = element(i, j) + " is too large for the diagonal elements beside it: a motion " +
                          "exists that it would drive";
        return too_large;
      }
      scaled(i, j) = matrix(i, j) / scale;
    }
    scaled(i, i) = matrix(i, i) > 0.0 ? 1.0 : 0.0;
  }
  const double smallest = symmetric_eigen<6>(scaled, Mat6::Identity()).values[0];
  if (smallest >= -kIndefinite) return std::nullopt;
  CoefficientFault indefinite = fault;
  indefinite.cause = "the smallest eigenvalue, of the matrix scaled to a diagonal of ones, is " +
                     format_number(smallest, 4) + ": a motion exists that it would drive";
  return indefinite;
}

}  // namespace

std::optional<CoefficientFault> find_drag_fault(const Mat6& matrix) {
  if (std::optional<CoefficientFault> negative = find_negative_diagonal(matrix)) return negative;
  return find_indefinite(0.5 * matrix + 0.5 * matrix.transpose());
}

std::optional<CoefficientFault> find_added_mass_fault(const Mat6& matrix) {
  if (std::optional<CoefficientFault> negative = find_negative_diagonal(matrix)) return negative;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      const double scale = std::max({std::sqrt(matrix(i, i)) * std::sqrt(matrix(j, j)),
                                     std::abs(matrix(i, j)), std::abs(matrix(j, i))});
      if (std::abs(matrix(i, j) - matrix(j, i)) <= kAsymmetry * scale) continue;
      return CoefficientFault{"a symmetric matrix (" + element(i, j) + " is " +
                                  format_number(matrix(i, j), 6) + ", " + element(j, i) + " is " +
                                  format_number(matrix(j, i), 6) + ")",
                              "numbers in another order than row by row, or one that was mistyped",
                              "Use the mean of both if they are measured or computed values"};
    }
  }
  return find_indefinite(0.5 * matrix + 0.5 * matrix.transpose());
}

std::optional<Vec6> find_driving_twist(const Mat6& quadratic) {
  // The twist is scaled such that every axis has a drag of 1 along itself: the units then do not matter.
  Vec6 scale;
  for (Eigen::Index i = 0; i < 6; ++i) {
    scale[i] = quadratic(i, i) > 0.0 ? 1.0 / std::cbrt(quadratic(i, i)) : 1.0;
  }
  Mat6 scaled;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < 6; ++j) scaled(i, j) = scale[i] * quadratic(i, j) * scale[j] * scale[j];
  }
  const auto power = [&](const Vec6& u) { return u.dot(scaled * u.cwiseAbs().cwiseProduct(u)); };
  constexpr int kSteps = 200;
  for (int signs = 0; signs < 64; ++signs) {
    Vec6 u;
    for (Eigen::Index i = 0; i < 6; ++i) {
      // The magnitudes are unequal, since at equal ones the gradient may vanish by symmetry.
      u[i] = ((signs >> i) & 1 ? -1.0 : 1.0) * (1.0 + 0.1 * static_cast<double>(i));
    }
    u.normalize();
    double step = 0.5;
    for (int n = 0; n < kSteps && step > 1e-6; ++n) {
      const Vec6 gradient =
          scaled * u.cwiseAbs().cwiseProduct(u) + 2.0 * u.cwiseAbs().cwiseProduct(scaled.transpose() * u);
      const Vec6 next = (u - step * gradient).normalized();
      if (power(next) < power(u)) {
        u = next;
      } else {
        step *= 0.5;
      }
    }
    if (power(u) < -1e-9) return scale.cwiseProduct(u);
  }
  return std::nullopt;
}

}  // namespace buoyancy
