#include "simulation/hydrodynamic_motion.h"

#include <cmath>

#include "engine/load_evaluation.h"
#include "hydrodynamics/linear_algebra.h"
#include "hydrostatics/hydrostatics.h"
#include "messages/conversions.h"

namespace buoyancy {
namespace {

constexpr int kPasses = 3;

bool is_diagonal(const Mat6& matrix) {
  return matrix == Mat6(matrix.diagonal().asDiagonal());
}

// E(time): du/dt = force - damping u.
Vec6 relaxed(const Mat6& damping, const Vec6& force, double time, const Vec6& u) {
  const Mat6 z = time * damping;
  const Vec6 change = time * (force - damping * u);
  const Mat6 denominator = Mat6::Identity() + z + 0.5 * z.lazyProduct(z);
  return u + solve(denominator, Vec6(change + 0.5 * (z * change)));
}

// Q(time): du/dt = -coriolis u.
Vec6 turned(const Mat6& coriolis, double time, const Vec6& u) {
  const Mat6 half = 0.25 * time * (coriolis - coriolis.transpose());
  return 2.0 * solve(Mat6::Identity() + half, u) - u;
}

// Returns a matrix that maps u to the force and dissipates the power force . u if that is positive: the part
// along u resists it equally in all directions, the part across u turns it.
Mat6 dissipating(const Vec6& force, const Vec6& u) {
  const double square = u.squaredNorm();
  if (!(square > 0.0)) return Mat6::Zero();
  const double along = force.dot(u) / square;
  const Vec6 across = (force - along * u) / square;
  const Mat6 outer = across * u.transpose();
  return along * Mat6::Identity() + outer - outer.transpose();
}

// Returns the mean velocity of a screw with this rotation vector [rad], in the axes of its start.
Vec3 screw_velocity(const Vec3& rotation, const Vec3& velocity) {
  const double angle = rotation.norm();
  const double square = angle * angle;
  // The series are exact to rounding below this angle.
  const bool small = angle < 1e-4;
  const double first = small ? 0.5 - square / 24.0 : (1.0 - std::cos(angle)) / square;
  const double second = small ? 1.0 / 6.0 - square / 120.0 : (1.0 - std::sin(angle) / angle) / square;
  const Vec3 across = rotation.cross(velocity);
  return velocity + first * across + second * rotation.cross(across);
}

}  // namespace

HydrodynamicMotion::HydrodynamicMotion(const Body& body, const RigidBody& rigid, const Water& water,
                                       const Current& current)
    : body_(&body),
      rigid_(rigid),
      water_(water),
      current_(current),
      current_W_(current.velocity_W),
      mass_B_(mass_at_center(rigid)),
      added_mass_B_(added_mass_at_center(body, rigid)),
      modes_(rigid, added_mass_B_) {
  const auto& drag = body.hydrodynamics->coefficients().drag;
  quadratic_drag_is_diagonal_ = !drag || is_diagonal(drag->quadratic);
  for (const Damping& damping : {rigid.linear_damping, rigid.angular_damping}) {
    has_damping_ = has_damping_ || damping.linear > 0.0 || damping.quadratic > 0.0;
  }
}

void HydrodynamicMotion::set_rigid_body(const RigidBody& rigid) {
  rigid_ = rigid;
  mass_B_ = mass_at_center(rigid);
  added_mass_B_ = added_mass_at_center(*body_, rigid);
  modes_ = AddedMassModes(rigid, added_mass_B_);
  half_jump_.setZero();
}

HydrodynamicMotion::Immersions HydrodynamicMotion::immersions(double displaced, const Pose& pose) const {
  const double volume = displaced + flooded_volume(rigid_, pose, water_);  // of the hull
  const HydrostaticMesh& mesh = body_->solver.mesh();
  const HydrodynamicCoefficients& coefficients = body_->hydrodynamics->coefficients();
  const auto area = [&] { return wetted_area(mesh, pose, water_).value; };
  Immersions immersions;
  if (coefficients.drag) immersions.drag = immersion_of(coefficients.drag->immersion, mesh, volume, area);
  if (coefficients.added_mass) {
    const ImmersionScaling scaling = coefficients.added_mass->immersion;
    const bool same = coefficients.drag && coefficients.drag->immersion == scaling;
    immersions.added_mass = same ? immersions.drag : immersion_of(scaling, mesh, volume, area);
  }
  return immersions;
}

Vec3 HydrodynamicMotion::current_at(const Water& water, const Pose& pose) const {
  const HydrodynamicCoefficients& coefficients = body_->hydrodynamics->coefficients();
  const Vec3& center_B = coefficients.drag ? coefficients.drag->center_B : coefficients.added_mass->center_B;
  return current_.at(water, pose.p_WB + pose.q_WB.normalized() * center_B);
}

void HydrodynamicMotion::take(const BodyWrench& wrench, const BodyState& sent, double lead_time,
                              const WaterState& water, RigidBodyState& state) {
  still_ = wrench;
  if (wrench.status != BodyStatus::kOk) return;
  const Pose pose = validate_pose(sent, lead_time).pose;
  const Immersions now = immersions(wrench.submerged_volume, pose);

  HydrodynamicState moving;
  moving.motion = {pose.q_WB.normalized().toRotationMatrix(), to_vec3(sent.linear_velocity),
                   to_vec3(sent.angular_velocity)};
  current_W_ = current_at(*water.at_rest, pose);
  moving.at_drag.water.velocity_W = moving.at_added_mass.water.velocity_W = current_W_;
  moving.at_drag.immersion.value = now.drag;
  moving.at_added_mass.immersion.value = now.added_mass;
  const HydrodynamicLoad load = body_->hydrodynamics->load(moving);
  const Vec6 of_motion = load.drag_W + load.added_mass_W;
  still_.force = to_array(to_vec3(wrench.force) - of_motion.head<3>());
  still_.torque = to_array(to_vec3(wrench.torque) - of_motion.tail<3>());

  half_jump_.setZero();
  if (const auto* const added = body_->hydrodynamics->added_mass_placement()) {
    const Vec3 center_W = pose.p_WB + moving.motion.R_WB * added->center_B;
    const Vec3 flow_W = flow_at_body(water, current_, center_W).velocity_W;
    if (taken_ && now.added_mass != immersion_.added_mass) {
      const Vec3 mean_flow_W = 0.5 * (flow_W_ + flow_W);
      const Vec6 before = relative_twist(state, mean_flow_W);
      const Vec6 after = modes_.twist_of_modal(now.added_mass) * modes_.modal(before, immersion_.added_mass);
      set_relative_twist(after, mean_flow_W, state);
      half_jump_ = 0.5 * (after - before);
    }
    flow_W_ = flow_W;
  }
  immersion_ = now;
  taken_ = true;
}

Vec6 HydrodynamicMotion::relative_twist(const RigidBodyState& state, const Vec3& water_velocity_W) const {
  Vec6 twist;
  twist.head<3>() = state.q_WB.conjugate() * Vec3(state.velocity_W - water_velocity_W);
  twist.tail<3>() = state.q_WB.conjugate() * angular_velocity_W(rigid_, state);
  return twist;
}

void HydrodynamicMotion::set_relative_twist(const Vec6& twist, const Vec3& water_velocity_W,
                                            RigidBodyState& state) const {
  state.velocity_W = water_velocity_W + state.q_WB * Vec3(twist.head<3>());
  state.angular_momentum_W = state.q_WB * Vec3(mass_B_.bottomRightCorner<3, 3>() * twist.tail<3>());
}

Mat6 HydrodynamicMotion::client_damping(const Vec6& twist) const {
  Mat6 damping = Mat6::Zero();
  const Damping& linear = rigid_.linear_damping;
  const Damping& angular = rigid_.angular_damping;
  damping.diagonal().head<3>().setConstant(linear.linear + linear.quadratic * twist.head<3>().norm());
  damping.diagonal().tail<3>().setConstant(angular.linear + angular.quadratic * twist.tail<3>().norm());
  return damping;
}

Mat6 HydrodynamicMotion::modal_damping(const Vec6& twist, const Vec3& current_B, const Mat6& N) const {
  Mat6 damping = Mat6::Zero();
  if (has_damping_) {
    Vec6 absolute = twist;
    absolute.head<3>() += current_B;
    damping = client_damping(absolute);
  }
  const auto& drag = body_->hydrodynamics->coefficients().drag;
  if (!drag || immersion_.drag == 0.0) return congruent(damping, N);
  const Vec3 from_center = rigid_.center_of_mass_B - drag->center_B;
  const Vec6 at_drag = twist_at(twist, -from_center);
  Mat6 at_center = immersion_.drag * drag->linear;
  if (quadratic_drag_is_diagonal_) {
    at_center.diagonal() += immersion_.drag * drag->quadratic.diagonal().cwiseProduct(at_drag.cwiseAbs());
  }
  damping += matrix_at(at_center, from_center);
  Mat6 modal = congruent(damping, N);
  if (!quadratic_drag_is_diagonal_) {
    // A full matrix D2 may drive a twist by D2 diag(|nu|) even where the drag of nu itself resists nu.
    const Vec6 force = immersion_.drag * (drag->quadratic * at_drag.cwiseAbs().cwiseProduct(at_drag));
    modal += dissipating(N.transpose() * wrench_about(force, from_center),
                         modes_.modal(twist, immersion_.added_mass));
  }
  return modal;
}

Mat6 HydrodynamicMotion::coriolis(const Vec6& twist) const {
  const Mat6 added = immersion_.added_mass * added_mass_B_;
  return coriolis_matrix(screw_ ? Mat6(mass_B_ + added) : added, twist);
}

void HydrodynamicMotion::change_velocities(double time, RigidBodyState& state) const {
  const Mat3 R_BW = state.q_WB.conjugate().toRotationMatrix();
  const Load load = total_load(rigid_, state, still_, water_);
  Vec6 force;
  force << R_BW * load.force_W, R_BW * load.torque_W;
  const Vec3 current_B = R_BW * current_W_;
  const Vec6 before = relative_twist(state, current_W_);
  const Mat6 N = modes_.twist_of_modal(immersion_.added_mass);
  const Vec6 u_before = modes_.modal(before, immersion_.added_mass);
  const bool turns = screw_ || immersion_.added_mass > 0.0;

  Vec6 u = u_before;
  Vec6 mean = before;
  for (int pass = 0; pass < kPasses; ++pass) {
    const Mat6 damping = modal_damping(mean, current_B, N);
    Vec6 net_force = force;
    if (has_damping_) {
      Vec6 absolute = mean;
      absolute.head<3>() += current_B;
      net_force.head<3>() -= client_damping(absolute).diagonal().head<3>().cwiseProduct(current_B);
    }
    const Vec6 modal_force = N.transpose() * net_force;
    if (turns) {
      u = relaxed(damping, modal_force, 0.5 * time, u_before);
      u = turned(congruent(coriolis(mean), N), time, u);
      u = relaxed(damping, modal_force, 0.5 * time, u);
    } else {
      u = relaxed(damping, modal_force, time, u_before);
    }
    mean = 0.5 * (before + N * u);
  }
  set_relative_twist(N * u, current_W_, state);
}

void HydrodynamicMotion::move(double time, RigidBodyState& state) const {
  const auto displace = [&](const Vec3& velocity_W, const Vec3& turning_W) {
    const Pose moved = extrapolate({state.center_W, state.q_WB}, velocity_W, turning_W, time);
    state.center_W = moved.p_WB;
    state.q_WB = moved.q_WB.normalized();
  };
  if (!screw_) {
    displace(state.velocity_W + state.q_WB * Vec3(half_jump_.head<3>()),
             state.q_WB * Vec3(half_jump_.tail<3>()));
    integrate_free_rotation(rigid_, time, state);
    return;
  }
  const Vec6 twist = relative_twist(state, current_W_);
  const Vec6 moving = twist + half_jump_;
  const Vec3 velocity = screw_velocity(time * moving.tail<3>(), moving.head<3>());
  displace(current_W_ + state.q_WB * velocity, state.q_WB * Vec3(moving.tail<3>()));
  set_relative_twist(twist, current_W_, state);
}

void HydrodynamicMotion::begin_step(Integrator integrator, double step, RigidBodyState& state) {
  screw_ = immersion_.drag > 0.0 || immersion_.added_mass > 0.0;
  change_velocities(integrator == Integrator::kSemiImplicitEuler ? step : 0.5 * step, state);
  move(step, state);
}

void HydrodynamicMotion::finish_step(Integrator integrator, double step, RigidBodyState& state) const {
  if (integrator == Integrator::kVelocityVerlet) change_velocities(0.5 * step, state);
}

double HydrodynamicMotion::added_kinetic_energy(const RigidBodyState& state, double immersion,
                                                const Vec3& current_W) const {
  const Vec6 twist = relative_twist(state, current_W);
  return 0.5 * immersion * twist.dot(added_mass_B_ * twist);
}

double HydrodynamicMotion::added_kinetic_energy(const RigidBodyState& state) const {
  return added_kinetic_energy(state, immersion_.added_mass, current_W_);
}

std::optional<double> HydrodynamicMotion::added_kinetic_energy_at_pose(const RigidBodyState& state) const {
  const Pose pose = pose_of(rigid_, state);
  const BuoyancyResult result = buoyancy(body_->solver, pose, water_, body_->reference_B);
  if (result.status != BuoyancyStatus::kOk) return std::nullopt;
  const double displaced = result.volume - flooded_volume(rigid_, pose, water_);
  return added_kinetic_energy(state, immersions(displaced, pose).added_mass, current_at(water_, pose));
}

}  // namespace buoyancy
