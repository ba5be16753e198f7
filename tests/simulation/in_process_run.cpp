#include "tests/simulation/in_process_run.h"

#include <stdexcept>
#include <utility>

namespace buoyancy {

Simulation simulation_of(const Scene& scene, const SimulationOptions& options) {
  Expected<Simulation> simulation = Simulation::make(scene, options);
  if (!simulation) throw std::runtime_error(simulation.error().message());
  return std::move(*simulation);
}

void run_in_process(const Scene& scene, Simulation& simulation, std::int64_t steps,
                    const std::function<void(const Simulation&)>& observe) {
  const auto never = [] { return false; };
  SimulationClient client{InProcessClient(scene)};
  const Expected<RunOutcome> outcome = run(simulation, client, steps, never, [&](const Simulation& now) {
    if (observe) observe(now);
    return Expected<void>{};
  });
  if (!outcome) throw std::runtime_error(outcome.error().message());
}

Simulation simulation_after(const Scene& scene, const SimulationOptions& options, std::int64_t steps) {
  Simulation simulation = simulation_of(scene, options);
  run_in_process(scene, simulation, steps);
  return simulation;
}

}  // namespace buoyancy
