#include "hydrodynamics/small_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "hydrodynamics/symmetric_eigenvalues.h"

namespace buoyancy {
namespace {

Mat6 symmetric_part(const Mat6& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

// Factor L of a symmetric positive definite matrix, L L^T. Written out, as are the substitutions below, since
// products and decompositions of 6 x 6 matrices are expensive to compile.
std::optional<Mat6> cholesky(const Mat6& matrix) {
  Mat6 L = Mat6::Zero();
  for (Eigen::Index column = 0; column < 6; ++column) {
    for (Eigen::Index row = column; row < 6; ++row) {
      double sum = matrix(row, column);
      for (Eigen::Index k = 0; k < column; ++k) sum -= L(row, k) * L(column, k);
      if (row > column) {
        L(row, column) = sum / L(column, column);
      } else if (sum > 0.0) {
        L(row, row) = std::sqrt(sum);
      } else {
        return std::nullopt;
      }
    }
  }
  if (!L.allFinite()) return std::nullopt;
  return L;
}

// L^-1 b.
Vec6 solve_lower(const Mat6& L, Vec6 b) {
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) b[i] -= L(i, k) * b[k];
    b[i] /= L(i, i);
  }
  return b;
}

// L^-T b.
Vec6 solve_upper(const Mat6& L, Vec6 b) {
  for (Eigen::Index i = 5; i >= 0; --i) {
    for (Eigen::Index k = i + 1; k < 6; ++k) b[i] -= L(k, i) * b[k];
    b[i] /= L(i, i);
  }
  return b;
}

// L^-1 A L^-T, of the symmetric part of A.
Mat6 relative_to(const Mat6& L, const Mat6& matrix) {
  const Mat6 A = symmetric_part(matrix);
  Mat6 half;
  for (Eigen::Index i = 0; i < 6; ++i) half.col(i) = solve_lower(L, A.col(i));
  Mat6 whole;
  for (Eigen::Index i = 0; i < 6; ++i) whole.col(i) = solve_lower(L, half.row(i).transpose());
  return symmetric_part(whole);
}

// Surge, sway and yaw first. The factor of a matrix in this order eliminates them before the others, so that
// a stiffness without them remains one.
constexpr std::array<Eigen::Index, 6> kFreeFirst{0, 1, 5, 2, 3, 4};

Mat6 free_first(const Mat6& matrix) {
  Mat6 ordered;
  for (Eigen::Index i = 0; i < 6; ++i) {
    for (Eigen::Index j = 0; j < 6; ++j) {
      ordered(i, j) =
          matrix(kFreeFirst[static_cast<std::size_t>(i)], kFreeFirst[static_cast<std::size_t>(j)]);
    }
  }
  return ordered;
}

// The index of the eigenvector that each of heave, roll and pitch belongs to: the assignment whose
// coordinates carry the most energy. share(i, j): of eigenvector j's energy, that in coordinate i.
std::array<Eigen::Index, 3> assign_modes(const Mat3& share) {
  std::array<Eigen::Index, 3> modes{0, 1, 2};
  std::array<Eigen::Index, 3> best = modes;
  double best_sum = -std::numeric_limits<double>::infinity();
  do {
    const double sum = share(0, modes[0]) + share(1, modes[1]) + share(2, modes[2]);
    if (sum > best_sum) {
      best_sum = sum;
      best = modes;
    }
  } while (std::ranges::next_permutation(modes).found);
  return best;
}

}  // namespace

std::optional<HeaveRollPitch> heave_roll_pitch(const Mat6& mass, const Mat6& stiffness) {
  const std::optional<Mat6> L = cholesky(free_first(mass));
  if (!L) return std::nullopt;
  Mat6 restoring = free_first(stiffness);
  restoring.topRows<3>().setZero();
  restoring.leftCols<3>().setZero();
  const Mat6 relative = relative_to(*L, restoring);
  if (!relative.allFinite()) return std::nullopt;
  // The first three rows and columns are zero, so that the last three eigenvectors are the modes.
  const SymmetricEigen6 eigen = symmetric_eigen(relative);
  std::array<MotionMode, 3> modes;
  Mat3 share;
  for (Eigen::Index j = 0; j < 3; ++j) {
    MotionMode& mode = modes[static_cast<std::size_t>(j)];
    const Vec6 ordered = solve_upper(*L, eigen.vectors.col(3 + j));
    mode.stiffness = eigen.values[3 + j];
    for (Eigen::Index i = 0; i < 6; ++i) mode.shape[kFreeFirst[static_cast<std::size_t>(i)]] = ordered[i];
    const Vec6 momentum = mass * mode.shape;
    for (Eigen::Index i = 0; i < 3; ++i) share(i, j) = mode.shape[2 + i] * momentum[2 + i];
    if (!mode.shape.allFinite() || !std::isfinite(mode.stiffness)) return std::nullopt;
  }
  const std::array<Eigen::Index, 3> index = assign_modes(share);
  const auto mode_of = [&](std::size_t i) { return modes[static_cast<std::size_t>(index[i])]; };
  return HeaveRollPitch{mode_of(0), mode_of(1), mode_of(2)};
}

double damping_ratio(const MotionMode& mode, const Mat6& damping) {
  return 0.5 * mode.shape.dot(damping * mode.shape) / std::sqrt(mode.stiffness);
}

double quadratic_damping_ratio(const Vec6& twist_of_shape, const Mat6& quadratic, double amplitude) {
  // The velocity's amplitude is omega amplitude shape: omega cancels.
  const Vec6& u = twist_of_shape;
  const double power = u.dot(quadratic * u.cwiseAbs().cwiseProduct(u));
  return 4.0 / (3.0 * std::numbers::pi) * std::abs(amplitude) * power;
}

std::optional<double> max_explicit_step(const Mat6& mass, const Mat6& damping, const Mat6& stiffness) {
  const std::optional<Mat6> L = cholesky(mass);
  if (!L) return std::nullopt;
  const Mat6 D = relative_to(*L, damping);
  const Mat6 K = relative_to(*L, stiffness);
  if (!D.allFinite() || !K.allFinite()) return std::nullopt;
  // With mu = 2 / h, mu^2 - mu D - K turns singular. A unit vector x has mu(x) = (d + sqrt(d^2 + 4 k)) / 2
  // with d = x^T D x and k = x^T K x. Its maximum is found from below: where mu is less, the eigenvector of
  // the largest eigenvalue of mu D + K has a mu(x) above it, which converges quadratically.
  constexpr int kMaxRounds = 60;
  double mu = std::max(0.0, symmetric_eigen(D).values.maxCoeff());
  for (int round = 0; round < kMaxRounds; ++round) {
    const SymmetricEigen6 eigen = symmetric_eigen(mu * D + K);
    Eigen::Index largest = 0;
    eigen.values.maxCoeff(&largest);
    const Vec6 x = eigen.vectors.col(largest);
    const double d = std::max(0.0, x.dot(D * x));
    const double k = std::max(0.0, x.dot(K * x));
    const double next = 0.5 * (d + std::sqrt(d * d + 4.0 * k));
    if (!std::isfinite(next)) return std::nullopt;
    if (next <= mu * (1.0 + 4.0 * std::numeric_limits<double>::epsilon())) break;
    mu = next;
  }
  return 2.0 / mu;
}

std::optional<double> max_mass_ratio(const Mat6& mass, const Mat6& added_mass) {
  const std::optional<Mat6> L = cholesky(mass);
  if (!L) return std::nullopt;
  const Mat6 relative = relative_to(*L, added_mass);
  if (!relative.allFinite()) return std::nullopt;
  return std::max(0.0, symmetric_eigen(relative).values.maxCoeff());
}

}  // namespace buoyancy
