#include "hydrodynamics/linear_algebra.h"

#include <cmath>
#include <limits>
#include <random>

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
    const SymmetricEigen<6> eigen = symmetric_eigen<6>(matrix, Mat6::Identity());
    const Mat6 recomposed = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
    EXPECT_LE((recomposed - matrix).norm(), 1e-14 * matrix.norm());
    EXPECT_LE((eigen.vectors.transpose() * eigen.vectors - Mat6::Identity()).norm(), 1e-14);
  }
}

TEST(SymmetricEigen, MakesMassAndSymmetricPartDiagonal) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const Mat6 mass = random_definite(random);
    const Mat6 matrix = random_mat6(random);
    const SymmetricEigen<6> eigen = symmetric_eigen<6>(matrix, mass);
    const Mat6& V = eigen.vectors;
    const Mat6 symmetric = 0.5 * (matrix + matrix.transpose());
    EXPECT_LE((V.transpose() * mass * V - Mat6::Identity()).norm(), 1e-12);
    EXPECT_LE((V.transpose() * symmetric * V - Mat6(eigen.values.asDiagonal())).norm(),
              1e-12 * (V * V).norm());
    for (Eigen::Index k = 1; k < 6; ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
  }
}

TEST(SymmetricEigen, IsNotANumberWithoutPositiveMassOrFiniteMatrix) {
  const Mat6 singular = Vec6(1.0, 1.0, 0.0, 1.0, 1.0, 1.0).asDiagonal();
  EXPECT_TRUE(std::isnan(symmetric_eigen<6>(Mat6::Identity(), singular).values[5]));
  const Mat6 infinite = std::numeric_limits<double>::infinity() * Mat6::Identity();
  EXPECT_TRUE(std::isnan(symmetric_eigen<6>(infinite, Mat6::Identity()).values[0]));
  EXPECT_TRUE(std::isnan(symmetric_eigen<6>(Mat6::Identity(), infinite).values[0]));
}

TEST(LinearSolver, SolvesBadlyScaledSystems) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    Vec6 scale;
    for (Eigen::Index k = 0; k < 6; ++k) scale[k] = std::pow(10.0, 6.0 * random_number(random));
    const Mat6 definite = random_definite(random);
    const Mat6 other = random_mat6(random);
    const Mat6 plain = definite + other - random_mat6(random).transpose();
    const Mat6 matrix = scale.asDiagonal() * plain * scale.asDiagonal();
    const Vec6 expected = scale.cwiseInverse().cwiseProduct(random_vec6(random));
    const Vec6 solution = solve(matrix, Vec6(matrix * expected));
    EXPECT_LT(scale.cwiseProduct(solution - expected).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace buoyancy
