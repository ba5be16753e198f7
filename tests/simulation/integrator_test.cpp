#include "simulation/integrator.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "geometry/rotation_between.h"

namespace buoyancy {
namespace {

constexpr Integrator kBoth[] = {Integrator::kSemiImplicitEuler, Integrator::kVelocityVerlet};

RigidBody body_with_inertia(const Vec3& ascending) {
  RigidBody body;
  body.mass = 1.5;
  body.principal_inertia = ascending;
  // Principal axes that differ from the axes of B.
  body.principal_axes_B = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  return body;
}

RigidBodyState tumbling() {
  RigidBodyState state;
  state.q_WB = Eigen::AngleAxisd(0.4, Vec3(3, -1, 2).normalized());
  state.angular_momentum_W = {0.8, -1.1, 0.5};
  return state;
}

double rotational_energy(const RigidBody& body, const RigidBodyState& state) {
  return 0.5 * state.angular_momentum_W.dot(angular_velocity_W(body, state));
}

// Angle between two attitudes [rad].
double angle_between(const RigidBodyState& a, const RigidBodyState& b) {
  return a.q_WB.angularDistance(b.q_WB);
}

// Springs that pull the centre to W's origin and the body's x axis towards W's z axis; both are conservative.
constexpr double kSpring = 7.0;  // [N/m]
constexpr double kTwist = 1.3;   // [N m]

Vec3 pointer_W(const RigidBodyState& state) {
  return state.q_WB * Vec3::UnitX();
}
Load spring_load(const RigidBodyState& state) {
  return {-kSpring * state.center_W, kTwist * pointer_W(state).cross(Vec3::UnitZ())};
}
double spring_energy(const RigidBody& body, const RigidBodyState& state) {
  return kinetic_energy(body, state) + 0.5 * kSpring * state.center_W.squaredNorm() -
         kTwist * pointer_W(state).z();
}

void step_on_springs(Integrator integrator, const RigidBody& body, double step, RigidBodyState& state) {
  begin_step(integrator, body, spring_load(state), step, state);
  finish_step(integrator, body, spring_load(state), step, state);
}

RigidBodyState after(double time, std::int64_t steps, Integrator integrator, const RigidBody& body,
                     RigidBodyState state) {
  for (std::int64_t i = 0; i < steps; ++i) {
    step_on_springs(integrator, body, time / static_cast<double>(steps), state);
  }
  return state;
}

RigidBodyState displaced() {
  RigidBodyState state = tumbling();
  state.center_W = {0.2, -0.1, 0.3};
  state.velocity_W = {0.5, 0.4, -0.2};
  return state;
}

double distance(const RigidBodyState& a, const RigidBodyState& b) {
  return (a.center_W - b.center_W).norm() + (a.velocity_W - b.velocity_W).norm() + angle_between(a, b) +
         (a.angular_momentum_W - b.angular_momentum_W).norm();
}

// Exponent p of h in the error over one second, from two step sizes. The error is C h^p + O(h^(p+1)), so that
// the slope is within a few per cent of p.
double observed_order(Integrator integrator, const RigidBody& body) {
  const RigidBodyState start = displaced();
  const RigidBodyState reference = after(1.0, 200000, Integrator::kVelocityVerlet, body, start);
  const double coarse = distance(after(1.0, 200, integrator, body, start), reference);
  const double fine = distance(after(1.0, 400, integrator, body, start), reference);
  return std::log2(coarse / fine);
}

TEST(FreeRotation, MatchesClosedFormForSymmetricTop) {
  for (const Vec3& inertia : {Vec3(1, 1, 1.8), Vec3(0.3, 2, 2), Vec3(1, 1, 1)}) {
    const RigidBody body = body_with_inertia(inertia);
    const int symmetry_axis = inertia[0] == inertia[1] ? 2 : 0;
    const double transverse = inertia[1];
    const Vec3 symmetry_axis_B = body.principal_axes_B.col(symmetry_axis);
    const RigidBodyState start = tumbling();
    const Vec3 momentum_W = start.angular_momentum_W;

    RigidBodyState state = start;
    for (int i = 0; i < 1000; ++i) integrate_free_rotation(body, 0.05, state);

    // The symmetry axis precesses about L at |L|/I_transverse; the body spins about it at L_axis (1/I_axis -
    // 1/I_transverse).
    const double time = 50.0;
    const Eigen::Quaterniond precession(
        Eigen::AngleAxisd(time * momentum_W.norm() / transverse, momentum_W.normalized()));
    const double axial = momentum_W.dot(start.q_WB * symmetry_axis_B);
    const Eigen::Quaterniond spin(
        Eigen::AngleAxisd(time * axial * (1.0 / inertia[symmetry_axis] - 1.0 / transverse), symmetry_axis_B));
    EXPECT_LT(state.q_WB.angularDistance(precession * start.q_WB * spin), 1e-11) << inertia.transpose();
  }
}

TEST(FreeRotation, ConservesMomentumAndEnergyOverOneMillionSteps) {
  const RigidBody body = body_with_inertia({0.6, 1.1, 1.9});
  RigidBodyState state = tumbling();
  const Vec3 momentum_W = state.angular_momentum_W;
  const double energy = rotational_energy(body, state);
  double early_error = 0.0;
  double max_error = 0.0;
  for (int i = 0; i < 1000000; ++i) {
    integrate_free_rotation(body, 0.05, state);
    max_error = std::max(max_error, std::abs(rotational_energy(body, state) / energy - 1.0));
    if (i == 2000) early_error = max_error;
  }
  EXPECT_EQ(state.angular_momentum_W, momentum_W);
  EXPECT_NEAR(state.q_WB.norm(), 1.0, 1e-15);
  EXPECT_GT(early_error, 0.0);
  EXPECT_LT(early_error, 1e-3);
  EXPECT_LT(max_error, 1.05 * early_error);
}

TEST(FreeRotation, ConvergesWithOrderTwoForAsymmetricBody) {
  const RigidBody body = body_with_inertia({0.6, 1.1, 1.9});
  const auto turned = [&](int steps) {
    RigidBodyState state = tumbling();
    for (int i = 0; i < steps; ++i) integrate_free_rotation(body, 5.0 / steps, state);
    return state;
  };
  const RigidBodyState reference = turned(100000);
  EXPECT_NEAR(std::log2(angle_between(turned(250), reference) / angle_between(turned(500), reference)), 2.0,
              0.02);
}

TEST(FreeRotation, FlipsBodyThatSpinsAboutIntermediateAxis) {
  // Intermediate axis theorem: a nearly pure spin about this axis flips again and again.
  const RigidBody body = body_with_inertia({0.5, 1.0, 1.5});
  RigidBodyState state;
  const Vec3 middle_W = body.principal_axes_B.col(1);
  state.angular_momentum_W = middle_W + 1e-3 * body.principal_axes_B.col(0);
  double min_cosine = 1.0;
  for (int i = 0; i < 3000; ++i) {
    integrate_free_rotation(body, 0.01, state);
    min_cosine = std::min(min_cosine, middle_W.dot(state.q_WB * body.principal_axes_B.col(1)));
  }
  EXPECT_LT(min_cosine, -0.99);
}

TEST(Integrator, MatchesClosedFormOnHarmonicOscillator) {
  // For x'' = -w^2 x both integrators satisfy x_(n+1) - 2 cos(phi) x_n + x_(n-1) = 0 with cos(phi) = 1 -
  // (w h)^2 / 2; they differ in x_1. The body does not rotate: the pointer is upright.
  RigidBody body = body_with_inertia({1, 2, 3});
  const double step = 0.2;
  const double wh = std::sqrt(kSpring / body.mass) * step;
  const double phi = std::acos(1.0 - 0.5 * wh * wh);
  for (const Integrator integrator : kBoth) {
    RigidBodyState state;
    state.q_WB = rotation_between(Vec3::UnitX(), Vec3::UnitZ());
    state.center_W = {0, 0, 0.5};
    const double first =
        integrator == Integrator::kVelocityVerlet ? 0.5 * (1.0 - 0.5 * wh * wh) : 0.5 * (1.0 - wh * wh);
    const double sine = (first - 0.5 * std::cos(phi)) / std::sin(phi);
    for (int n = 1; n <= 1000; ++n) {
      step_on_springs(integrator, body, step, state);
      ASSERT_NEAR(state.center_W.z(), 0.5 * std::cos(n * phi) + sine * std::sin(n * phi), 1e-11)
          << to_string(integrator) << " step " << n;
    }
  }
}

TEST(Integrator, ConvergesWithOrderOneOrTwo) {
  const RigidBody body = body_with_inertia({0.6, 1.1, 1.9});
  EXPECT_NEAR(observed_order(Integrator::kSemiImplicitEuler, body), 1.0, 0.03);
  EXPECT_NEAR(observed_order(Integrator::kVelocityVerlet, body), 2.0, 0.03);
}

TEST(Integrator, KeepsOrderUnderDamping) {
  RigidBody body = body_with_inertia({0.6, 1.1, 1.9});
  body.linear_damping = {1.0, 2.0};
  body.angular_damping = {0.4, 1.5};
  EXPECT_NEAR(observed_order(Integrator::kSemiImplicitEuler, body), 1.0, 0.03);
  EXPECT_NEAR(observed_order(Integrator::kVelocityVerlet, body), 2.0, 0.03);
}

TEST(Integrator, BoundsEnergyErrorOverOneMillionSteps) {
  const RigidBody body = body_with_inertia({0.6, 1.1, 1.9});
  for (const Integrator integrator : kBoth) {
    RigidBodyState state = displaced();
    const double start = spring_energy(body, state);
    double early = 0.0;
    double late = 0.0;
    for (int i = 0; i < 1000000; ++i) {
      step_on_springs(integrator, body, 0.02, state);
      const double error = std::abs(spring_energy(body, state) - start);
      if (i < 100000) early = std::max(early, error);
      if (i >= 900000) late = std::max(late, error);
    }
    const double order_of_error = integrator == Integrator::kVelocityVerlet ? 5e-3 : 1e-1;
    EXPECT_LT(early, order_of_error) << to_string(integrator);
    EXPECT_LT(late, 1.1 * early) << to_string(integrator);
  }
}

TEST(Damping, MatchesClosedFormOfLinearAndQuadraticResistance) {
  const double time = 0.8;
  for (const Damping& damping : {Damping{2.0, 0.0}, Damping{0.0, 3.0}, Damping{2.0, 3.0}, Damping{}}) {
    RigidBody body = body_with_inertia({0.4, 0.4, 0.4});
    body.linear_damping = body.angular_damping = damping;
    RigidBodyState state = tumbling();
    state.velocity_W = {3, -4, 12};
    const RigidBodyState start = state;
    apply_damping(body, time, state);

    // s' = -(a + b s) s: s = a s0 e^(-a t) / (a + b s0 (1 - e^(-a t))), s0 / (1 + b s0 t) for a = 0.
    const auto final_speed = [&](double speed, double inertia) {
      const double a = damping.linear / inertia;
      const double b = damping.quadratic / inertia;
      if (a == 0.0) return speed / (1.0 + b * speed * time);
      return a * speed * std::exp(-a * time) / (a + b * speed * (1.0 - std::exp(-a * time)));
    };
    const Vec3 velocity_W = start.velocity_W.normalized() * final_speed(13.0, body.mass);
    EXPECT_LT((state.velocity_W - velocity_W).norm(), 1e-13);
    const double spin = start.angular_momentum_W.norm() / 0.4;
    const Vec3 momentum_W = start.angular_momentum_W.normalized() * 0.4 * final_speed(spin, 0.4);
    EXPECT_LT((state.angular_momentum_W - momentum_W).norm(), 1e-14);
  }
}

TEST(Damping, NeverOvershoots) {
  for (const double scale : {1.0, 1e6, 1e12, 1e100}) {
    RigidBody body = body_with_inertia({1e-3, 1.0, 50.0});
    body.linear_damping = body.angular_damping = {scale, scale};
    for (const Integrator integrator : kBoth) {
      RigidBodyState state = displaced();
      double energy = spring_energy(body, state);
      for (int i = 0; i < 200; ++i) {
        const RigidBodyState before = state;
        apply_damping(body, 0.1, state);
        ASSERT_GE(state.velocity_W.dot(before.velocity_W), 0.0);
        ASSERT_LE(state.velocity_W.norm(), before.velocity_W.norm());
        ASSERT_GE(rotational_energy(body, before) * (1 + 1e-12), rotational_energy(body, state));
        step_on_springs(integrator, body, 0.01, state);
        ASSERT_TRUE(state.center_W.allFinite() && state.q_WB.coeffs().allFinite());
      }
      EXPECT_LE(spring_energy(body, state), energy);
    }
  }
}

TEST(Damping, ReachesTerminalSpeed) {
  // m g = c v + d v^2 with m g = 6, c = 1, d = 2: v = 1.5 m/s.
  RigidBody body;
  body.mass = 0.6;
  body.linear_damping = {1.0, 2.0};
  const Load weight{{0, 0, -6}, Vec3::Zero()};
  RigidBodyState state;
  const double step = 1e-3;
  for (int i = 0; i < 5000; ++i) {
    begin_step(Integrator::kVelocityVerlet, body, weight, step, state);
    finish_step(Integrator::kVelocityVerlet, body, weight, step, state);
  }
  EXPECT_NEAR(state.velocity_W.z(), -1.5, 1e-4);
}

TEST(Integrator, ParsesItsOwnNames) {
  for (const Integrator integrator : kBoth)
    EXPECT_EQ(integrator_from_name(to_string(integrator)), integrator);
  EXPECT_EQ(integrator_from_name("runge_kutta"), std::nullopt);
}

}  // namespace
}  // namespace buoyancy
