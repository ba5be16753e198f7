// Solves linear systems of six equations. Eigen's fixed-size solvers take seconds to compile.
#pragma once

#include "base/spatial.h"

namespace buoyancy {

// The solution x of matrix x = right, by LU decomposition with partial pivoting, of the matrix scaled to a
// diagonal of ones: its elements have different units. matrix: regular.
Vec6 solve(const Mat6& matrix, const Vec6& right);

// The same for six right sides, one per column.
Mat6 solve(const Mat6& matrix, const Mat6& right);

}  // namespace buoyancy
