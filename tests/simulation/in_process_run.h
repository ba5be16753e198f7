// Runs the simulator in the test's own process, without files, options or a network.
#pragma once

#include <cstdint>
#include <functional>

#include "simulation/simulation.h"

namespace buoyancy {

Simulation simulation_of(const Scene& scene, const SimulationOptions& options);  // throws

// Advances the simulation by `steps` steps and calls `observe` at its start and after every step. Throws if
// the run fails.
void run_in_process(const Scene& scene, Simulation& simulation, std::int64_t steps,
                    const std::function<void(const Simulation&)>& observe = {});

}  // namespace buoyancy
