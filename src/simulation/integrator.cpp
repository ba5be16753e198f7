#include "simulation/integrator.h"

#include <cmath>

namespace buoyancy {
namespace {

// Exponential map of a rotation vector [rad].
Eigen::Quaterniond rotation(const Vec3& angle) {
  const double norm = angle.norm();
  if (norm == 0.0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(norm, angle / norm));
}

void kick(const RigidBody& body, const Load& load, double time, RigidBodyState& state) {
  state.velocity_W += time / body.mass * load.force_W;
  state.angular_momentum_W += time * load.torque_W;
}

void drift(const RigidBody& body, double time, RigidBodyState& state) {
  state.center_W += time * state.velocity_W;
  integrate_free_rotation(body, time, state);
}

// Returns the path length of a damped motion, on which the quadratic resistance depends: the integral of s
// over `time` for ds/dt = -(linear + quadratic s) s / inertia with s(0) = speed.
double damped_path(const Damping& damping, double inertia, double speed, double time) {
  const double rate = damping.linear / inertia;
  const double linear_path = speed * (rate > 0.0 ? -std::expm1(-rate * time) / rate : time);
  const double quadratic = damping.quadratic / inertia;
  return quadratic > 0.0 ? std::log1p(quadratic * linear_path) / quadratic : linear_path;
}

void damp_velocity(const RigidBody& body, double time, RigidBodyState& state) {
  const Damping& damping = body.linear_damping;
  if (damping.linear == 0.0 && damping.quadratic == 0.0) return;
  const double path = damped_path(damping, body.mass, state.velocity_W.norm(), time);
  state.velocity_W *= std::exp(-(damping.linear * time + damping.quadratic * path) / body.mass);
}

void damp_rotation(const RigidBody& body, double time, RigidBodyState& state) {
  const Damping& damping = body.angular_damping;
  if (damping.linear == 0.0 && damping.quadratic == 0.0) return;
  const Vec3 momentum_P =
      body.principal_axes_B.transpose() * (state.q_WB.conjugate() * state.angular_momentum_W);
  const Vec3 w_P = momentum_P.cwiseQuotient(body.principal_inertia);
  const double speed_squared = w_P.squaredNorm();
  if (speed_squared == 0.0) return;
  // The effective inertia of the initial decay of |w|: d|w|/dt = -(c + d |w|) |w| / inertia.
  const double inertia = speed_squared / w_P.cwiseProduct(w_P).cwiseQuotient(body.principal_inertia).sum();
  const double path = damped_path(damping, inertia, std::sqrt(speed_squared), time);
  const Vec3 decay =
      (-(damping.linear * time + damping.quadratic * path) * body.principal_inertia.cwiseInverse())
          .array()
          .exp();
  state.angular_momentum_W = state.q_WB * Vec3(body.principal_axes_B * momentum_P.cwiseProduct(decay));
}

}  // namespace

std::string_view to_string(Integrator integrator) {
  return integrator == Integrator::kSemiImplicitEuler ? "semi_implicit_euler" : "velocity_verlet";
}

std::optional<Integrator> integrator_from_name(std::string_view text) {
  for (const Integrator integrator : {Integrator::kSemiImplicitEuler, Integrator::kVelocityVerlet}) {
    if (to_string(integrator) == text) return integrator;
  }
  return std::nullopt;
}

void integrate_free_rotation(const RigidBody& body, double time, RigidBodyState& state) {
  // The kinetic energy is split about the middle inertia I_1: L.L/(2 I_1) + L_0^2/2 (1/I_0 - 1/I_1) +
  // L_2^2/2 (1/I_2 - 1/I_1). The first term generates a rotation about L, which commutes with the others;
  // each of the others generates a rotation about its axis, and one of them vanishes where two inertias are
  // equal.
  const Vec3 inverse = body.principal_inertia.cwiseInverse();
  const auto turn_about_axis = [&](int i, double seconds) {
    const Vec3 axis_B = body.principal_axes_B.col(i);
    const double momentum = axis_B.dot(state.q_WB.conjugate() * state.angular_momentum_W);
    state.q_WB = state.q_WB * rotation(seconds * momentum * (inverse[i] - inverse[1]) * axis_B);
  };
  turn_about_axis(0, 0.5 * time);
  turn_about_axis(2, time);
  turn_about_axis(0, 0.5 * time);
  state.q_WB = rotation(time * inverse[1] * state.angular_momentum_W) * state.q_WB;
  state.q_WB.normalize();
}

void apply_damping(const RigidBody& body, double time, RigidBodyState& state) {
  damp_velocity(body, time, state);
  damp_rotation(body, time, state);
}

void begin_step(Integrator integrator, const RigidBody& body, const Load& load, double step,
                RigidBodyState& state) {
  apply_damping(body, 0.5 * step, state);
  if (integrator == Integrator::kSemiImplicitEuler) {
    kick(body, load, step, state);
    apply_damping(body, 0.5 * step, state);
  } else {
    kick(body, load, 0.5 * step, state);
  }
  drift(body, step, state);
}

void finish_step(Integrator integrator, const RigidBody& body, const Load& load, double step,
                 RigidBodyState& state) {
  if (integrator == Integrator::kSemiImplicitEuler) return;
  kick(body, load, 0.5 * step, state);
  apply_damping(body, 0.5 * step, state);
}

}  // namespace buoyancy
