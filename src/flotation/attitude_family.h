// Curves of attitudes along which the energy of a floating body does not change.
#pragma once

#include <vector>

#include "flotation/attitude_descent.h"

namespace buoyancy {

// Returns the largest difference of energies within one family [kg m].
double flat_energy(const Balance& balance, double relative);

// Returns attitudes in steps of kFamilyStep along the direction of least curvature, each at the bottom of the
// valley, until the curve closes, a turn is complete, or the energy changes by more than `flat`. Returns none
// where it does so within one radian.
std::vector<Vec3> flat_curve(const Balance& balance, const Minimum& minimum, double flat);

inline constexpr double kFamilyStep = 0.1;  // [rad]

// True if the energy is flat up to 1.5 rad both ways along both principal directions.
bool is_flat_everywhere(const Balance& balance, const Minimum& minimum, double flat);

}  // namespace buoyancy
