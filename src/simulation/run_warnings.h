// What a person has to know before believing a run, because no single answer shows it. Each is an Error in
// form, named by the body that it is worst for; none ends a run.
//
// With w the body's fastest swing (highest_natural_frequency.h) and h the step, both integrators are stable
// while h w < 2, whatever the damping: its part of the step is exact. At h w = 0.5 velocity_verlet's periods
// are 1 % short and its energy swings by 6 %. A lead time T that is longer than the responses are late acts
// as a damping that is not exact: then it is sqrt(h (h + 4 T)) w that must be below 2, for
// semi_implicit_euler sqrt(h (h + 2 T)) w.
//
// Answers late by a time d feed energy into the body at the rate w^2 d, with lead_time = d at about w a^3 /
// 3, a = w d. Up to a = 0.02 that is 1 % in a minute even of the fastest; above 0.1 the client warns.
#pragma once

#include <cstdint>
#include <optional>

#include "simulation/simulation.h"

namespace buoyancy {

inline constexpr double kStabilityLimit = 2.0;  // h w: unstable from here on
inline constexpr double kAccuracyLimit = 0.5;   // h w: warned of above
inline constexpr double kLatencyLimit = 0.1;    // d w: likewise

// The step is too large for a body as it stands now. Sweeps only the bodies for which natural_frequency_bound
// does not rule that out.
std::optional<Error> step_warning(const Simulation& simulation);

// Answers that are `delay` late (s, >= 0) are too late for a body as it stands now; likewise.
std::optional<Error> latency_warning(const Simulation& simulation, double delay);

// Warns of a free-running simulation's lateness once: when its mean over a second of simulated time, but at
// least ten steps, is too much.
class LatencyMonitor {
 public:
  std::optional<Error> update(const Simulation& simulation);  // after every step

 private:
  double sum_ = 0.0;  // s: of delays since the last look
  std::int64_t steps_ = 0;
  bool warned_ = false;
};

// The mechanical energy of a body more than doubled, counted from its least: by more than half its largest
// kinetic energy, and by more than rounding. Nothing in a scene gives a body energy.
std::optional<Error> energy_warning(const Simulation& simulation);

}  // namespace buoyancy
