// Checks of hydrodynamic coefficients, with errors that name the likely cause: most often the other sign
// convention.
#pragma once

#include <optional>
#include <string>

#include "hydrodynamics/coefficients.h"

namespace buoyancy {

// Describes what is wrong with a matrix, in parts of an Error.
struct CoefficientFault {
  std::string expected;
  std::string cause;
  std::string hint;
};

// The hint about numbers in another sign convention, the same wherever they are detected.
extern const char* const kNegativeSignHint;

// Checks that a drag matrix, linear or quadratic, has no negative diagonal element and a positive
// semidefinite symmetric part, so that the drag of a motion along one axis opposes it. Complexity: O(1).
std::optional<CoefficientFault> find_drag_fault(const Mat6& matrix);

// Checks that an added mass is symmetric, to a relative 1e-6, and positive semidefinite. Complexity: O(1).
std::optional<CoefficientFault> find_added_mass_fault(const Mat6& matrix);

// Returns a twist for which the power of the quadratic drag, twist . D2 (|twist| o twist), is negative, if a
// search by descent from 64 twists finds one; it may overlook others. There is none where D2 is diagonal, but
// a full matrix can pass find_drag_fault() and still drive the body.
std::optional<Vec6> find_driving_twist(const Mat6& quadratic);

}  // namespace buoyancy
