#include "hydrodynamics/linear_solver.h"

#include <cmath>
#include <utility>

namespace buoyancy {
namespace {

// Exchanges row `column` with the row from there on that has the largest element in this column.
template <int kColumns>
void pivot(int column, Mat6& matrix, Eigen::Matrix<double, 6, kColumns>& right) {
  int largest = column;
  for (int row = column + 1; row < 6; ++row) {
    if (std::abs(matrix(row, column)) > std::abs(matrix(largest, column))) largest = row;
  }
  if (largest == column) return;
  for (int k = 0; k < 6; ++k) std::swap(matrix(column, k), matrix(largest, k));
  for (int k = 0; k < kColumns; ++k) std::swap(right(column, k), right(largest, k));
}

template <int kColumns>
Eigen::Matrix<double, 6, kColumns> solve_scaled(Mat6 matrix, Eigen::Matrix<double, 6, kColumns> right) {
  Vec6 scale;
  for (int i = 0; i < 6; ++i) {
    const double diagonal = std::abs(matrix(i, i));
    scale[i] = diagonal > 0.0 ? 1.0 / std::sqrt(diagonal) : 1.0;
  }
  for (int row = 0; row < 6; ++row) {
    for (int k = 0; k < 6; ++k) matrix(row, k) *= scale[row] * scale[k];
    for (int k = 0; k < kColumns; ++k) right(row, k) *= scale[row];
  }
  for (int column = 0; column < 6; ++column) {
    pivot(column, matrix, right);
    for (int row = column + 1; row < 6; ++row) {
      const double factor = matrix(row, column) / matrix(column, column);
      for (int k = column + 1; k < 6; ++k) matrix(row, k) -= factor * matrix(column, k);
      for (int k = 0; k < kColumns; ++k) right(row, k) -= factor * right(column, k);
    }
  }
  for (int k = 0; k < kColumns; ++k) {
    for (int row = 5; row >= 0; --row) {
      for (int i = row + 1; i < 6; ++i) right(row, k) -= matrix(row, i) * right(i, k);
      right(row, k) /= matrix(row, row);
    }
    for (int row = 0; row < 6; ++row) right(row, k) *= scale[row];
  }
  return right;
}

}  // namespace

Vec6 solve(const Mat6& matrix, const Vec6& right) {
  return solve_scaled<1>(matrix, right);
}

Mat6 solve(const Mat6& matrix, const Mat6& right) {
  return solve_scaled<6>(matrix, right);
}

}  // namespace buoyancy
