#include "hydrodynamics/small_motions.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

Mat6 restoring(std::mt19937& random) {  // heave, roll and pitch alone
  Mat6 stiffness = Mat6::Zero();
  stiffness.block<3, 3>(2, 2) = random_definite(random).block<3, 3>(2, 2);
  return stiffness;
}

constexpr double kDiverged = 1e9;

// The displacement that semi-implicit Euler ends with, over that of the start, from 0 to beyond kDiverged.
double growth(const Mat6& mass, const Mat6& damping, const Mat6& stiffness, double h, std::mt19937& random) {
  constexpr int kSteps = 40000;
  const Mat6 inverse = mass.inverse();
  Vec6 x = random_vec6(random);
  Vec6 v = Vec6::Zero();
  const double start = x.norm();
  for (int n = 0; n < kSteps && x.norm() <= kDiverged * start; ++n) {
    v += h * (inverse * (-stiffness * x - damping * v));
    x += h * v;
  }
  return x.norm() / start;
}

TEST(SmallMotions, UncoupledMotionsHaveTheirOwnFrequencies) {
  const Mat6 mass = Vec6(1.0, 2.0, 3.0, 4.0, 5.0, 6.0).asDiagonal();
  const Mat6 stiffness = Vec6(0.0, 0.0, 30.0, 80.0, 5.0, 0.0).asDiagonal();
  const HeaveRollPitch modes = heave_roll_pitch(mass, stiffness).value();
  EXPECT_DOUBLE_EQ(modes.heave.stiffness, 10.0);
  EXPECT_DOUBLE_EQ(modes.roll.stiffness, 20.0);
  EXPECT_DOUBLE_EQ(modes.pitch.stiffness, 1.0);
  EXPECT_NEAR(std::abs(modes.roll.shape[3]), 0.5, 1e-15) << "shape^T M shape = 1";
  EXPECT_NEAR(damping_ratio(modes.heave, Vec6(0.0, 0.0, 6.0, 0.0, 0.0, 0.0).asDiagonal()),
              6.0 / (2.0 * std::sqrt(30.0 * 3.0)), 1e-15);
}

TEST(SmallMotions, CoupledModesSolveTheEigenproblem) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    const Mat6 mass = random_definite(random);
    const Mat6 stiffness = restoring(random);
    const HeaveRollPitch modes = heave_roll_pitch(mass, stiffness).value();
    for (const MotionMode& mode : {modes.heave, modes.roll, modes.pitch}) {
      const double scale = (stiffness * mode.shape).norm();
      EXPECT_LE((mode.stiffness * mass * mode.shape - stiffness * mode.shape).norm(), 1e-11 * scale);
      EXPECT_NEAR(mode.shape.dot(mass * mode.shape), 1.0, 1e-12);
    }
    EXPECT_NEAR(modes.heave.shape.dot(mass * modes.roll.shape), 0.0, 1e-11);
    EXPECT_NEAR(modes.heave.shape.dot(mass * modes.pitch.shape), 0.0, 1e-11);
    EXPECT_NEAR(modes.roll.shape.dot(mass * modes.pitch.shape), 0.0, 1e-11);
  }
}

TEST(SmallMotions, NamesWeaklyCoupledModesAfterTheirCoordinates) {
  std::mt19937 random(2);
  for (int run = 0; run < 100; ++run) {
    Mat6 mass = Mat6::Identity() + 0.01 * random_semidefinite(random);
    Mat6 stiffness = Mat6::Zero();
    const Vec3 squares = 10.0 * (Vec3::Constant(1.5) + random_vec3(random));
    for (Eigen::Index i = 0; i < 3; ++i) stiffness(2 + i, 2 + i) = squares[i] + static_cast<double>(7 * i);
    const HeaveRollPitch modes = heave_roll_pitch(mass, stiffness).value();
    EXPECT_NEAR(modes.heave.stiffness, stiffness(2, 2), 2.0);
    EXPECT_NEAR(modes.roll.stiffness, stiffness(3, 3), 2.0);
    EXPECT_NEAR(modes.pitch.stiffness, stiffness(4, 4), 2.0);
  }
}

TEST(SmallMotions, UnstableModeHasNegativeStiffness) {
  const Mat6 stiffness = Vec6(0.0, 0.0, 4.0, -2.0, 1.0, 0.0).asDiagonal();
  const HeaveRollPitch modes = heave_roll_pitch(Mat6::Identity(), stiffness).value();
  EXPECT_DOUBLE_EQ(modes.roll.stiffness, -2.0);
  EXPECT_DOUBLE_EQ(modes.heave.stiffness, 4.0);
}

TEST(SmallMotions, QuadraticDragDissipatesAsItsDampingRatioSays) {
  // One period of x = a sin(w t), against the energy that linear damping of that ratio takes.
  const double w = 3.0;
  const double a = 0.2;
  const double D2 = 7.0;
  const double mass = 2.0;
  MotionMode mode;
  mode.stiffness = w * w;
  mode.shape = Vec6::Unit(2) / std::sqrt(mass);
  constexpr int kSteps = 20000;
  double lost = 0.0;
  const double dt = 2.0 * std::numbers::pi / w / kSteps;
  for (int n = 0; n < kSteps; ++n) {
    const double v = a * w * std::cos(w * (n + 0.5) * dt);
    lost += D2 * std::abs(v) * v * v * dt;
  }
  const Mat6 quadratic = Vec6(0.0, 0.0, D2, 0.0, 0.0, 0.0).asDiagonal();
  const double ratio = quadratic_damping_ratio(mode.shape, quadratic, a * std::sqrt(mass));
  EXPECT_NEAR(2.0 * ratio * w * mass * std::numbers::pi * w * a * a, lost, 1e-6 * lost);
}

TEST(SmallMotions, StepLimitOfOneDegreeOfFreedomHasItsClosedForm) {
  const double mass = 3.0;
  for (const double k : {0.0, 0.5, 12.0, 1e6}) {
    for (const double d : {0.0, 0.1, 5.0, 1e5}) {
      if (k == 0.0 && d == 0.0) continue;
      const Mat6 stiffness = Vec6(0.0, 0.0, k, 0.0, 0.0, 0.0).asDiagonal();
      const Mat6 damping = Vec6(0.0, 0.0, d, 0.0, 0.0, 0.0).asDiagonal();
      const double step = max_explicit_step(mass * Mat6::Identity(), damping, stiffness).value();
      const double half = d / (2.0 * mass);  // zeta omega
      EXPECT_NEAR(step * (half + std::sqrt(half * half + k / mass)), 2.0, 1e-12) << k << " " << d;
    }
  }
  EXPECT_EQ(max_explicit_step(Mat6::Identity(), Mat6::Zero(), Mat6::Zero()).value(),
            std::numeric_limits<double>::infinity());
}

TEST(SmallMotions, StepLimitSeparatesDecayFromGrowth) {
  std::mt19937 random(3);
  for (int run = 0; run < 100; ++run) {
    const Mat6 mass = random_definite(random);
    const Mat6 damping = 0.05 * random_semidefinite(random) + 0.01 * Mat6::Identity();
    const Mat6 stiffness = random_semidefinite(random) + 0.01 * Mat6::Identity();
    const double step = max_explicit_step(mass, damping, stiffness).value();
    EXPECT_LT(growth(mass, damping, stiffness, 0.999 * step, random), 100.0) << run;
    EXPECT_GT(growth(mass, damping, stiffness, 1.001 * step, random), kDiverged) << run;
  }
}

TEST(SmallMotions, StepLimitIgnoresDirectionsThatNothingRestores) {
  const Mat6 damping = Vec6(4.0, 0.0, 1.0, 0.0, 0.0, 0.0).asDiagonal();
  const Mat6 stiffness = Vec6(0.0, 0.0, -1000.0, 0.0, 0.0, 0.0).asDiagonal();
  EXPECT_NEAR(max_explicit_step(Mat6::Identity(), damping, stiffness).value(), 0.5, 1e-12);
}

TEST(SmallMotions, MassRatioIsTheLargestOverAllMotions) {
  std::mt19937 random(4);
  for (int run = 0; run < 50; ++run) {
    const Mat6 mass = random_definite(random);
    const Mat6 added = random_semidefinite(random);
    const double ratio = max_mass_ratio(mass, added).value();
    double largest = 0.0;
    Vec6 x = random_vec6(random);
    for (int n = 0; n < 2000; ++n) x = (mass.inverse() * added * x).normalized();
    largest = x.dot(added * x) / x.dot(mass * x);
    EXPECT_NEAR(ratio, largest, 1e-6 * ratio);
  }
}

TEST(SmallMotions, RefusesMassesThatAreNotPositiveDefinite) {
  const Mat6 singular = Vec6(1.0, 1.0, 0.0, 1.0, 1.0, 1.0).asDiagonal();
  EXPECT_FALSE(heave_roll_pitch(singular, Mat6::Identity()));
  EXPECT_FALSE(max_explicit_step(singular, Mat6::Identity(), Mat6::Identity()));
  EXPECT_FALSE(max_mass_ratio(singular, Mat6::Identity()));
  const Mat6 infinite = std::numeric_limits<double>::infinity() * Mat6::Identity();
  EXPECT_FALSE(heave_roll_pitch(infinite, Mat6::Identity()));
}

}  // namespace
}  // namespace buoyancy
