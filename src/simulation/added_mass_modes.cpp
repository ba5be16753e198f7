#include "simulation/added_mass_modes.h"

#include <cmath>

#include "hydrodynamics/symmetric_eigenvalues.h"

namespace buoyancy {
namespace {

// diag(m, I) to a power, in B's axes.
Mat6 mass_to_power(const RigidBody& rigid, double power) {
  Mat6 matrix = Mat6::Zero();
  matrix.diagonal().head<3>().setConstant(std::pow(rigid.mass, power));
  const Vec3 inertia = rigid.principal_inertia.array().pow(power);
  matrix.bottomRightCorner<3, 3>() =
      rigid.principal_axes_B * inertia.asDiagonal() * rigid.principal_axes_B.transpose();
  return matrix;
}

}  // namespace

Mat6 congruent(const Mat6& matrix, const Mat6& N) {
  // Coefficient by coefficient: Eigen's blocked products are expensive to compile.
  const Mat6 half = matrix.lazyProduct(N);
  return N.transpose().lazyProduct(half);
}

Mat6 added_mass_at_center(const Body& body, const RigidBody& rigid) {
  if (body.hydrodynamics == nullptr || !body.hydrodynamics->coefficients().added_mass) return Mat6::Zero();
  const AddedMassCoefficients& added = *body.hydrodynamics->coefficients().added_mass;
  return matrix_at(added.matrix, rigid.center_of_mass_B - added.center_B);
}

AddedMassModes::AddedMassModes(const RigidBody& rigid, const Mat6& added_mass_B) {
  const Mat6 by_mass = mass_to_power(rigid, -0.5);
  const Mat6 scaled = congruent(added_mass_B, by_mass);
  const SymmetricEigen6 eigen = symmetric_eigen(0.5 * (scaled + scaled.transpose()));
  ratio_ = eigen.values.cwiseMax(0.0);
  to_twist_ = by_mass.lazyProduct(eigen.vectors);
  to_modal_ = eigen.vectors.transpose().lazyProduct(mass_to_power(rigid, 0.5));
}

Vec6 AddedMassModes::modal(const Vec6& twist_B, double immersion) const {
  const Vec6 scale = (1.0 + immersion * ratio_.array()).sqrt();
  return scale.cwiseProduct(to_modal_ * twist_B);
}

Mat6 AddedMassModes::twist_of_modal(double immersion) const {
  const Vec6 scale = (1.0 + immersion * ratio_.array()).rsqrt();
  return to_twist_ * scale.asDiagonal();
}

}  // namespace buoyancy
