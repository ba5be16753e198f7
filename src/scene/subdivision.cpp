#include "scene/subdivision.h"

namespace buoyancy {

BodyCondition initial_condition(const Subdivision& subdivision) {
  BodyCondition condition;
  condition.flooded.reserve(subdivision.compartments.size());
  condition.liquid_volumes.reserve(subdivision.tanks.size());
  for (const BodyCompartment& compartment : subdivision.compartments) {
    condition.flooded.push_back(compartment.flooded);
  }
  for (const BodyTank& tank : subdivision.tanks) condition.liquid_volumes.push_back(tank.liquid_volume);
  return condition;
}

}  // namespace buoyancy
