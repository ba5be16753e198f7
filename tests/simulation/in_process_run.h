// The simulator in the test's own process, without files, options or network.
#pragma once

#include <functional>
#include <string>

#include "simulation/simulation.h"

namespace buoyancy {

Scene scene_of(const std::string& text);  // throws what is wrong with it

Simulation simulation_of(const Scene& scene, const SimulationOptions& options);  // likewise

// Moves the simulation this many steps on; `see` sees its start and every step. Throws what ends a run.
void run_embedded(const Scene& scene, Simulation& simulation, std::int64_t steps,
                  const std::function<void(const Simulation&)>& see = {});

}  // namespace buoyancy
