#include "hydrodynamics/coefficient_checks.h"

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

// In units that differ between its rows and columns.
Mat6 in_other_units(const Mat6& matrix) {
  const Vec6 scale{1e3, 1e-2, 7.0, 1e4, 1e-6, 0.5};
  return scale.asDiagonal() * matrix * scale.asDiagonal();
}

TEST(CoefficientChecks, AcceptSemidefiniteMatricesInAnyUnits) {
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const Mat6 semidefinite = in_other_units(random_semidefinite(random, 1 + i % 6));
    EXPECT_FALSE(find_added_mass_fault(semidefinite)) << semidefinite;
    const Mat6 skew = random_mat6(random);
    EXPECT_FALSE(find_drag_fault(semidefinite + (skew - skew.transpose())));
  }
  EXPECT_FALSE(find_added_mass_fault(Mat6::Zero()));
  EXPECT_FALSE(find_drag_fault(Mat6::Zero()));
}

TEST(CoefficientChecks, RejectIndefiniteMatricesInAnyUnits) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    // One direction of the space of twists is driven.
    const Vec6 direction = random_vec6(random).normalized();
    const Mat6 indefinite =
        in_other_units(Mat6::Identity() - (1.01 + 0.1 * (i % 5)) * direction * direction.transpose());
    EXPECT_TRUE(find_added_mass_fault(indefinite)) << indefinite;
    EXPECT_TRUE(find_drag_fault(indefinite)) << indefinite;
  }
}

TEST(CoefficientChecks, NameTheOtherSignConvention) {
  const Mat6 negative = -Mat6::Identity();
  for (const auto& fault : {find_drag_fault(negative), find_added_mass_fault(negative)}) {
    ASSERT_TRUE(fault);
    EXPECT_TRUE(contains(fault->expected, "row 1, column 1 is -1"));
    EXPECT_TRUE(contains(fault->hint, "Negate"));
    EXPECT_TRUE(contains(fault->hint, "gz-sim and Fossen"));
  }
}

TEST(CoefficientChecks, RejectAnUnsymmetricAddedMassOnly) {
  Mat6 matrix = Mat6::Identity();
  matrix(1, 5) = 0.25;
  EXPECT_FALSE(find_drag_fault(matrix));
  const auto fault = find_added_mass_fault(matrix);
  ASSERT_TRUE(fault);
  EXPECT_TRUE(contains(fault->expected, "row 6, column 2 is 0, row 2, column 6 is 0.25"));
  // The limit is relative to the diagonal: 1e-6 of the root of 4 times 9.
  matrix(1, 1) = 4.0;
  matrix(5, 5) = 9.0;
  matrix(5, 1) = 0.25 + 5.9e-6;
  EXPECT_FALSE(find_added_mass_fault(matrix));
  matrix(5, 1) = 0.25 + 6.1e-6;
  EXPECT_TRUE(find_added_mass_fault(matrix));
}

TEST(CoefficientChecks, FindTheTwistThatAFullQuadraticDragDrives) {
  Mat6 matrix = Mat6::Zero();
  matrix.topLeftCorner<2, 2>() << 1.0, 10.0, 10.0, 100.0;
  EXPECT_FALSE(find_drag_fault(matrix));
  const std::optional<Vec6> twist = find_driving_twist(matrix);
  ASSERT_TRUE(twist);
  EXPECT_LT(twist->dot(matrix * twist->cwiseAbs().cwiseProduct(*twist)), 0.0);

  std::mt19937 random(4);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(find_driving_twist(random_vec6(random).cwiseAbs().asDiagonal()));
  }
}

}  // namespace
}  // namespace buoyancy
