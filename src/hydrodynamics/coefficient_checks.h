// Checks of hydrodynamic coefficients, with errors that name the likely cause: most often the other sign
// convention.
#pragma once

#include <optional>
#include <string>

#include "hydrodynamics/coefficients.h"

namespace buoyancy {

// What is wrong with a matrix, in parts of an Error.
struct CoefficientFault {
  std::string expected;
  std::string cause;
  std::string hint;
};

// Of numbers that have the sign of another convention. The words are the same wherever it is detected.
extern const char* const kNegativeSignHint;

// A drag matrix, linear or quadratic: no negative diagonal element, and a symmetric part that is positive
// semidefinite, so that the drag of a motion along one axis opposes it. Complexity: O(1).
std::optional<CoefficientFault> find_drag_fault(const Mat6& matrix);

// An added mass: symmetric within 1e-6 of its diagonal elements, and positive semidefinite. Complexity: O(1).
std::optional<CoefficientFault> find_added_mass_fault(const Mat6& matrix);

// Is the power of the quadratic drag, twist . D2 (|twist| o twist), negative for a twist near the one that
// is returned? That cannot be where D2 is diagonal; a full matrix can pass find_drag_fault() and drive the
// body all the same. A search by descent from 64 twists: it finds what it returns, and may overlook others.
std::optional<Vec6> find_driving_twist(const Mat6& quadratic);

}  // namespace buoyancy
