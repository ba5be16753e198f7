// The motion of a rigid body together with its added mass: how a simulator of your own uses the loads that
// the service publishes (BUOYANCY_LOADS).
//
// The wrench of the service leaves out -s A nu_dot, because an explicit force that is proportional to the
// acceleration diverges as soon as the added mass exceeds the body's. The simulator moves it to the left
// side instead: with r the reference point, M the body's mass matrix about it and W the sum of all wrenches
// (the service's, the weight, joints, propellers),
//
//   (M + s A) (a, alpha) = W - (rigid-body Coriolis terms) + s A (w x v, 0)
//
// v, a: velocity and acceleration of r in W's axes. The last term is there because nu_dot belongs to axes
// that turn with the body. The rigid-body terms about the centre of mass are (0, w x I w). With a step h and
// the damping D of the service, minus the derivative of its wrench with respect to the velocities, the change
// of the velocities over the step is linearly implicit,
//
//   (M + s A + h D) dnu = h (right side from above),
//
// where D also gets the derivatives of the other velocity-dependent terms of that side. Drag then makes no
// step too large. Weight does not act on added mass: it stays that of the body's mass alone.
//
// All vectors and matrices are in W's axes, and torques are about r. Derivation and limits: docs/runs.md.
#pragma once

#include "hydrodynamics/hydrodynamic_load.h"

namespace buoyancy {

struct RigidBodyMass {
  double mass = 1.0;                     // [kg], > 0
  Vec3 center_of_mass_B = Vec3::Zero();  // [m]
  Mat3 inertia_B = Mat3::Identity();     // [kg m^2], about the centre of mass; positive definite
};

// Returns the mass matrix of the body alone about a point, in W's axes: the kinetic energy is 1/2 nu . M nu,
// with nu the velocity of that point and the angular velocity. point_B: [m].
Mat6 mass_matrix_W(const RigidBodyMass& mass, const Mat3& R_WB, const Vec3& point_B);

// A body in the water at one moment.
struct CoupledBody {
  RigidBodyMass mass;
  Vec3 reference_B = Vec3::Zero();  // [m], the point r, which wrenches and matrices are about
  BodyMotion motion;
  HydrodynamicMatrices water;  // s A, and the damping; zero for a dry body
};

// The weight about r. gravity_W: [m/s^2], pointing down.
Vec6 weight_W(const CoupledBody& body, const Vec3& gravity_W);

// Returns the acceleration of r [m/s^2] and the angular acceleration [rad/s^2]. wrench_W: the sum of all
// wrenches about r, with the weight. step: [s], >= 0; above 0 the result is the mean acceleration of a
// linearly implicit step, which changes the velocities by step times the result. Complexity: O(1), no heap.
Vec6 coupled_acceleration(const CoupledBody& body, const Vec6& wrench_W, double step = 0.0);

// Serves engines whose bodies have no 6 x 6 mass matrix, such as Bullet and ODE: returns the wrench about the
// centre of mass that gives the body of mass M alone the acceleration from above, M (M + s A)^-1 W with the
// Coriolis terms. It replaces all wrenches in wrench_W, including the weight: turn off the engine's gravity
// for this body. The engine must subtract w x I w itself, as Bullet and ODE do by default.
//
// This is wrong while the body touches something: contact and joint forces that the engine adds act on M
// alone, as if the body had no added mass.
Vec6 compensated_wrench(const CoupledBody& body, const Vec6& wrench_W, double step = 0.0);

}  // namespace buoyancy
