// Warnings about runs whose results are not trustworthy although every single response is right. The subject
// of each is the worst affected body; none of them ends a run.
//
// With w the body's highest natural frequency (natural_frequency.h) and h the step, both integrators are
// stable while h w < 2, whatever the damping, since they integrate damping exactly. At h w = 0.5 the periods
// of velocity_verlet are 1 % short and its energy oscillates by 6 %. A lead time that exceeds the delay of
// the responses by T acts as a damping that is not exact: then sqrt(h (h + 4 T)) w must be below 2, or with
// semi_implicit_euler sqrt(h (h + 2 T)) w.
//
// Responses that are late by a time d feed energy into the body at the rate w^2 d, with lead_time = d at
// about w a^3 / 3, a = w d. Up to a = 0.02 that is 1 % in a minute even at the highest frequency; above 0.1
// the client warns.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simulation/simulation.h"

namespace buoyancy {

inline constexpr double kStabilityLimit = 2.0;  // of h w: unstable from this value on
inline constexpr double kAccuracyLimit = 0.5;   // of h w: warned about above this value
inline constexpr double kLatencyLimit = 0.1;    // of d w: warned about above this value

// Warns if the step is too large for a body in its present state. Sweeps only the bodies for which
// natural_frequency_bound() does not rule that out.
std::optional<Warning> step_warning(const Simulation& simulation);

// Warns, at the same cost, if responses with this delay [s], >= 0, are too late for a body's present state.
std::optional<Warning> latency_warning(const Simulation& simulation, double delay);

// Warns once about the response delay of a free-running simulation, when its mean over a second of simulated
// time, but at least ten steps, is too large.
class LatencyMonitor {
 public:
  std::optional<Warning> update(const Simulation& simulation);  // after every step

 private:
  double sum_ = 0.0;  // [s], sum of the delays in the present window
  std::int64_t steps_ = 0;
  bool warned_ = false;
};

// Warns once about each body whose lowest point is below the sea bed.
class BedMonitor {
 public:
  std::vector<Warning> update(const Simulation& simulation);  // at the start and after every step

 private:
  std::vector<bool> warned_;  // by body of the simulation
};

// Warns if a body has added mass in a received sea, since the velocity of its water is not known here.
std::optional<Warning> received_sea_warning(const Simulation& simulation);

// Warns if the mechanical energy of a body more than doubled: if it rose by more than half the largest
// kinetic energy, and by more than rounding. Nothing in a scene without waves and current adds energy. With
// waves there is no such warning; with a current there is none about bodies with drag or added mass.
std::optional<Warning> energy_warning(const Simulation& simulation);

}  // namespace buoyancy
