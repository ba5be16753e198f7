// Tests the motion of a body with added mass against Kirchhoff's equations in axes that turn with the body.
#include "hydrodynamics/coupled_mass.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "hydrodynamics/linear_algebra.h"
#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

// A body with arbitrary centres, inertia and motion; its added mass is up to fifty times its mass.
struct RandomBody {
  explicit RandomBody(std::mt19937& random) {
    const Mat6 definite = random_definite(random);
    body.mass = {0.2 + definite(0, 0), random_vec3(random), definite.topLeftCorner<3, 3>()};
    body.reference_B = random_vec3(random);
    body.motion = {random_rotation(random), random_vec3(random), random_vec3(random)};
    added_B = random_definite(random);
    added_B *= 25.0 * (1.0 + random_number(random));
    body.water.added_mass_W = rotated(added_B, body.motion.R_WB);
    wrench_W = 10.0 * random_vec6(random);
  }

  // The twist of the reference point in the body's axes.
  Vec6 twist_B() const {
    Vec6 twist;
    twist.tail<3>() = body.motion.R_WB.transpose() * body.motion.angular_velocity_W;
    twist.head<3>() =
        body.motion.R_WB.transpose() * body.motion.velocity_W + twist.tail<3>().cross(body.reference_B);
    return twist;
  }
  Mat6 mass_B() const { return mass_matrix_W(body.mass, Mat3::Identity(), body.reference_B); }

  CoupledBody body;
  Mat6 added_B;
  Vec6 wrench_W;
};

Vec6 in_axes(const Mat3& R, const Vec6& vector) {
  Vec6 turned;
  turned << R * vector.head<3>(), R * vector.tail<3>();
  return turned;
}

TEST(CoupledMass, GivesKineticEnergyOfAllParticles) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const CoupledBody body = RandomBody(random).body;
    const Vec3 point_B = random_vec3(random);
    const Mat3& R = body.motion.R_WB;
    const Vec3& w = body.motion.angular_velocity_W;
    Vec6 twist;
    twist << body.motion.velocity_W + w.cross(R * point_B), w;
    const Vec3 v_center = body.motion.velocity_W + w.cross(R * body.mass.center_of_mass_B);
    const Vec3 w_B = R.transpose() * w;
    const double energy = body.mass.mass * v_center.squaredNorm() + w_B.dot(body.mass.inertia_B * w_B);
    EXPECT_NEAR(twist.dot(mass_matrix_W(body.mass, R, point_B) * twist), energy, 1e-12 * energy);
  }
}

TEST(CoupledMass, FollowsKirchhoffsEquations) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    RandomBody random_body(random);
    const CoupledBody& body = random_body.body;
    const Mat3& R = body.motion.R_WB;
    const Vec6 nu = random_body.twist_B();
    const Mat6 total = random_body.mass_B() + random_body.added_B;
    const Vec6 own_B = in_axes(R.transpose(), random_body.wrench_W);
    const Vec6 nu_dot = solve(total, Vec6(own_B - coriolis_matrix(total, nu) * nu));
    // What the service sends contains the Coriolis term of the added mass.
    const Vec6 sent_W = random_body.wrench_W - in_axes(R, coriolis_matrix(random_body.added_B, nu) * nu);

    const Vec6 acceleration = coupled_acceleration(body, sent_W);
    Vec6 expected = in_axes(R, nu_dot);
    expected.head<3>() += body.motion.angular_velocity_W.cross(R * nu.head<3>());
    EXPECT_LT((acceleration - expected).norm(), 1e-9 * (1.0 + expected.norm()));
  }
}

TEST(CoupledMass, CompensatedWrenchMovesBodyWithoutAddedMassAlike) {
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    RandomBody random_body(random);
    random_body.body.water.damping_W = random_definite(random);
    CoupledBody alone = random_body.body;
    alone.water = {};
    for (const double step : {0.0, 0.01}) {
      const Vec6 expected = coupled_acceleration(random_body.body, random_body.wrench_W, step);
      const Vec6 compensated = compensated_wrench(random_body.body, random_body.wrench_W, step);
      const Vec3 lever = alone.motion.R_WB * (alone.reference_B - alone.mass.center_of_mass_B);
      const Vec6 acceleration = coupled_acceleration(alone, wrench_about(compensated, lever));
      EXPECT_LT((acceleration - expected).norm(), 1e-9 * (1.0 + expected.norm())) << step;
    }
  }
}

TEST(CoupledMass, ImplicitStepUsesDerivativeOfAllVelocityTerms) {
  std::mt19937 random(5);
  for (int i = 0; i < 100; ++i) {
    RandomBody random_body(random);
    CoupledBody& body = random_body.body;
    body.reference_B = body.mass.center_of_mass_B;
    body.water.damping_W = random_mat6(random);
    // The wrench is linear in the velocities about the reference point, with the body's damping.
    const auto acceleration_at = [&](const Vec6& change) {
      CoupledBody moved = body;
      const Vec3 dw = change.tail<3>();
      moved.motion.angular_velocity_W += dw;
      moved.motion.velocity_W += change.head<3>() - dw.cross(body.motion.R_WB * body.reference_B);
      return coupled_acceleration(moved, random_body.wrench_W - body.water.damping_W * change);
    };
    // (1 - h J) a = f, with J from central differences, which are exact for quadratic functions.
    const double step = 1e-2;
    const double change = 0.1;
    Mat6 left = Mat6::Identity();
    for (Eigen::Index k = 0; k < 6; ++k) {
      const Vec6 unit = change * Vec6::Unit(k);
      left.col(k) -= step / (2.0 * change) * (acceleration_at(unit) - acceleration_at(-unit));
    }
    const Vec6 expected = solve(left, acceleration_at(Vec6::Zero()));
    const Vec6 implicit = coupled_acceleration(body, random_body.wrench_W, step);
    EXPECT_LT((implicit - expected).norm(), 1e-8 * (1.0 + expected.norm())) << i;
  }
}

TEST(CoupledMass, WeightDoesNotActOnAddedMass) {
  CoupledBody body;
  body.mass = {2.0, {0.1, 0.0, 0.0}, Mat3::Identity()};
  body.water.added_mass_W.diagonal().setConstant(1000.0);
  const Vec6 weight = weight_W(body, {0.0, 0.0, -10.0});
  EXPECT_EQ(weight.head<3>(), Vec3(0.0, 0.0, -20.0));
  EXPECT_EQ(weight.tail<3>(), Vec3(0.0, 2.0, 0.0));
}

}  // namespace
}  // namespace buoyancy
