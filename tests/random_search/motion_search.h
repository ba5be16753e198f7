// The random search for motions that gain energy (docs/runs.md): bodies with drag and added mass in
// water at rest, moved by the simulator with wrenches from the request handler.
//
// A submerged, neutrally buoyant body never gains kinetic energy, that of the added mass included, from one
// step to the next: beyond rounding. The mechanical energy of a body that pierces the surface never exceeds
// its start by more than that of the same body without drag does, or by more than the documented oscillation
// of the integrator within the step limit, as a fraction of the largest kinetic energy of both. Nothing
// becomes non-finite.
#pragma once

#include "tests/random_search/motion_case.h"
#include "tests/random_search/search_engine.h"

namespace buoyancy {

// Growth of the kinetic energy in a step, as a fraction of itself, that counts as rounding.
inline constexpr double kRoundingGrowth = 1e-10;

// The energy's oscillation at a step times frequency of 0.5, as docs/runs.md states it.
constexpr double documented_oscillation(Integrator integrator) {
  return integrator == Integrator::kVelocityVerlet ? 0.06 : 0.25;
}

RandomSearch motion_search();

}  // namespace buoyancy
