// Makes a body for hydrodynamics/coupled_mass.h from the messages of a client: the wrench of a response and
// the loads that belong to it.
//
//   const CoupledBody hull = coupled_body(mass, reference_B, state, loads);
//   const Vec6 total = wrench_of(wrench) + weight_W(hull, {0, 0, -9.80665});
//   const Vec6 acceleration = coupled_acceleration(hull, total, step);  // or compensated_wrench()
#pragma once

#include "hydrodynamics/coupled_mass.h"
#include "messages/loads.h"
#include "messages/request.h"

namespace buoyancy {

// Returns the force and the torque about the reference point.
Vec6 wrench_of(const BodyWrench& wrench);

// Returns the scaled added mass s A and the damping.
HydrodynamicMatrices matrices_of(const BodyLoads& loads);

// reference_B: [m], the scene's reference_point of the body. state: the one that the loads belong to.
CoupledBody coupled_body(const RigidBodyMass& mass, const Vec3& reference_B, const BodyState& state,
                         const BodyLoads& loads);

}  // namespace buoyancy
