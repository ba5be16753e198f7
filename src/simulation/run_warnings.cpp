#include "simulation/run_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/format.h"
#include "simulation/natural_frequency.h"

namespace buoyancy {
namespace {

// Rise, as a fraction of the largest kinetic energy, above which the energy has more than doubled.
constexpr double kMaxEnergyRise = 0.5;
// Rise, as a fraction of m g L, that counts as rounding error.
constexpr double kEnergyNoise = 1e-9;

// Rounds down to two significant digits, so that the recommended value is not too large.
std::string rounded_down(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return format_number(std::floor(value / unit) * unit, 2);
}

struct Worst {
  const SimulatedBody* body = nullptr;
  HighestNaturalFrequency highest;
  int others = 0;  // number of further bodies above the limit
};

// Finds the body with the highest natural frequency, among those above `limit`.
Worst worst_above(const Simulation& simulation, double limit) {
  Worst worst;
  for (const SimulatedBody& body : simulation.bodies()) {
    if (!(natural_frequency_bound(*body.body, body.rigid, simulation.water()) > limit)) continue;
    const HighestNaturalFrequency highest =
        highest_natural_frequency(*body.body, body.rigid, body.state, simulation.water());
    if (!(highest.frequency > limit)) continue;
    if (worst.body != nullptr) ++worst.others;
    if (highest.frequency > worst.highest.frequency) {
      worst.body = &body;
      worst.highest = highest;
    }
  }
  return worst;
}

std::string subject(const SimulatedBody& body, int others) {
  std::string subject = "body " + std::to_string(body.body->id) + " (" + body.body->name + ")";
  if (others > 0) subject += " and " + std::to_string(others) + " more";
  return subject;
}

// Returns the depth under the level of the lowest point of the body's mesh [m] if that is below the bed, else
// nullopt.
std::optional<double> depth_below_bed(const SimulatedBody& body, double bed, const Water& water) {
  const HydrostaticMesh& mesh = body.body->prepared_mesh->mesh;
  const WaterPlane plane = water_plane_in_body(pose_of(body.rigid, body.state), water, mesh.center_B);
  if (plane.up_B.cwiseAbs().dot(mesh.box_max) + plane.h_c <= bed) return std::nullopt;
  const double depth = -lowest_height(mesh, plane);
  return depth > bed ? std::optional(depth) : std::nullopt;
}

std::string describe_frequency(const Worst& worst) {
  return format_text("a body of {:3} kg has natural frequencies up to {:3} rad/s, at a draft of {:3} m",
                     worst.body->rigid.mass, worst.highest.frequency, worst.highest.draft);
}

}  // namespace

std::optional<Warning> step_warning(const Simulation& simulation) {
  const SimulationOptions& options = simulation.options();
  const double step = options.step;
  const double delay = static_cast<double>(options.delay_steps) * step;
  const double lead = (options.integrator == Integrator::kVelocityVerlet ? 2.0 : 1.0) *
                      std::max(options.lead_time - delay, 0.0);
  const double effective_step = std::sqrt(step * (step + 2.0 * lead));
  const Worst worst = worst_above(simulation, kAccuracyLimit / effective_step);
  if (worst.body == nullptr) return std::nullopt;

  const double frequency = worst.highest.frequency;
  const double good = kAccuracyLimit / frequency;
  const double good_step = good * good / (std::sqrt(lead * lead + good * good) + lead);
  const double value = effective_step * frequency;
  Warning warning;
  warning.subject = subject(*worst.body, worst.others);
  warning.actual =
      format_text("step x frequency = {:3} s x {:3} rad/s = {:3}", effective_step, frequency, value);
  if (lead > 0.0)
    warning.actual += format_text(" (effective step: the lead time worsens the step of {:3} s)", step);
  warning.actual += value < kStabilityLimit ? ", stable but inaccurate" : ", unstable";
  warning.expected =
      format_text("at most {:3}; from {:3} on the simulation is unstable", kAccuracyLimit, kStabilityLimit);
  warning.cause = describe_frequency(worst);
  warning.hint = "Use --step " + rounded_down(good_step) + " or less";
  return warning;
}

std::optional<Warning> latency_warning(const Simulation& simulation, double delay) {
  if (!(delay > 0.0)) return std::nullopt;
  const Worst worst = worst_above(simulation, kLatencyLimit / delay);
  if (worst.body == nullptr) return std::nullopt;

  const double frequency = worst.highest.frequency;
  Warning warning;
  warning.subject = subject(*worst.body, worst.others);
  warning.actual = format_text("response delay x frequency = {:3} s x {:3} rad/s = {:3}", delay, frequency,
                               delay * frequency);
  warning.expected = format_text("at most {:3}, with --lead-time set to the delay (now {:3} s)",
                                 kLatencyLimit, simulation.options().lead_time);
  warning.cause =
      "wrenches this late add energy to the body even with a lead time: " + describe_frequency(worst);
  warning.hint = "Reduce the response delay to " + rounded_down(kLatencyLimit / frequency) +
                 " s or less, or use lock-step mode (no --rate, no --delay-steps)";
  return warning;
}

std::optional<Warning> LatencyMonitor::update(const Simulation& simulation) {
  sum_ += simulation.delay();
  ++steps_;
  const double window = std::max(1.0, 10.0 * simulation.options().step);
  if (warned_ || static_cast<double>(steps_) * simulation.options().step < window) return std::nullopt;
  std::optional<Warning> warning = latency_warning(simulation, sum_ / static_cast<double>(steps_));
  warned_ = warning.has_value();
  sum_ = 0.0;
  steps_ = 0;
  return warning;
}

std::vector<Warning> BedMonitor::update(const Simulation& simulation) {
  std::vector<Warning> warnings;
  if (std::isinf(simulation.depth())) return warnings;
  const std::vector<SimulatedBody>& bodies = simulation.bodies();
  warned_.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (warned_[i]) continue;
    const std::optional<double> depth = depth_below_bed(bodies[i], simulation.depth(), simulation.water());
    if (!depth) continue;
    warned_[i] = true;
    warnings.push_back(
        {subject(bodies[i], 0),
         format_text("it is below the sea bed at {:3} s: its lowest point is {:4} m under the level",
                     simulation.time(), *depth),
         format_text("at most the depth of {:4} m", simulation.depth()),
         "the bed does not stop bodies: there is no contact",
         "Below the bed, the waves have the pressure that they have at the bed; do not use the "
         "motion from then on, or give the water its depth there"});
  }
  return warnings;
}

std::optional<Warning> received_sea_warning(const Simulation& simulation) {
  if (!simulation.receives_sea()) return std::nullopt;
  const auto has_added_mass = [](const SimulatedBody& body) {
    return body.hydrodynamics && body.body->hydrodynamics->coefficients().added_mass.has_value();
  };
  const std::vector<SimulatedBody>& bodies = simulation.bodies();
  const auto first = std::ranges::find_if(bodies, has_added_mass);
  if (first == bodies.end()) return std::nullopt;
  return Warning{subject(*first, static_cast<int>(std::count_if(first + 1, bodies.end(), has_added_mass))),
                 "added mass in a sea that the service receives", "waves that the scene describes",
                 "the velocity of the water is not known here, so that a change of the immersed share of the "
                 "added mass acts on the velocity relative to the current alone",
                 "Describe the waves in the scene if the body goes in and out of the water"};
}

std::optional<Warning> energy_warning(const Simulation& simulation) {
  if (simulation.has_waves()) return std::nullopt;  // waves add energy
  const SimulatedBody* worst = nullptr;
  double worst_rise = 0.0;  // as a fraction of the largest kinetic energy
  int bodies = 0;
  for (const SimulatedBody& body : simulation.bodies()) {
    if (simulation.has_current() && body.hydrodynamics) continue;  // the current adds energy
    const EnergyStats& energy = body.energy;
    const double rise = energy.max - energy.initial;
    const double noise =
        kEnergyNoise * body.rigid.mass * simulation.water().gravity * body.body->prepared_mesh->mesh.diagonal;
    if (!(rise > std::max(kMaxEnergyRise * energy.max_kinetic, noise))) continue;
    ++bodies;
    if (worst == nullptr || rise / energy.max_kinetic > worst_rise) {
      worst = &body;
      worst_rise = rise / energy.max_kinetic;
    }
  }
  if (worst == nullptr) return std::nullopt;

  const EnergyStats& energy = worst->energy;
  Warning warning;
  warning.subject = subject(*worst, bodies - 1);
  warning.actual = format_text("mechanical energy rose by {:3} J; the largest kinetic energy is {:3} J",
                               energy.max - energy.initial, energy.max_kinetic);
  warning.expected = "no rise beyond the integrator's error: nothing in the scene adds energy";
  warning.cause =
      "a step too large for the body, late responses without a --lead-time, or an approximate method";
  warning.hint = "Do not trust this run; use a smaller --step, lock-step mode, or an exact method";
  return warning;
}

}  // namespace buoyancy
