// Compares two results for one body at one pose: its wrench and its hydrostatics. loads_comparison.h compares
// its loads.
//
// Every wrench carries error bounds. Two correct results differ by at most the sum of both bounds, so this
// sum is the limit of a difference and no tolerance has to be chosen. Hydrostatics carry no bounds: they are
// exact to rounding, and their tolerances are the rounding errors for a body of that size (docs/replay.md).
#pragma once

#include <algorithm>

#include "engine/field_differences.h"
#include "messages/hydrostatics.h"
#include "messages/request.h"
#include "scene/scene.h"

namespace buoyancy {

// The differences of one pair of wrenches, or the largest ones of several pairs.
struct WrenchDifferences {
  double force = 0.0;             // [N]
  double torque = 0.0;            // [N m]
  double volume = 0.0;            // [m^3]
  double center = 0.0;            // [m], centre of buoyancy
  double force_in_bounds = 0.0;   // difference / sum of both bounds: <= 1 if both results are correct
  double torque_in_bounds = 0.0;  // the same for the torque
  // The same for the centre of buoyancy, whose error bound is 2 torque bound / force.
  double center_in_bounds = 0.0;

  // The largest of the three ratios.
  double in_bounds() const { return std::max({force_in_bounds, torque_in_bounds, center_in_bounds}); }
  // Takes the larger of each number.
  void update(const WrenchDifferences& other);
};

WrenchDifferences compare_wrenches(const BodyWrench& now, const BodyWrench& baseline);

// Precondition: both statuses are kOk.
void compare_hydrostatics(const BodyHydrostatics& now, const BodyHydrostatics& baseline, const Body& body,
                          const Water& water, MessageDifferences& differences);

}  // namespace buoyancy
