// Time integrators of a rigid body, for one step h. Either of them needs one wrench per step.
//
//   semi_implicit_euler  (symplectic Euler)   D(h/2) K(h) D(h/2) X(h)                        order 1
//   velocity_verlet                           D(h/2) K(h/2) X(h), new load, K(h/2) D(h/2)    order 2
//
//   K(t), kick:  v += t F/m, L += t tau, with the pose fixed.
//   X(t), drift: C += t v, and the rotation of a free body with L constant in W: a symmetric splitting of the
//                kinetic energy into that of a ball, which gives an exact rotation about L, and the
//                deviations of two principal inertias from the third, which give exact rotations about their
//                axes (after Dullweber, Leimkuhler and McLachlan, J. Chem. Phys. 107, 1997, and Fasso,
//                J. Comput. Phys. 189, 2003).
//                Exact for bodies with two equal principal inertias, order 2 for others.
//   D(t), damping: dv/dt = -(c + d |v|) v / m: exact. dw_i/dt = -(c + d |w|) w_i / I_i in principal axes with
//                the path of |w| taken from the scalar equation: exact for equal inertias, order 2 for
//                others. The magnitude of every component decreases monotonically: no damping and no step,
//                however large, makes it overshoot or diverge.
//
// K and X are maps of Hamilton's equations and the compositions without D are symplectic: over a step within
// the stability limit (h times the highest frequency < 2) the energy of an undamped body oscillates by O(h)
// or O(h^2) of itself and does not drift. L is conserved to rounding while no torque acts. The quaternion is
// normalised each step.
#pragma once

#include <optional>
#include <string_view>

#include "simulation/rigid_body.h"

namespace buoyancy {

enum class Integrator { kSemiImplicitEuler, kVelocityVerlet };

std::string_view to_string(Integrator integrator);  // "velocity_verlet"
std::optional<Integrator> integrator_from_name(std::string_view name);

// Moves the state from t to the pose at t + h, given the load at t. step: h [s], > 0.
void begin_step(Integrator integrator, const RigidBody& body, const Load& load, double step,
                RigidBodyState& state);
// Completes the velocities at t + h, given the load at the pose of t + h.
void finish_step(Integrator integrator, const RigidBody& body, const Load& load, double step,
                 RigidBodyState& state);

// Applies the rotation of X(time) alone: the motion of a body on which no torque acts.
void integrate_free_rotation(const RigidBody& body, double time, RigidBodyState& state);
// Applies D(time) alone.
void apply_damping(const RigidBody& body, double time, RigidBodyState& state);

}  // namespace buoyancy
