// Runs the simulator in the test's own process, without files, options or a network.
#pragma once

#include <cstdint>
#include <functional>

#include "simulation/simulation.h"

namespace buoyancy {

inline constexpr Integrator kBothIntegrators[] = {Integrator::kSemiImplicitEuler,
                                                  Integrator::kVelocityVerlet};

Simulation simulation_of(const Scene& scene, const SimulationOptions& options);  // throws

// Advances the simulation by `steps` steps and calls `observe` at its start and after every step. Throws if
// the run fails.
void run_in_process(const Scene& scene, Simulation& simulation, std::int64_t steps,
                    const std::function<void(const Simulation&)>& observe = {});

// The simulation after so many steps. Throws if the run fails.
Simulation simulation_after(const Scene& scene, const SimulationOptions& options, std::int64_t steps);

// Measures the mean period from the first to the last upward crossing of the rest position.
class PeriodMeter {
 public:
  void update(double height, double time, double step) {
    if (last_height_ < 0.0 && height >= 0.0) {
      last_ = time - step * height / (height - last_height_);
      if (++periods_ == 0) first_ = last_;
    }
    last_height_ = height;
  }
  int periods() const { return periods_; }
  double mean() const { return (last_ - first_) / periods_; }

 private:
  double last_height_ = 0.0;
  double first_ = 0.0;
  double last_ = 0.0;
  int periods_ = -1;
};

}  // namespace buoyancy
