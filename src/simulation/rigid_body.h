// A simulated rigid body: mass, centre of mass C, principal inertia, and the state about C.
//
// Newton-Euler equations about the centre of mass: m dv/dt = F, dL/dt = tau, with v the velocity of C and L
// the angular momentum about C, both in W. No gyroscopic term appears: without torque L is constant in W,
// while w = I_W^-1 L is not. Messages refer to B's origin and to the body's reference point r: the velocity
// of B's origin is v - w x (R c), and tau about C = tau about r + (r - C) x F.
//
// The mass, C and the inertia of a body include the liquids in its tanks as if frozen (scene/body_mass.h), so
// that it falls with g. The weight of the liquids, at the present attitude, is part of the wrench; the weight
// of the body without them acts at its own centre of mass, which is not C.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "base/error.h"
#include "flotation/floating_body.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/water_plane.h"
#include "messages/request.h"
#include "scene/body_mass.h"
#include "scene/scene.h"

namespace buoyancy {

// Resistance against a motion at speed s: (linear + quadratic s) s.
struct Damping {
  double linear = 0.0;     // [N/(m/s)] or [N m/(rad/s)], >= 0
  double quadratic = 0.0;  // [N/(m/s)^2] or [N m/(rad/s)^2], >= 0
};

// The contents of a body with compartments or tanks.
struct BodyContents {
  RigidBodyMass own;                     // without the liquids
  std::vector<Tank> tanks;               // their meshes are owned by the scene
  std::vector<PlacedMesh> compartments;  // open to the sea; the scene owns their meshes
};

struct RigidBody {
  double mass = 1.0;                         // [kg], > 0
  Vec3 center_of_mass_B = Vec3::Zero();      // [m]
  Vec3 reference_B = Vec3::Zero();           // [m], reference point of a wrench's torque
  Vec3 principal_inertia = Vec3::Ones();     // [kg m^2], about C, > 0, ascending
  Mat3 principal_axes_B = Mat3::Identity();  // column i: unit axis of principal_inertia[i]
  Damping linear_damping;                    // resists the velocity of C
  Damping angular_damping;                   // resists the angular velocity
  std::optional<BodyContents> contents;      // set if the body has compartments or tanks
};

struct RigidBodyState {
  Vec3 center_W = Vec3::Zero();                              // [m], position of C
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  // unit quaternion
  Vec3 velocity_W = Vec3::Zero();                            // [m/s], velocity of C
  Vec3 angular_momentum_W = Vec3::Zero();                    // [kg m^2/s], about C
};

// Total force, and torque about C, on a body without damping.
struct Load {
  Vec3 force_W = Vec3::Zero();   // [N]
  Vec3 torque_W = Vec3::Zero();  // [N m]
};

// Makes the body that [body.client] describes. Values that are not given are derived from the mesh: the mass
// from the enclosed volume and the density (half the water's density by default), the centre of mass and the
// inertia from the enclosed volume at uniform density. The liquids are those of `condition`, or of the scene
// file if it is nullptr, frozen at the `orientation` of [body.client]. Errors: an open mesh, which encloses
// no volume, without mass, center_of_mass and inertia; a mass or a principal inertia that is not above 0.
Expected<RigidBody> make_rigid_body(const Body& body, const Water& water,
                                    const BodyCondition* condition = nullptr);

// Gives a body with compartments or tanks another condition, its liquids frozen at the state's attitude. Mass
// that is added or removed moves with the body: B's velocities stay, and those of C and the angular momentum
// follow. body: the one that rigid was made from.
void set_condition(const Body& body, const BodyCondition& condition, const Water& water, RigidBody& rigid,
                   RigidBodyState& state);

// Returns the initial state. spec: position and velocity are those of B's origin; `start` is ignored.
RigidBodyState initial_state(const RigidBody& body, const DynamicsSpec& spec);

Vec3 angular_velocity_W(const RigidBody& body, const RigidBodyState& state);  // [rad/s]
Pose pose_of(const RigidBody& body, const RigidBodyState& state);             // pose of B
// Returns the height of the mesh's lowest vertex over the level [m]. Complexity: O(vertices).
double lowest_height(const HydrostaticMesh& mesh, const WaterPlane& plane);
BodyState to_body_state(std::int32_t body_id, const RigidBody& body, const RigidBodyState& state);

// Returns the sum of a response's wrench and the body's weight. The wrench must belong to the state's pose.
Load total_load(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                const Water& water);

// Kinetic energy [J]: 1/2 m v^2 + 1/2 L . w.
double kinetic_energy(const RigidBody& body, const RigidBodyState& state);

// Returns the volume [m^3] by which the open compartments reduce what the body displaces at a pose in water
// at rest.
double flooded_volume(const RigidBody& body, const Pose& pose, const Water& water);

// Mechanical energy [J]: kinetic energy + m g z_C - rho g V z_b, with z_C and z_b the heights of C and of the
// centre of buoyancy over the water's level. It is 0 for a body at rest with z_C = 0 that displaces nothing.
// The last term is the potential of the buoyancy: bringing dV to the depth d below the surface takes rho g d
// dV. With liquids in tanks, z_C is the height of the centre of mass of all at the present attitude. Water of
// one density: in layered water the wrench does not tell the potential.
double mechanical_energy(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                         const Water& water);
// The same, with the wrench computed by the solver, for a state whose pose has no wrench yet, and for layered
// water, where the potential is the sum over the terms of its pressure; nullopt if the solver's status is not
// kOk at this pose.
std::optional<double> mechanical_energy(const RigidBody& body, const RigidBodyState& state,
                                        const Solver& solver, const Water& water);

}  // namespace buoyancy
