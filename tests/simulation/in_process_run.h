// Runs the simulator in the test's own process, without files, options or a network.
#pragma once

#include <functional>
#include <string>

#include "simulation/simulation.h"

namespace buoyancy {

Scene scene_of(const std::string& text);  // throws for an invalid scene

Simulation simulation_of(const Scene& scene, const SimulationOptions& options);  // throws

// Advances the simulation by `steps` steps and calls `observe` at its start and after every step. Throws if
// the run fails.
void run_in_process(const Scene& scene, Simulation& simulation, std::int64_t steps,
                    const std::function<void(const Simulation&)>& observe = {});

}  // namespace buoyancy
