// The coefficients of the water's reaction to a body's motion: drag and added mass, as a scene gives them.
//
// Positive coefficients oppose the motion and add inertia. Matrices are in B's axes, about a centre, and act
// on the twist (linear velocity, angular velocity) relative to the water. Formulas: hydrodynamic_load.h.
#pragma once

#include <optional>

#include "base/spatial.h"

namespace buoyancy {

// What scales the coefficients, which hold for a fully submerged body. A dry body has neither drag nor added
// mass, whatever scales them.
enum class ImmersionScaling {
  kVolume,      // submerged volume over whole volume
  kWettedArea,  // wetted area over whole area
  kNone,        // 1 for a body that is not dry
};

struct DragCoefficients {
  Mat6 linear = Mat6::Zero();     // D1 [N/(m/s), N m/(rad/s) and mixed]; symmetric part positive semidefinite
  Mat6 quadratic = Mat6::Zero();  // D2 [N/(m/s)^2, N m/(rad/s)^2 and mixed]; as for D1
  Vec3 center_B = Vec3::Zero();   // [m]
  ImmersionScaling immersion = ImmersionScaling::kVolume;

  bool operator==(const DragCoefficients&) const = default;
};

struct AddedMassCoefficients {
  Mat6 matrix = Mat6::Zero();    // A [kg, kg m, kg m^2]; symmetric, positive semidefinite
  Vec3 center_B = Vec3::Zero();  // [m]
  ImmersionScaling immersion = ImmersionScaling::kVolume;

  bool operator==(const AddedMassCoefficients&) const = default;
};

struct HydrodynamicCoefficients {
  std::optional<DragCoefficients> drag;
  std::optional<AddedMassCoefficients> added_mass;

  bool any() const { return drag || added_mass; }
  bool operator==(const HydrodynamicCoefficients&) const = default;
};

}  // namespace buoyancy
