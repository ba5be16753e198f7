#include "base/spatial.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

TEST(Spatial, MovesAMatrixAsTwistsAndWrenchesMove) {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    const Mat6 matrix = random_mat6(random);
    const Vec3 offset = 3.0 * random_vec3(random);
    const Vec6 twist = random_vec6(random);  // of the new point
    const Vec6 expected = wrench_about(matrix * twist_at(twist, -offset), offset);
    // The torque about the new point is that about the old one minus offset x force.
    const Vec6 wrench = matrix * twist_at(twist, -offset);
    EXPECT_TRUE(expected.tail<3>().isApprox(wrench.tail<3>() - offset.cross(wrench.head<3>())));
    EXPECT_LE((matrix_at(matrix, offset) * twist - expected).norm(), 1e-13 * expected.norm());
  }
}

TEST(Spatial, TurnsAMatrixWithItsAxes) {
  std::mt19937 random(6);
  const Mat6 matrix = random_mat6(random);
  const Mat3 R_WB = random_rotation(random);
  Mat6 R = Mat6::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = R_WB;
  EXPECT_LE((rotated(matrix, R_WB) - R * matrix * R.transpose()).norm(), 1e-14 * matrix.norm());
}

// The momentum of the water turns with a body that moves with a constant twist in its own axes.
TEST(Spatial, CoriolisTermsAreTheRateOfMomentum) {
  std::mt19937 random(7);
  for (int i = 0; i < 50; ++i) {
    const Mat6 mass = random_semidefinite(random);
    const Vec6 twist = random_vec6(random);
    const Vec6 momentum = mass * twist;
    const Mat3 R = random_rotation(random);
    constexpr double kStep = 1e-5;  // [s]
    // Of a point that starts at the origin, after t: rotation about w, and the way it went to second order.
    const auto momentum_W = [&](double t) {
      const Vec3 w = twist.tail<3>();
      const Mat3 R_t = R * Eigen::AngleAxisd(t * w.norm(), w.normalized()).toRotationMatrix();
      const Vec3 v = twist.head<3>();
      const Vec3 way_W = R * (t * v + 0.5 * t * t * w.cross(v));
      const Vec3 p_W = R_t * momentum.head<3>();
      Vec6 about_origin;
      about_origin << p_W, R_t * momentum.tail<3>() + way_W.cross(p_W);
      return about_origin;
    };
    const Vec6 rate_W = (momentum_W(kStep) - momentum_W(-kStep)) / (2.0 * kStep);
    const Vec6 terms = coriolis_matrix(mass, twist) * twist;
    Vec6 terms_W;
    terms_W << R * terms.head<3>(), R * terms.tail<3>();
    EXPECT_LE((terms_W - rate_W).norm(), 1e-8 * (1.0 + rate_W.norm()));
  }
}

TEST(Spatial, CoriolisMatrixIsSkewAndItsDerivativeExact) {
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    const Mat6 mass = random_semidefinite(random);
    const Vec6 twist = random_vec6(random);
    const Mat6 coriolis = coriolis_matrix(mass, twist);
    EXPECT_EQ((coriolis + coriolis.transpose()).norm(), 0.0);
    // The terms are quadratic, so that central differences are exact but for rounding.
    const Vec6 direction = random_vec6(random);
    const auto terms = [&](const Vec6& at) { return Vec6(coriolis_matrix(mass, at) * at); };
    const Vec6 difference = 0.5 * (terms(twist + direction) - terms(twist - direction));
    EXPECT_LE((coriolis_derivative(mass, twist) * direction - difference).norm(), 1e-13 * mass.norm());
  }
}

}  // namespace
}  // namespace buoyancy
