// Moves a body that has drag or added mass. Bodies without either are moved by integrator.h alone.
//
// In B's axes about the centre of mass, nu is the twist relative to the current, M = diag(m, I), and A the
// added mass. The motion relative to a uniform current is that in water at rest:
//
//   (M + s A) nu_dot = f - C(nu) nu - D(nu) nu,   D(nu) = s (D1 + D2 diag(|nu|)) + damping of [body.client]
//
// C is the Coriolis matrix of M + s A, which is skew-symmetric. f is the wrench of a response without its
// drag and its Coriolis terms at the twist that was sent, plus the weight; it holds buoyancy and the load of
// waves. In a step the maps K, D and X of integrator.h are replaced by
//
//   V(t): velocities, pose fixed. In modal velocities u (added_mass_modes.h), with C and D taken at the mean
//         of the velocities before and after (three passes):  E(t/2) Q(t) E(t/2).
//         E: du/dt = f - D u by the L-stable approximation 1/(1 + z + z^2/2) of exp(-z), whose fixed point is
//         that of the equation. Its norm is at most 1 for every matrix z that dissipates, and it has no zeros
//         or negative values: no drag and no step makes a velocity overshoot, alternate or gain energy.
//         Q: du/dt = -C u by Cayley's transform, which is a rotation.
//   X(t): pose, with the twist constant in B's axes: a screw. For a dry body X(t) of integrator.h, which is
//         exact for v and L constant in W; then C is left out.
//   S:    the immersion changes with the pose, from s to s': u is kept, of the twist relative to the water at
//         the centre of the added mass, waves included. The change of added mass does no work in this way,
//         which in one dimension is Lagrange's equation; otherwise a body could gain energy by dipping in and
//         out. The pose moved with the twist from before the change: half the difference is made up for in
//         the next X, which keeps the order 2.
//
//   semi_implicit_euler  V(h) X(h), new wrench, S
//   velocity_verlet      V(h/2) X(h), new wrench, S V(h/2)
#pragma once

#include <optional>

#include "engine/body_evaluation.h"
#include "simulation/added_mass_modes.h"
#include "simulation/integrator.h"

namespace buoyancy {

class HydrodynamicMotion {
 public:
  // body: has a hydrodynamic model; it must outlive this object. A current with a profile is uniform in each
  // step: that at the centre of the drag, or of the added mass without drag, in the state that was sent.
  HydrodynamicMotion(const Body& body, const RigidBody& rigid, const Water& water, const Current& current);

  // Replaces the rigid body after a change of the condition of its compartments or tanks.
  void set_rigid_body(const RigidBody& rigid);

  // Takes the wrench of a response to the state that was sent, evaluated lead_time later in this water, and
  // changes the velocities by S. The first wrench changes none.
  void take(const BodyWrench& wrench, const BodyState& sent, double lead_time, const WaterState& water,
            RigidBodyState& state);

  // These are as in integrator.h, with the wrench that was taken last. Preconditions: take() was called;
  // finish_step() belongs to the last begin_step().
  void begin_step(Integrator integrator, double step, RigidBodyState& state);
  void finish_step(Integrator integrator, double step, RigidBodyState& state) const;

  // Kinetic energy of the water [J]: 1/2 nu . s A nu, at the immersion of the wrench that was taken last.
  double added_kinetic_energy(const RigidBodyState& state) const;
  // The same at the immersion of the state's own pose in water at rest, or nullopt if the solver's status is
  // not kOk at this pose.
  std::optional<double> added_kinetic_energy_at_pose(const RigidBodyState& state) const;

 private:
  struct Immersions {
    double drag = 0.0;
    double added_mass = 0.0;
  };
  // displaced: [m^3], net of the open compartments, whose flooded volume in water at rest is added here.
  Immersions immersions(double displaced, const Pose& pose) const;
  double added_kinetic_energy(const RigidBodyState& state, double immersion, const Vec3& current_W) const;
  // [m/s], at the centre that the constructor names.
  Vec3 current_at(const Water& water, const Pose& pose) const;

  // The twist is relative to water that has this velocity everywhere.
  Vec6 relative_twist(const RigidBodyState& state, const Vec3& water_velocity_W) const;
  void set_relative_twist(const Vec6& twist, const Vec3& water_velocity_W, RigidBodyState& state) const;
  // N^T D N, with D at this twist; current_B: the current in B's axes.
  Mat6 modal_damping(const Vec6& twist, const Vec3& current_B, const Mat6& N) const;
  Mat6 client_damping(const Vec6& twist) const;  // of the absolute twist
  Mat6 coriolis(const Vec6& twist) const;

  void change_velocities(double time, RigidBodyState& state) const;  // V
  void move(double time, RigidBodyState& state) const;               // X

  const Body* body_;
  RigidBody rigid_;
  Water water_;
  Current current_;
  Vec3 current_W_;                    // [m/s], of this step
  Mat6 mass_B_ = Mat6::Zero();        // M
  Mat6 added_mass_B_ = Mat6::Zero();  // A
  AddedMassModes modes_;
  bool quadratic_drag_is_diagonal_ = true;
  bool has_damping_ = false;  // of [body.client]

  BodyWrench still_;               // the wrench without its drag and Coriolis terms
  bool taken_ = false;             // take() was called
  Immersions immersion_;           // of still_
  Vec3 flow_W_ = Vec3::Zero();     // [m/s], the water at the centre of the added mass, of still_
  bool screw_ = false;             // X of the present step is a screw
  Vec6 half_jump_ = Vec6::Zero();  // half the change of the twist in the last S, B's axes
};

}  // namespace buoyancy
