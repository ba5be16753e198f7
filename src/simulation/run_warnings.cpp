#include "simulation/run_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "simulation/natural_frequency.h"

namespace buoyancy {
namespace {

// Of the largest kinetic energy: what a rise has to exceed for the energy to have more than doubled.
constexpr double kDoubled = 0.5;
// Of m g L: a rise that is no more than this is rounding.
constexpr double kNoise = 1e-9;

std::string number(double value, int digits = 3) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

// The next number below with two digits: what is advised must not be a little too large.
std::string rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return number(std::floor(value / unit) * unit, 2);
}

struct Worst {
  const SimulatedBody* body = nullptr;
  HighestNaturalFrequency motion;
  int others = 0;  // bodies beyond the limit, too
};

// The body with the highest frequency, of those whose frequency is above `limit`.
Worst worst_above(const Simulation& simulation, double limit) {
  Worst worst;
  for (const SimulatedBody& body : simulation.bodies()) {
    if (!(natural_frequency_bound(*body.body, body.rigid, simulation.water()) > limit)) continue;
    const HighestNaturalFrequency motion =
        highest_natural_frequency(*body.body, body.rigid, body.state, simulation.water());
    if (!(motion.frequency > limit)) continue;
    if (worst.body != nullptr) ++worst.others;
    if (motion.frequency > worst.motion.frequency) {
      worst.body = &body;
      worst.motion = motion;
    }
  }
  return worst;
}

std::string subject(const SimulatedBody& body, int others) {
  std::string subject = "body " + std::to_string(body.body->id) + " (" + body.body->name + ")";
  if (others > 0) subject += " and " + std::to_string(others) + " more";
  return subject;
}

std::string swing(const Worst& worst) {
  return number(worst.body->rigid.mass) + " kg swing at up to " + number(worst.motion.frequency) +
         " rad/s, with a draft of " + number(worst.motion.draft) + " m";
}

}  // namespace

std::optional<Error> step_warning(const Simulation& simulation) {
  const SimulationOptions& options = simulation.options();
  const double step = options.step;
  const double late = static_cast<double>(options.delay_steps) * step;
  const double lead = (options.integrator == Integrator::kVelocityVerlet ? 2.0 : 1.0) *
                      std::max(options.lead_time - late, 0.0);
  const double effective_step = std::sqrt(step * (step + 2.0 * lead));
  const Worst worst = worst_above(simulation, kAccuracyLimit / effective_step);
  if (worst.body == nullptr) return std::nullopt;

  const double frequency = worst.motion.frequency;
  const double good = kAccuracyLimit / frequency;
  const double good_step = good * good / (std::sqrt(lead * lead + good * good) + lead);
  const double value = effective_step * frequency;
  Error warning;
  warning.subject = subject(*worst.body, worst.others);
  warning.actual = "step x frequency = " + number(effective_step) + " s x " + number(frequency) +
                   " rad/s = " + number(value);
  if (lead > 0.0)
    warning.actual += " (with the lead time, which makes the step of " + number(step) + " s worse)";
  warning.actual += value < kStabilityLimit ? ", stable but inaccurate" : ", which blows up";
  warning.expected = "at most " + number(kAccuracyLimit) + "; from " + number(kStabilityLimit) +
                     " on the motion grows without bound";
  warning.cause = swing(worst);
  warning.hint = "Take --step " + rounded_down(good_step) + " or less";
  return warning;
}

std::optional<Error> latency_warning(const Simulation& simulation, double delay) {
  if (!(delay > 0.0)) return std::nullopt;
  const Worst worst = worst_above(simulation, kLatencyLimit / delay);
  if (worst.body == nullptr) return std::nullopt;

  const double frequency = worst.motion.frequency;
  Error warning;
  warning.subject = subject(*worst.body, worst.others);
  warning.actual = "delay of the responses x frequency = " + number(delay) + " s x " + number(frequency) +
                   " rad/s = " + number(delay * frequency);
  warning.expected = "at most " + number(kLatencyLimit) + ", with --lead-time set to the delay (it is " +
                     number(simulation.options().lead_time) + " s)";
  warning.cause = "wrenches this late give the body energy, with a lead time too: " + swing(worst);
  warning.hint = "Have answers come within " + rounded_down(kLatencyLimit / frequency) +
                 " s, or wait for each of them, without --rate or --late";
  return warning;
}

std::optional<Error> LatencyMonitor::update(const Simulation& simulation) {
  sum_ += simulation.delay();
  ++steps_;
  const double window = std::max(1.0, 10.0 * simulation.options().step);
  if (warned_ || static_cast<double>(steps_) * simulation.options().step < window) return std::nullopt;
  std::optional<Error> warning = latency_warning(simulation, sum_ / static_cast<double>(steps_));
  warned_ = warning.has_value();
  sum_ = 0.0;
  steps_ = 0;
  return warning;
}

std::optional<Error> energy_warning(const Simulation& simulation) {
  const SimulatedBody* worst = nullptr;
  double worst_rise = 0.0;  // of the largest kinetic energy
  int bodies = 0;
  for (const SimulatedBody& body : simulation.bodies()) {
    const EnergyStats& energy = body.energy;
    const double rise = energy.max - energy.initial;
    const double noise =
        kNoise * body.rigid.mass * simulation.water().gravity * body.body->prepared_mesh->mesh.diagonal;
    if (!(rise > std::max(kDoubled * energy.max_kinetic, noise))) continue;
    ++bodies;
    if (worst == nullptr || rise / energy.max_kinetic > worst_rise) {
      worst = &body;
      worst_rise = rise / energy.max_kinetic;
    }
  }
  if (worst == nullptr) return std::nullopt;

  const EnergyStats& energy = worst->energy;
  Error warning;
  warning.subject = subject(*worst, bodies - 1);
  warning.actual = "mechanical energy rose by " + number(energy.max - energy.initial) +
                   " J, of a largest kinetic energy of " + number(energy.max_kinetic) + " J";
  warning.expected = "an energy that never rises but for the step's error: nothing in the scene gives any";
  warning.cause =
      "a step too large for the body, answers that came late without a --lead-time, or a method that "
      "approximates";
  warning.hint = "Do not trust this run; take a smaller --step, lock-step, or an exact method";
  return warning;
}

}  // namespace buoyancy
