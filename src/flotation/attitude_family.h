// Curves of attitudes along which the energy of a floating body does not change.
#pragma once

#include <vector>

#include "flotation/attitude_descent.h"

namespace buoyancy {

// [kg m], by how much energies of one family may differ.
double flat_energy(const Balance& balance, double relative);

// Attitudes in steps of kFamilyStep along the direction of least curvature, each at the bottom of the valley
// that it follows: through the whole curve until it closes, or all around. Empty where the energy rises, or
// falls, by more than `flat` within one radian.
std::vector<Vec3> flat_curve(const Balance& balance, const Minimum& minimum, double flat);

inline constexpr double kFamilyStep = 0.1;  // [rad]

// Is the energy flat in the direction of larger curvature too, for one radian along both ways?
bool is_flat_everywhere(const Balance& balance, const Minimum& minimum, double flat);

}  // namespace buoyancy
