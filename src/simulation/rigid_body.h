// A floating rigid body as the simulator moves it: mass, centre of mass C, principal inertia, and its state
// about C.
//
// Newton and Euler about the centre of mass: m dv/dt = F, dL/dt = tau, with v the velocity of C and L the
// angular momentum about C, both in W; the gyroscopic term is in that L is constant in W and w = I_W^-1 L is
// not. Messages speak of B's origin and of the body's reference point r: the velocity of B's origin is
// v - w x (R c), and tau about C = tau about r + (r - C) x F.
#pragma once

#include <optional>

#include <Eigen/Geometry>

#include "base/error.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/water_plane.h"
#include "messages/request.h"
#include "scene/scene.h"

namespace buoyancy {

// Resistance of a motion at speed s: (linear + quadratic s) s, against the motion.
struct Damping {
  double linear = 0.0;     // N/(m/s) or N m/(rad/s), >= 0
  double quadratic = 0.0;  // N/(m/s)^2 or N m/(rad/s)^2, >= 0
};

struct RigidBody {
  double mass = 1.0;                         // kg, > 0
  Vec3 center_of_mass_B = Vec3::Zero();      // m
  Vec3 reference_B = Vec3::Zero();           // m: what a wrench's torque is about
  Vec3 principal_inertia = Vec3::Ones();     // kg m^2 about C, > 0, ascending
  Mat3 principal_axes_B = Mat3::Identity();  // column i: unit axis of principal_inertia[i]
  Damping linear_damping;                    // of the velocity of C
  Damping angular_damping;                   // of the angular velocity
};

struct RigidBodyState {
  Vec3 center_W = Vec3::Zero();                              // m: C
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  // unit
  Vec3 velocity_W = Vec3::Zero();                            // m/s: of C
  Vec3 angular_momentum_W = Vec3::Zero();                    // kg m^2/s, about C
};

// All that acts on a body, damping aside, as force and torque about C.
struct Load {
  Vec3 force_W = Vec3::Zero();   // N
  Vec3 torque_W = Vec3::Zero();  // N m
};

// The body that [body.client] describes; what it leaves out comes from the mesh: mass from the enclosed
// volume and the density (half the water's if that is left out too), centre of mass and inertia from the
// enclosed volume at uniform density. Errors: an open mesh encloses nothing, so mass, center_of_mass and
// inertia must be given; mass or principal inertia not above 0.
Expected<RigidBody> make_rigid_body(const Body& body, const Water& water);

// At the start, as [body.client] says it of B's origin.
RigidBodyState initial_state(const RigidBody& body, const DynamicsSpec& spec);

Vec3 angular_velocity_W(const RigidBody& body, const RigidBodyState& state);  // rad/s
Pose pose_of(const RigidBody& body, const RigidBodyState& state);             // of B
BodyState to_body_state(std::int32_t body_id, const RigidBody& body, const RigidBodyState& state);

// The wrench of a response and the body's weight. The wrench is taken to belong to the state's pose.
Load total_load(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                const Water& water);

// J: 1/2 m v^2 + 1/2 L . w.
double kinetic_energy(const RigidBody& body, const RigidBodyState& state);

// J, zero for a body at rest whose centre of mass is at the water's level and that displaces nothing: kinetic
// energy + m g z_C - rho g V z_b, z_C and z_b the heights of C and of the centre of buoyancy over the level.
// The last term is the buoyancy's potential: bringing dV to the depth d below the surface takes rho g d dV.
double mechanical_energy(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                         const Water& water);
// The same where no wrench belongs to the state's pose: asks the solver. nullopt: it has no response there.
std::optional<double> mechanical_energy(const RigidBody& body, const RigidBodyState& state,
                                        const Solver& solver, const Water& water);

}  // namespace buoyancy
