// The simulator's steps for bodies with drag and added mass: against an independent solution of the equations
// of motion, their order, and what late responses and a current change.
#include "simulation/hydrodynamic_motion.h"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "hydrodynamics/linear_algebra.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

// A heavy body under water, with every coefficient and all centres apart.
std::string tumbling(double height, const std::string& more = "") {
  return R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 0.6, 0.4] }
reference_point = [0.3, -0.2, 0.1]
[body.drag]
linear    = [30, 90, 120, 8, 9, 7]
quadratic = [60, 300, 350, 20, 25, 15]
center    = [-0.1, 0.05, 0.02]
[body.added_mass]
matrix = [ 60,  5,   0,  0,  3,  2,
            5, 200,  8,  2,  0,  9,
            0,   8, 300, 1, -9,  0,
            0,   2,   1, 12, 0,  1,
            3,   0,  -9,  0, 30, 0,
            2,   9,   0,  1,  0, 25]
center = [0.05, 0, 0.04]
[body.client]
mass           = 300
center_of_mass = [0.02, 0.03, -0.05]
inertia        = [15, 30, 40, 1, -2, 0.5]
orientation    = [0.9, 0.3, -0.2, 0.1]
angular_velocity = [0.4, -0.6, 0.8]
)" + more +
         "position = [0, 0, " + std::to_string(height) + "]\n";
}

RigidBodyState state_after(const Scene& scene, const SimulationOptions& options, std::int64_t steps) {
  return simulation_after(scene, options, steps).bodies().front().state;
}

double distance(const RigidBodyState& a, const RigidBodyState& b) {
  return (a.center_W - b.center_W).norm() + (a.velocity_W - b.velocity_W).norm() +
         a.q_WB.angularDistance(b.q_WB) + 0.01 * (a.angular_momentum_W - b.angular_momentum_W).norm();
}

// Kirchhoff's equations of a fully submerged body, by the classical Runge-Kutta method, in the axes of the
// body about its centre of mass.
class Submerged {
 public:
  explicit Submerged(const Scene& scene) : water_(scene.water()) {
    const Simulation simulation = simulation_of(scene, {});
    const SimulatedBody& simulated = simulation.bodies().front();
    const Body& body = *simulated.body;
    rigid_ = simulated.rigid;
    state_ = simulated.state;
    drag_ = *body.hydrodynamics->coefficients().drag;
    const AddedMassCoefficients& added = *body.hydrodynamics->coefficients().added_mass;
    Mat6 mass = Mat6::Zero();
    mass.diagonal().head<3>().setConstant(rigid_.mass);
    mass.bottomRightCorner<3, 3>() =
        rigid_.principal_axes_B * rigid_.principal_inertia.asDiagonal() * rigid_.principal_axes_B.transpose();
    inertia_B_ = mass.bottomRightCorner<3, 3>();
    total_ = mass + matrix_at(added.matrix, rigid_.center_of_mass_B - added.center_B);
    volume_ = body.prepared_mesh->mass_properties.volume;
    centroid_B_ = body.prepared_mesh->mass_properties.centroid_B;
    twist_ << state_.q_WB.conjugate() * state_.velocity_W,
        state_.q_WB.conjugate() * angular_velocity_W(rigid_, state_);
  }

  RigidBodyState after(double time, int steps) {
    const double h = time / steps;
    for (int i = 0; i < steps; ++i) {
      const Rates k1 = rates(state_.center_W, state_.q_WB.coeffs(), twist_);
      const Rates k2 = rates_at(k1, 0.5 * h);
      const Rates k3 = rates_at(k2, 0.5 * h);
      const Rates k4 = rates_at(k3, h);
      state_.center_W += h / 6.0 * (k1.center + 2.0 * k2.center + 2.0 * k3.center + k4.center);
      state_.q_WB.coeffs() += h / 6.0 * (k1.q + 2.0 * k2.q + 2.0 * k3.q + k4.q);
      state_.q_WB.normalize();
      twist_ += h / 6.0 * (k1.twist + 2.0 * k2.twist + 2.0 * k3.twist + k4.twist);
    }
    state_.velocity_W = state_.q_WB * Vec3(twist_.head<3>());
    state_.angular_momentum_W = state_.q_WB * Vec3(inertia_B_ * twist_.tail<3>());
    return state_;
  }

 private:
  struct Rates {
    Vec3 center;
    Eigen::Vector4d q;
    Vec6 twist;
  };

  Rates rates_at(const Rates& k, double h) const {
    return rates(state_.center_W + h * k.center, state_.q_WB.coeffs() + h * k.q, twist_ + h * k.twist);
  }

  Rates rates(const Vec3& /*center*/, const Eigen::Vector4d& coefficients, const Vec6& twist) const {
    const Eigen::Quaterniond q = Eigen::Quaterniond(coefficients).normalized();
    const Vec3 up_B = q.conjugate() * water_.up_W;
    const double lift = water_.density * water_.gravity * volume_;
    const Vec3 buoyancy = lift * up_B;
    Vec6 force;
    force << buoyancy - rigid_.mass * water_.gravity * up_B,
        (centroid_B_ - rigid_.center_of_mass_B).cross(buoyancy);
    const Vec3 lever = rigid_.center_of_mass_B - drag_.center_B;
    const Vec6 nu = twist_at(twist, -lever);
    force -= wrench_about(drag_.linear * nu + drag_.quadratic * nu.cwiseAbs().cwiseProduct(nu), lever);
    force -= coriolis_matrix(total_, twist) * twist;
    const Vec3 w = twist.tail<3>();
    return {q * Vec3(twist.head<3>()), 0.5 * (q * Eigen::Quaterniond(0.0, w.x(), w.y(), w.z())).coeffs(),
            solve(total_, force)};
  }

  Water water_;
  RigidBody rigid_;
  RigidBodyState state_;
  DragCoefficients drag_;
  Mat3 inertia_B_ = Mat3::Zero();
  Mat6 total_ = Mat6::Zero();
  double volume_ = 0.0;
  Vec3 centroid_B_ = Vec3::Zero();
  Vec6 twist_ = Vec6::Zero();
};

TEST(HydrodynamicMotion, FollowsKirchhoffsEquationsWithItsOrder) {
  const Scene scene = scene_of(tumbling(-50.0));
  const RigidBodyState expected = Submerged(scene).after(2.0, 4000);
  for (const Integrator integrator : kBothIntegrators) {
    const double coarse =
        distance(state_after(scene, {.step = 0.02, .integrator = integrator}, 100), expected);
    const double fine = distance(state_after(scene, {.step = 0.01, .integrator = integrator}, 200), expected);
    const bool verlet = integrator == Integrator::kVelocityVerlet;
    EXPECT_LT(fine, verlet ? 2e-3 : 5e-2);
    EXPECT_NEAR(std::log2(coarse / fine), verlet ? 2.0 : 1.0, 0.15) << to_string(integrator);
  }
}

TEST(HydrodynamicMotion, ConvergesWithOrderTwoThroughTheSurface) {
  // The immersion changes, and with it the added mass.
  const Scene scene = scene_of(tumbling(0.15, "linear_velocity = [0.5, 0.2, -1]\n"));
  const auto after = [&](int steps) { return state_after(scene, {.step = 0.5 / steps}, steps); };
  const RigidBodyState reference = after(16'000);
  EXPECT_NEAR(std::log2(distance(after(500), reference) / distance(after(1000), reference)), 2.0, 0.2);
}

TEST(HydrodynamicMotion, IsTheSameRelativeToACurrent) {
  const Vec3 current(0.5, -0.3, 0.1);
  const Scene still = scene_of(tumbling(-50.0));
  const Scene moving = scene_of("[water.current]\nvelocity = [0.5, -0.3, 0.1]\n" +
                                tumbling(-50.0, "linear_velocity = [0.5, -0.3, 0.1]\n"));
  for (const Integrator integrator : kBothIntegrators) {
    const RigidBodyState expected = state_after(still, {.step = 0.01, .integrator = integrator}, 300);
    RigidBodyState relative = state_after(moving, {.step = 0.01, .integrator = integrator}, 300);
    relative.velocity_W -= current;
    relative.center_W -= 3.0 * current;
    EXPECT_LT(distance(relative, expected), 1e-10) << to_string(integrator);
  }
}

TEST(HydrodynamicMotion, SubtractsTheDragOfLateResponsesAtTheTwistThatWasSent) {
  // The buoyancy of this body is the same at every pose: without its drag, a late response is as good as its
  // own.
  const Scene scene = scene_of(R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 0.6, 0.4] }
[body.drag]
linear    = [30, 90, 120, 8, 9, 7]
quadratic = [60, 300, 350, 20, 25, 15]
[body.added_mass]
matrix = [60, 200, 300, 12, 30, 25]
[body.client]
density = 1500
position = [0, 0, -50]
linear_velocity = [1, 0.5, 0]
angular_velocity = [0.4, -0.6, 0.8]
)");
  for (const Integrator integrator : kBothIntegrators) {
    SimulationOptions options{.step = 0.01, .integrator = integrator};
    const RigidBodyState expected = state_after(scene, options, 300);
    options.delay_steps = 7;
    EXPECT_LT(distance(state_after(scene, options, 300), expected), 1e-10) << to_string(integrator);
    options.lead_time = 0.07;
    EXPECT_LT(distance(state_after(scene, options, 300), expected), 1e-10) << to_string(integrator);
  }
}

TEST(HydrodynamicMotion, KeepsEnergyOfUndampedBodyThatDipsInAndOut) {
  // A ball with four times its mass as added mass that bobs by more than its radius: without S, it would gain
  // or lose most of its energy at once.
  const Scene scene = scene_of(R"(
[[body]]
id = 1
shape = { type = "sphere", radius = 0.5, segments = 16 }
[body.added_mass]
matrix = [800, 800, 800, 0, 0, 0]
[body.client]
density = 400
position = [0, 0, 0.7]
linear_velocity = [1, 0, 0]
)");
  Simulation simulation = simulation_of(scene, {.step = 0.002});
  run_in_process(scene, simulation, 50'000);
  const EnergyStats& energy = simulation.bodies().front().energy;
  EXPECT_LT(energy.max - energy.min, 0.01 * energy.max_kinetic);
}

TEST(HydrodynamicMotion, ActsOnDampingOfTheClientLikeDrag) {
  const std::string body = R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 0.6, 0.4] }
[body.added_mass]
matrix = [60, 200, 300, 0, 0, 0]
)";
  const std::string client =
      "[body.client]\ndensity = 1025\nposition = [0, 0, -50]\nlinear_velocity = [1, 0, 0]\n";
  const Scene damped = scene_of(body + client + "linear_damping = 40\n");
  const Scene dragged = scene_of(body + "[body.drag]\nlinear = [40, 40, 40, 0, 0, 0]\n" + client);
  const SimulationOptions options{.step = 0.01};
  const double velocity = state_after(damped, options, 200).velocity_W.x();
  EXPECT_NEAR(velocity, std::exp(-40.0 * 2.0 / (246.0 + 60.0)), 1e-5);
  EXPECT_NEAR(state_after(dragged, options, 200).velocity_W.x(), velocity, 1e-12);
}

}  // namespace
}  // namespace buoyancy
