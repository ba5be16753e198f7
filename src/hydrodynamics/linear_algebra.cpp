#include "hydrodynamics/linear_algebra.h"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace buoyancy {

template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix,
                                  const Eigen::Matrix<double, n, n>& mass) {
  using Matrix = Eigen::Matrix<double, n, n>;
  const Matrix symmetric = 0.5 * (matrix + matrix.transpose());
  // The eigensolver also decomposes the mass, but does not say whether it is positive definite.
  if (symmetric.allFinite() && mass.allFinite() && Eigen::LLT<Matrix>(mass).info() == Eigen::Success) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(symmetric, mass);
    SymmetricEigen<n> eigen{solver.eigenvalues(), solver.eigenvectors()};
    if (eigen.values.allFinite() && eigen.vectors.allFinite()) return eigen;
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {Eigen::Matrix<double, n, 1>::Constant(kNone), Matrix::Constant(kNone)};
}

template SymmetricEigen<3> symmetric_eigen<3>(const Mat3& matrix, const Mat3& mass);
template SymmetricEigen<6> symmetric_eigen<6>(const Mat6& matrix, const Mat6& mass);

Vec6 solve(const Mat6& matrix, const Vec6& right) {
  const Vec6 scale = matrix.diagonal().unaryExpr(
      [](double element) { return element != 0.0 ? 1.0 / std::sqrt(std::abs(element)) : 1.0; });
  const Mat6 scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Vec6 solution = Eigen::PartialPivLU<Mat6>(scaled).solve(scale.cwiseProduct(right));
  return scale.cwiseProduct(solution);
}

}  // namespace buoyancy
