#include "simulation/added_mass_modes.h"

#include "hydrodynamics/linear_algebra.h"

namespace buoyancy {

Mat6 congruent(const Mat6& matrix, const Mat6& N) {
  // The products are taken coefficient by coefficient, since Eigen's blocked ones are expensive to compile.
  const Mat6 half = matrix.lazyProduct(N);
  return N.transpose().lazyProduct(half);
}

Mat6 mass_at_center(const RigidBody& rigid) {
  Mat6 mass = Mat6::Zero();
  mass.diagonal().head<3>().setConstant(rigid.mass);
  mass.bottomRightCorner<3, 3>() =
      rigid.principal_axes_B * rigid.principal_inertia.asDiagonal() * rigid.principal_axes_B.transpose();
  return mass;
}

Mat6 added_mass_at_center(const Body& body, const RigidBody& rigid) {
  if (body.hydrodynamics == nullptr || !body.hydrodynamics->coefficients().added_mass) return Mat6::Zero();
  const AddedMassCoefficients& added = *body.hydrodynamics->coefficients().added_mass;
  return matrix_at(added.matrix, rigid.center_of_mass_B - added.center_B);
}

AddedMassModes::AddedMassModes(const RigidBody& rigid, const Mat6& added_mass_B) {
  const Mat6 mass = mass_at_center(rigid);
  const SymmetricEigen<6> eigen = symmetric_eigen<6>(added_mass_B, mass);
  ratio_ = eigen.values.cwiseMax(0.0);
  to_twist_ = eigen.vectors;
  to_modal_ = eigen.vectors.transpose().lazyProduct(mass);
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
