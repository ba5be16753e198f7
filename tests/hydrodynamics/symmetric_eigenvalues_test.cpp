#include "hydrodynamics/symmetric_eigenvalues.h"

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

TEST(SymmetricEigen, RecomposesTheMatrix) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    const Mat6 factor = random_mat6(random);
    const Mat6 matrix =
        i % 3 == 0 ? random_semidefinite(random, 1 + i % 6) : Mat6(factor + factor.transpose());
    const SymmetricEigen6 eigen = symmetric_eigen(matrix);
    const Mat6 recomposed = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
    EXPECT_LE((recomposed - matrix).norm(), 1e-14 * matrix.norm());
    EXPECT_LE((eigen.vectors.transpose() * eigen.vectors - Mat6::Identity()).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace buoyancy
