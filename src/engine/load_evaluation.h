// Evaluates the loads of a moving body: adds drag and added mass to its buoyant wrench, and fills in the
// message that lists them separately.
#pragma once

#include "engine/body_evaluation.h"
#include "hydrodynamics/hydrodynamic_load.h"
#include "messages/loads.h"

namespace buoyancy {

// The velocities of a state, if it is used with a pose.
struct BodyTwist {
  Vec3 velocity_W = Vec3::Zero();          // [m/s], of B's origin
  Vec3 angular_velocity_W = Vec3::Zero();  // [rad/s]
};
BodyTwist twist_of(const BodyState& state);

// Returns the undisturbed flow at a point: current and waves, if there are any. A current with a profile is
// that at the point's height over the level; its shear adds no acceleration. Precondition: the water is
// known. Complexity: O(components) in waves.
FlowAtBody flow_at_body(const WaterState& water, const Current& current, const Vec3& p_W);

// Returns the state of a body that the load formulas need. outcome: its buoyancy at the pose, status kOk.
// No heap allocation. Complexity: O(1) in water at rest where the volume scales the coefficients.
HydrodynamicState hydrodynamic_state(const Body& body, const WaterState& water, const Current& current,
                                     const Pose& pose, const BodyTwist& twist, const BodyOutcome& outcome);

// Adds the body's drag and added mass to its wrench, and what they contribute to its bounds. Sets the status
// to kOutOfRange, and force, torque, volume, centre and bounds to zero, if a sum exceeds double's range.
// Preconditions: the body has a hydrodynamic model, and the wrench's status is kOk.
void add_hydrodynamic_load(const HydrodynamicLoad& load, BodyWrench& wrench);

// Returns the loads of a body with this output. buoyancy: its buoyant wrench alone, with status kOk.
BodyLoads to_loads(const Body& body, const BodyWrench& buoyancy, const HydrodynamicState& state,
                   const HydrodynamicLoad& load);
// Returns those of a body without a hydrodynamic model. at_origin: the flow at the body's origin.
BodyLoads to_loads(const Body& body, const BodyWrench& buoyancy, const FlowAtBody& at_origin);

// Completes the wrench of a body that has drag, added mass or the loads output: adds drag and added mass, and
// sets `loads`, if it is not nullptr. wrench: the buoyant one of `buoyancy`, whose status is kOk.
void add_loads(const Body& body, const WaterState& water, const Current& current, const Pose& pose,
               const BodyTwist& twist, const BodyOutcome& buoyancy, BodyWrench& wrench, BodyLoads* loads);

}  // namespace buoyancy
