// Eigenvalues and linear systems of up to six equations. Eigen's solvers of fixed size take seconds to
// compile: this library instantiates them once.
#pragma once

#include "base/spatial.h"

namespace buoyancy {

template <int n>
struct SymmetricEigen {
  Eigen::Matrix<double, n, 1> values;   // ascending
  Eigen::Matrix<double, n, n> vectors;  // column i: that of values[i]
};

// Solves matrix x = value mass x, with x^T mass x = 1. Only the matrix's symmetric part counts; mass:
// symmetric. All numbers are NaN where the mass is not positive definite, or a number is beyond double's
// range. Accurate to a few eps of the largest magnitude. n: 3 or 6. Complexity: O(1), some microseconds.
template <int n>
SymmetricEigen<n> symmetric_eigen(const Eigen::Matrix<double, n, n>& matrix,
                                  const Eigen::Matrix<double, n, n>& mass);

extern template SymmetricEigen<3> symmetric_eigen<3>(const Mat3& matrix, const Mat3& mass);
extern template SymmetricEigen<6> symmetric_eigen<6>(const Mat6& matrix, const Mat6& mass);

// Returns the solution x of matrix x = right, by LU decomposition with partial pivoting. The matrix is scaled
// to a diagonal of ones first, since its elements have different units. matrix: regular.
Vec6 solve(const Mat6& matrix, const Vec6& right);

}  // namespace buoyancy
