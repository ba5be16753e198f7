#include "hydrodynamics/small_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include "hydrodynamics/linear_algebra.h"

namespace buoyancy {
namespace {

// Assigns an eigenvector to each of heave, roll and pitch such that these coordinates carry the most energy.
// share(i, j): the part of eigenvector j's energy that is in coordinate i.
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
  constexpr std::array<Eigen::Index, 3> kFree{0, 1, 5};  // surge, sway, yaw
  constexpr std::array<Eigen::Index, 3> kRestored{2, 3, 4};
  // Nothing restores the free coordinates. They follow the others such that their momentum stays zero, which
  // changes the mass of the others.
  const Mat3 coupling = mass(kFree, kRestored);
  const Eigen::LLT<Mat3> free_mass(mass(kFree, kFree));
  if (free_mass.info() != Eigen::Success) return std::nullopt;
  const Mat3 free_per_restored = -free_mass.solve(coupling);
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(
      stiffness(kRestored, kRestored), mass(kRestored, kRestored) + coupling.transpose() * free_per_restored);
  std::array<MotionMode, 3> modes;
  Mat3 share;
  for (Eigen::Index j = 0; j < 3; ++j) {
    MotionMode& mode = modes[static_cast<std::size_t>(j)];
    mode.stiffness = eigen.values[j];
    mode.shape(kRestored) = eigen.vectors.col(j);
    mode.shape(kFree) = free_per_restored * eigen.vectors.col(j);
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
  const double largest_damping = symmetric_eigen<6>(damping, mass).values[5];
  if (!std::isfinite(largest_damping)) return std::nullopt;
  // With mu = 2 / h, mu^2 M - mu D - K turns singular. A vector x with x^T M x = 1 has mu(x) =
  // (d + sqrt(d^2 + 4 k)) / 2 with d = x^T D x and k = x^T K x. Its maximum is found from below: where mu is
  // less, the eigenvector of the largest eigenvalue of mu D + K has a mu(x) above it, which converges
  // quadratically.
  constexpr int kMaxRounds = 60;
  double mu = std::max(0.0, largest_damping);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Vec6 x = symmetric_eigen<6>(mu * damping + stiffness, mass).vectors.col(5);
    if (!x.allFinite()) return std::nullopt;
    const double d = std::max(0.0, x.dot(damping * x));
    const double k = std::max(0.0, x.dot(stiffness * x));
    const double next = 0.5 * (d + std::sqrt(d * d + 4.0 * k));
    if (!std::isfinite(next)) return std::nullopt;
    if (next <= mu * (1.0 + 4.0 * std::numeric_limits<double>::epsilon())) break;
    mu = next;
  }
  return 2.0 / mu;
}

std::optional<double> max_mass_ratio(const Mat6& mass, const Mat6& added_mass) {
  const double largest = symmetric_eigen<6>(added_mass, mass).values[5];
  if (!std::isfinite(largest)) return std::nullopt;
  return std::max(0.0, largest);
}

}  // namespace buoyancy
