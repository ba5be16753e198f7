// Eigenvalues and eigenvectors of small symmetric matrices.
#pragma once

#include "base/spatial.h"

namespace buoyancy {

struct SymmetricEigen6 {
  Vec6 values = Vec6::Zero();       // in no particular order
  Mat6 vectors = Mat6::Identity();  // column i: unit, of values[i]
};

// By cyclic Jacobi rotations, which converge quadratically; Eigen's fixed-size solver takes seconds to
// compile. Accurate to a few eps of the largest magnitude. matrix: symmetric, finite.
SymmetricEigen6 symmetric_eigen(Mat6 matrix);

}  // namespace buoyancy
