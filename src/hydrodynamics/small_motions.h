// Small motions of a rigid body about a pose: M x'' + D x' + K x = 0.
//
// x holds a displacement along three axes and a rotation about them through the centre of mass, in the order
// surge, sway, heave, roll, pitch, yaw; the third axis points up. M includes the added mass; only the
// symmetric parts of D and K count, since an antisymmetric part neither stores nor dissipates energy. After
// T. I. Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2011), sections 4.3 and 12.2.
#pragma once

#include <optional>

#include "base/spatial.h"

namespace buoyancy {

// x = shape sin(omega t), with shape^T M shape = 1.
struct MotionMode {
  double stiffness = 0.0;     // omega^2 [rad^2/s^2]; not above 0 where nothing restores the motion
  Vec6 shape = Vec6::Zero();  // [kg^-1/2, (kg m^2)^-1/2]
};

// The three motions that the water can restore, each named after the coordinate with most of its energy. They
// may be coupled with one another and with surge, sway and yaw, which nothing restores.
struct HeaveRollPitch {
  MotionMode heave, roll, pitch;
};

// mass: symmetric, positive definite. stiffness: only the rows and columns of heave, roll and pitch count.
// Returns nullopt where the mass is not positive definite, or a number is beyond double's range. Accurate to
// a few eps of the largest omega^2. Complexity: O(1), some microseconds.
std::optional<HeaveRollPitch> heave_roll_pitch(const Mat6& mass, const Mat6& stiffness);

// Returns a mode's damping over its critical damping, shape^T D shape / (2 omega). It is exact where D does
// not couple the mode with others, else to first order in D. Precondition: the mode's stiffness is above 0.
double damping_ratio(const MotionMode& mode, const Mat6& damping);

// Returns the damping ratio of quadratic drag, D2 diag(|nu|) nu, for an oscillation with this amplitude: that
// of the linear damping that dissipates as much in a period, 8 / (3 pi) times the drag at the largest
// velocity. twist_of_shape: the mode's shape as a twist at the drag's centre, in the drag's axes. amplitude:
// the factor on the shape.
double quadratic_damping_ratio(const Vec6& twist_of_shape, const Mat6& quadratic, double amplitude);

// Returns the step [s] below which semi-implicit Euler is stable with K x and D x' evaluated at the step's
// start: v += h M^-1 (-K x - D v), x += h v. With one degree of freedom this is 2 / (omega (zeta + sqrt(1 +
// zeta^2))): 2 / omega without damping, 2 M / D without stiffness. It is the smallest h at which 4 M - 2 h D
// - h^2 K is singular, exact for symmetric D >= 0 and K >= 0 (docs/mathematics.md, "Small motions").
// Directions that nothing restores count with their damping alone. Infinity where neither acts; nullopt as
// for heave_roll_pitch(). Accurate to 1e-12. Complexity: O(1), some microseconds.
std::optional<double> max_explicit_step(const Mat6& mass, const Mat6& damping, const Mat6& stiffness);

// Returns the largest ratio of added mass to mass over all motions, the largest eigenvalue of mass^-1
// added_mass. Above 1, an added mass that is applied as a force from the acceleration of the last step
// diverges, whatever the step. nullopt as for heave_roll_pitch().
std::optional<double> max_mass_ratio(const Mat6& mass, const Mat6& added_mass);

}  // namespace buoyancy
