// Compares the simulator with closed forms over long times: energy, order and period of an undamped heave,
// with and without delayed responses.
//
// A wall-sided body that heaves within its sides is an exact harmonic oscillator, w^2 = rho g A_wp / m, and
// both integrators have closed forms for it (integrator_test). Tests with a StressCase fill rows of the
// stress catalogue (docs/stability.md, "In time").
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/run_warnings.h"
#include "tests/simulation/in_process_run.h"
#include "tests/stress/stress_case.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kDensity = 1000.0;  // [kg/m^3], of the water

// A box of 12 triangles and half the water's density, released a quarter of its draft above its equilibrium.
struct HeavingBox {
  double draft = 0.2;  // [m], half its height
  double width = 1.0;  // [m], in both horizontal directions

  double amplitude() const { return 0.25 * draft; }                         // [m]
  double frequency() const { return std::sqrt(kStandardGravity / draft); }  // [rad/s]
  // Energy of the motion [J].
  double energy() const {
    return 0.5 * kDensity * kStandardGravity * width * width * amplitude() * amplitude();
  }

  Scene scene() const {
    std::array<char, 256> text{};
    std::snprintf(text.data(), text.size(),
                  "[water]\ndensity = 1000\n[[body]]\nid = 1\nname = \"box\"\n"
                  "shape = { type = \"box\", size = [%g, %g, %g] }\n"
                  "[body.client]\ndensity = 500\nposition = [0, 0, %.17g]\n",
                  width, width, 2.0 * draft, amplitude());
    return scene_of(text.data());
  }
};

double energy_error(const SimulatedBody& body) {
  return std::abs(body.energy.current - body.energy.initial);
}

struct EnergyErrors {
  double early = 0.0;  // [J], maximum over the first tenth of a run
  double late = 0.0;   // [J], maximum over the last tenth
};

EnergyErrors energy_errors(const Scene& scene, Integrator integrator, double step, std::int64_t steps) {
  Simulation simulation = simulation_of(scene, {.step = step, .integrator = integrator});
  EnergyErrors errors;
  run_in_process(scene, simulation, steps, [&](const Simulation& now) {
    const double error = energy_error(now.bodies().front());
    if (10 * now.step_number() < steps) errors.early = std::max(errors.early, error);
    if (10 * now.step_number() >= 9 * steps) errors.late = std::max(errors.late, error);
  });
  EXPECT_FALSE(energy_warning(simulation));
  return errors;
}

TEST(UndampedHeave, BoundsEnergyErrorOverOneMillionSteps) {
  const HeavingBox box;
  const Scene scene = box.scene();
  const double step = 0.01;
  const double wh = box.frequency() * step;
  StressCase stress("undamped heave, 1e6 steps: energy bounded", "the integrators' closed forms",
                    "the integrator's oscillation + 5 %; in the last tenth that of the first + 5 %");
  for (const Integrator integrator : kBothIntegrators) {
    const EnergyErrors errors = energy_errors(scene, integrator, step, 1'000'000);
    const double oscillation = integrator == Integrator::kVelocityVerlet ? 0.25 * wh * wh : 0.5 * wh;
    const std::string at(to_string(integrator));
    stress.check(errors.early, 1.05 * oscillation * box.energy(), at + ", first tenth");
    stress.check(errors.late, 1.05 * errors.early, at + ", last tenth");
  }
}

TEST(UndampedHeave, BoundsEnergyErrorWithRollAndPitch) {
  const Scene scene = scene_of(
      "[water]\ndensity = 1000\n[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 0.8, 0.4] }\n"
      "[body.client]\ndensity = 500\nposition = [0, 3, 0.03]\norientation = [0.999, 0.03, 0.02, 0]\n");
  for (const Integrator integrator : kBothIntegrators) {
    const EnergyErrors errors = energy_errors(scene, integrator, 0.01, 200'000);
    EXPECT_LT(errors.late, 1.1 * errors.early) << to_string(integrator);
  }
}

// Slope of log(error) over log(step), by least squares, for the heaving box after one second.
double fitted_order(Integrator integrator) {
  const HeavingBox box;
  const Scene scene = box.scene();
  std::vector<double> x;
  std::vector<double> y;
  for (const int steps : {200, 400, 800, 1600, 3200}) {
    const Simulation simulation =
        simulation_after(scene, {.step = 1.0 / steps, .integrator = integrator}, steps);
    const RigidBodyState& state = simulation.bodies().front().state;
    const double height = box.amplitude() * std::cos(box.frequency());
    const double speed = -box.amplitude() * box.frequency() * std::sin(box.frequency());
    x.push_back(-std::log(steps));
    y.push_back(
        std::log(std::hypot(state.center_W.z() - height, (state.velocity_W.z() - speed) / box.frequency())));
  }
  const auto n = static_cast<double>(x.size());
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

TEST(UndampedHeave, ConvergesWithOrderOneOrTwo) {
  StressCase stress("undamped heave: order in the step", "closed form; steps of 1/200 to 1/3200 s",
                    "order 1 (semi-implicit Euler), 2 (Verlet), +- 0.05");
  const auto check = [&](Integrator integrator, double order) {
    stress.check(std::abs(fitted_order(integrator) - order), 0.05, std::string(to_string(integrator)));
  };
  check(Integrator::kSemiImplicitEuler, 1.0);
  check(Integrator::kVelocityVerlet, 2.0);
}

TEST(UndampedHeave, MatchesPeriodOfWallSidedBodies) {
  struct {
    std::string shape;
    double area;    // [m^2]
    double height;  // [m]
  } const shapes[] = {
      {R"({ type = "box", size = [1, 1, 0.4] })", 1.0, 0.4},
      {R"({ type = "box", size = [3, 0.7, 0.3], segments = [4, 3, 2] })", 2.1, 0.3},
      // The mesh is a prism of 24 sides.
      {R"({ type = "cylinder", radius = 0.5, height = 0.4, segments = 24, stacks = 2 })",
       12.0 * 0.25 * std::sin(2.0 * std::numbers::pi / 24.0), 0.4},
  };
  StressCase stress("heave period: wall-sided bodies", "2 pi sqrt(m / (rho g A_wp)), corrected for Verlet",
                    "1e-6 of the period");
  for (const auto& shape : shapes) {
    for (const double relative_density : {0.2, 0.5, 0.9}) {
      // At rest the body's centre is (1/2 - s) H above the level.
      const double amplitude = 1e-3;
      const double rest = (0.5 - relative_density) * shape.height;
      const Scene scene = scene_of("[water]\ndensity = 1000\n[[body]]\nid = 1\nshape = " + shape.shape +
                                   "\n[body.client]\ndensity = " + std::to_string(1000.0 * relative_density) +
                                   "\nposition = [0, 0, " + std::to_string(rest + amplitude) + "]\n");
      const double mass = kDensity * relative_density * shape.area * shape.height;
      const double period =
          2.0 * std::numbers::pi * std::sqrt(mass / (kDensity * kStandardGravity * shape.area));

      const double step = 2e-3;
      Simulation simulation = simulation_of(scene, {.step = step});
      PeriodMeter meter;
      run_in_process(scene, simulation, 20'000, [&](const Simulation& now) {
        meter.update(now.bodies().front().state.center_W.z() - rest, now.time(), step);
      });
      // The period of velocity Verlet is T (1 - (w h)^2 / 24).
      const double wh = 2.0 * std::numbers::pi / period * step;
      stress.check(std::abs(meter.mean() - period * (1.0 - wh * wh / 24.0)), 1e-6 * period,
                   shape.shape + ", relative density " + std::to_string(relative_density));
      EXPECT_NEAR(meter.mean(), period, wh * wh / 23.0 * period) << shape.shape << " " << relative_density;
    }
  }
}

struct DelayedRun {
  double max_error = 0.0;     // energy error / initial energy of the motion
  double final_growth = 0.0;  // final / initial energy of the motion
  bool warned = false;
};

// Simulates one minute with wrenches that are `delay_steps` steps, together `delay` [s], late.
DelayedRun delayed_run(const HeavingBox& box, Integrator integrator, std::int64_t delay_steps, double delay,
                       bool with_lead_time) {
  SimulationOptions options{.step = delay / static_cast<double>(delay_steps), .integrator = integrator};
  options.delay_steps = delay_steps;
  options.lead_time = with_lead_time ? delay : 0.0;
  const Scene scene = box.scene();
  Simulation simulation = simulation_of(scene, options);
  DelayedRun run;
  run_in_process(scene, simulation, std::llround(60.0 / options.step), [&](const Simulation& now) {
    run.max_error = std::max(run.max_error, energy_error(now.bodies().front()) / box.energy());
  });
  const EnergyStats& energy = simulation.bodies().front().energy;
  run.final_growth = 1.0 + (energy.current - energy.initial) / box.energy();
  run.warned = energy_warning(simulation).has_value();
  EXPECT_NEAR(simulation.delay(), delay, 1e-12);
  return run;
}

TEST(DelayedResponse, KeepsEnergyWithinOnePercentWithLeadTime) {
  const HeavingBox box;
  StressCase stress("wrench one and five steps late, `lead_time` set, alpha = w delay <= 0.02",
                    "the energy at the start, over 60 s", "1 % (Euler: plus its own oscillation)");
  for (const std::int64_t delay_steps : {1, 5}) {
    for (const double alpha : {0.02, 0.01}) {
      const std::string at =
          ", " + std::to_string(delay_steps) + " late, alpha " + (alpha == 0.02 ? "0.02" : "0.01");
      const DelayedRun verlet =
          delayed_run(box, Integrator::kVelocityVerlet, delay_steps, alpha / box.frequency(), true);
      stress.check(verlet.max_error, 0.01, "Verlet" + at);
      // The limit adds the energy oscillation of this integrator itself.
      const DelayedRun euler =
          delayed_run(box, Integrator::kSemiImplicitEuler, delay_steps, alpha / box.frequency(), true);
      stress.check(euler.max_error, 0.01 + 0.5 * alpha / static_cast<double>(delay_steps), "Euler" + at);
      EXPECT_FALSE(verlet.warned || euler.warned);
    }
  }
}

TEST(DelayedResponse, AddsEnergyWithoutLeadTime) {
  // The energy grows at the rate w^2 delay: threefold in a minute. The box is large and slow, so that this
  // delay is only a few steps.
  const HeavingBox box{5.0, 20.0};
  const double delay = std::log(3.0) / (60.0 * box.frequency() * box.frequency());
  StressCase stress("same delay without and with `lead_time`: energy threefold in 60 s, or unchanged",
                    "exp(w^2 delay t)", "+- 0.05; +- 0.01; a warning without");
  for (const Integrator integrator : kBothIntegrators) {
    for (const std::int64_t delay_steps : {1, 5}) {
      const DelayedRun without_lead = delayed_run(box, integrator, delay_steps, delay, false);
      const std::string at =
          std::string(to_string(integrator)) + ", " + std::to_string(delay_steps) + " late";
      stress.check(std::abs(without_lead.final_growth - 3.0), 0.05, at);
      stress.require(without_lead.warned, at + ", warning");
      const DelayedRun with_lead = delayed_run(box, integrator, delay_steps, delay, true);
      stress.check(std::abs(with_lead.final_growth - 1.0), 0.01, at + ", with lead time");
    }
  }
}

TEST(DelayedResponse, UsesFirstResponseUntilDelayHasPassed) {
  SimulationOptions options{.step = 0.01};
  options.delay_steps = 3;
  const HeavingBox box;
  const Scene scene = box.scene();
  Simulation simulation = simulation_of(scene, options);
  std::vector<double> heights;
  run_in_process(scene, simulation, 20, [&](const Simulation& now) {
    const SimulatedBody& body = now.bodies().front();
    heights.push_back(body.state.center_W.z());
    const std::size_t requested = heights.size() > 3 ? heights.size() - 4 : 0;
    ASSERT_NEAR(body.wrench.submerged_volume, box.draft - heights[requested], 1e-14) << heights.size();
    ASSERT_NEAR(now.delay(), 0.01 * static_cast<double>(heights.size() - 1 - requested), 1e-15);
  });
}

TEST(DelayedResponse, ReportsEnergyOfCurrentPose) {
  const HeavingBox box;
  const Scene scene = box.scene();
  for (const std::int64_t delay_steps : {0, 3}) {
    for (const double lead_time : {0.0, 0.03}) {
      SimulationOptions options{.step = 0.01};
      options.delay_steps = delay_steps;
      options.lead_time = lead_time;
      Simulation simulation = simulation_of(scene, options);
      run_in_process(scene, simulation, 50, [&](const Simulation& now) {
        const SimulatedBody& body = now.bodies().front();
        const double mass = kDensity * box.draft;
        const double height = body.state.center_W.z();
        const double depth = box.draft - height;
        // The centre of buoyancy of a prism of 1 m^2 is at half its depth.
        const double energy = 0.5 * mass * body.state.velocity_W.squaredNorm() +
                              mass * kStandardGravity * height +
                              0.5 * kDensity * kStandardGravity * depth * depth;
        ASSERT_NEAR(body.energy.current, energy, 1e-10) << delay_steps << " " << lead_time;
      });
    }
  }
}

}  // namespace
}  // namespace buoyancy
