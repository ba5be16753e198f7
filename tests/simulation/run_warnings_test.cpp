#include "simulation/run_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/simulation/in_process_run.h"
#include "tests/stress/stress_case.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

// A plate of 1 x 1 x 0.2 m that heaves by half its draft: an exact harmonic oscillator, with heave as its
// highest natural frequency.
std::string plate(int id, double relative_density) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(),
                "[[body]]\nid = %d\nname = \"plate %d\"\nshape = { type = \"box\", size = [1, 1, 0.2] }\n"
                "[body.client]\ndensity = %.17g\nposition = [%d, 0, %.17g]\n",
                id, id, 1000.0 * relative_density, 5 * id, 0.1 - 0.1 * relative_density);
  return text.data();
}
const std::string kWater = "[water]\ndensity = 1000\n";

double frequency_of_plate(double relative_density) {
  return std::sqrt(kStandardGravity / (0.2 * relative_density));
}

bool contains(const std::optional<Warning>& warning, const std::string& text) {
  return warning && warning->message().find(text) != std::string::npos;
}

TEST(StepWarning, PredictsInstabilityFrom10HertzTo1Kilohertz) {
  StressCase stress("1 kHz to 10 Hz steps, stiff light bodies", "w h; 2,000 steps of the body itself",
                    "warning if and only if w h > 0.5; as unstable from 2 on");
  int accurate = 0;
  int inaccurate = 0;
  int unstable = 0;
  for (const double relative_density : {0.5, 0.1, 0.02, 0.004}) {
    const Scene scene = scene_of(kWater + plate(1, relative_density));
    for (const double step : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1}) {
      for (const Integrator integrator : kBothIntegrators) {
        Simulation simulation = simulation_of(scene, {.step = step, .integrator = integrator});
        const double wh = frequency_of_plate(relative_density) * step;
        SCOPED_TRACE("w h = " + std::to_string(wh) + ", " + std::string(to_string(integrator)));
        const std::optional<Warning> warning = step_warning(simulation);
        const std::int64_t steps = wh < kStabilityLimit ? 2000 : 500;  // before the energy reaches its limit
        run_in_process(scene, simulation, steps);
        const EnergyStats& energy = simulation.bodies().front().energy;
        if (wh <= kAccuracyLimit) {
          EXPECT_FALSE(warning) << warning->message();
          EXPECT_FALSE(energy_warning(simulation));
          const double oscillation = integrator == Integrator::kVelocityVerlet ? 0.25 * wh * wh : wh;
          EXPECT_LT(energy.max - energy.min, 1.1 * oscillation * energy.max_kinetic);
          ++accurate;
        } else if (wh < kStabilityLimit) {
          EXPECT_TRUE(contains(warning, "stable but inaccurate"));
          ++inaccurate;
        } else {
          EXPECT_TRUE(contains(warning, ", unstable"));
          EXPECT_TRUE(contains(energy_warning(simulation), "energy rose"));
          ++unstable;
        }
        stress.require(warning.has_value() == (wh > kAccuracyLimit), "w h = " + std::to_string(wh));
      }
    }
  }
  EXPECT_GE(accurate, 10);
  EXPECT_GE(inaccurate, 10);
  EXPECT_GE(unstable, 4);
}

TEST(StepWarning, RecommendsAcceptableStep) {
  for (const double lead_time : {0.0, 0.02, 1.0}) {
    for (const Integrator integrator : kBothIntegrators) {
      const Scene scene = scene_of(kWater + plate(1, 0.02));
      SimulationOptions options{.step = 0.1, .integrator = integrator};
      options.lead_time = lead_time;
      const std::optional<Warning> warning = step_warning(simulation_of(scene, options));
      ASSERT_TRUE(warning);
      double recommended = 0.0;
      ASSERT_EQ(std::sscanf(warning->hint.c_str(), "Use --step %lf or less", &recommended), 1)
          << warning->hint;
      options.step = recommended;
      EXPECT_FALSE(step_warning(simulation_of(scene, options))) << recommended;
      options.step = 1.15 * recommended;
      EXPECT_TRUE(step_warning(simulation_of(scene, options))) << recommended;
    }
  }
}

TEST(StepWarning, NamesWorstBodyAndCountsOthers) {
  const Scene scene = scene_of(kWater + plate(1, 0.5) + plate(3, 0.02) + plate(2, 0.004) + plate(4, 0.02));
  const std::optional<Warning> warning = step_warning(simulation_of(scene, {.step = 0.02}));
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->subject, "body 2 (plate 2) and 2 more");
  for (const char* figure : {"0.02 s", "111 rad/s", "2.21", "0.8 kg", "--step 0.0045"}) {
    EXPECT_TRUE(contains(warning, figure)) << figure << ": " << warning->message();
  }
}

TEST(StepWarning, AppliesToBodyAboveWater) {
  const Scene scene = scene_of(kWater + plate(1, 0.02) + "linear_velocity = [0, 0, 10]\n");
  EXPECT_TRUE(step_warning(simulation_of(scene, {.step = 0.02})));
}

TEST(StepWarning, IgnoresDamping) {
  // A plate at w h = 0.49, with a damping rate of 1e6 per step.
  const double step = 0.49 / frequency_of_plate(0.1);
  const Scene scene =
      scene_of(kWater + plate(1, 0.1) +
               "linear_damping = 1e9\nangular_damping = 1e9\nlinear_damping_quadratic = 1e9\n");
  for (const Integrator integrator : kBothIntegrators) {
    Simulation simulation = simulation_of(scene, {.step = step, .integrator = integrator});
    EXPECT_FALSE(step_warning(simulation));
    run_in_process(scene, simulation, 2000);
    EXPECT_LE(simulation.bodies().front().energy.max, simulation.bodies().front().energy.initial);
  }
}

TEST(StepWarning, CountsAddedMass) {
  const double density = 0.01;
  const double step = 0.03;
  const std::string body = kWater + plate(1, density);
  EXPECT_GT(frequency_of_plate(density) * step, kStabilityLimit);
  const SimulationOptions options{.step = step};
  EXPECT_TRUE(step_warning(simulation_of(scene_of(body), options)));
  const Scene heavy =
      scene_of(body + "[body.added_mass]\nmatrix = [50, 50, 50, 9, 9, 9]\nimmersion = \"none\"\n");
  Simulation simulation = simulation_of(heavy, options);
  const std::optional<Warning> warning = step_warning(simulation);
  EXPECT_FALSE(warning) << warning->message();
  run_in_process(heavy, simulation, 2000);
  EXPECT_FALSE(energy_warning(simulation));
}

TEST(StepWarning, AccountsForExcessLeadTime) {
  // Stability limits: h (h + 2 T) w^2 = 4 for semi-implicit Euler, h (h + 4 T) w^2 = 4 for Verlet.
  const double w = frequency_of_plate(0.1);
  const Scene scene = scene_of(kWater + plate(1, 0.1));
  for (const Integrator integrator : kBothIntegrators) {
    for (const double lead_time : {0.2 / w, 3.0 / w}) {
      const double lead = (integrator == Integrator::kVelocityVerlet ? 2.0 : 1.0) * lead_time;
      const double limit = std::sqrt(lead * lead + 4.0 / (w * w)) - lead;
      for (const double factor : {0.97, 1.03}) {
        SimulationOptions options{.step = factor * limit, .integrator = integrator};
        options.lead_time = lead_time;
        Simulation simulation = simulation_of(scene, options);
        const std::optional<Warning> warning = step_warning(simulation);
        EXPECT_TRUE(contains(warning, factor < 1.0 ? "stable but inaccurate" : ", unstable")) << factor;
        EXPECT_TRUE(contains(warning, "lead time"));
        // Below the limit the lead time damps the motion out; beyond it the motion continues.
        double min_height = 1.0;
        double max_height = -1.0;
        run_in_process(scene, simulation, 3000, [&](const Simulation& now) {
          if (now.step_number() < 2900) return;
          const double height = now.bodies().front().state.center_W.z();
          min_height = std::min(min_height, height);
          max_height = std::max(max_height, height);
        });
        EXPECT_EQ(max_height - min_height > 1e-4, factor > 1.0)
            << to_string(integrator) << " " << lead_time << " " << factor << ": " << max_height - min_height;
      }
    }
  }
}

TEST(LatencyWarning, AppearsAboveOneTenthRadian) {
  const Scene scene = scene_of(kWater + plate(1, 0.5) + plate(2, 0.1));
  const double w = frequency_of_plate(0.1);
  const Simulation simulation = simulation_of(scene, {});
  EXPECT_FALSE(latency_warning(simulation, 0.0));
  EXPECT_FALSE(latency_warning(simulation, 0.099 / w));
  const std::optional<Warning> warning = latency_warning(simulation, 0.101 / w);
  EXPECT_TRUE(contains(warning, "body 2 (plate 2)"));
  EXPECT_TRUE(contains(warning, "= 0.101")) << warning->message();
  EXPECT_TRUE(contains(latency_warning(simulation, 1.0), "and 1 more"));
}

TEST(LatencyMonitor, WarnsOnceAboutMeanDelay) {
  const Scene scene = scene_of(kWater + plate(1, 0.5) + "linear_damping = 1000\n");
  const double w = frequency_of_plate(0.5);
  const double step = 0.02 / w;
  for (const std::int64_t delay_steps : {4, 6}) {
    SimulationOptions options{.step = step};
    options.delay_steps = delay_steps;
    Simulation simulation = simulation_of(scene, options);
    LatencyMonitor monitor;
    int warnings = 0;
    double first = -1.0;
    run_in_process(scene, simulation, 2000, [&](const Simulation& now) {
      if (!monitor.update(now)) return;
      if (++warnings == 1) first = now.time();
    });
    EXPECT_EQ(warnings, delay_steps == 6 ? 1 : 0);
    if (warnings > 0) {
      EXPECT_NEAR(first, 1.0, 2.0 * step);
    }
  }
}

TEST(EnergyWarning, IgnoresRoundingOfBodyAtRest) {
  // One nanometre from rest: the rounding error of the energy exceeds the kinetic energy.
  const Scene scene = scene_of(
      "[water]\ndensity = 1000\nlevel = 1e3\n[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 0.3] "
      "}\n"
      "[body.client]\ndensity = 300\nposition = [0, 0, 1000.060000001]\n");
  for (const Integrator integrator : kBothIntegrators) {
    const Simulation simulation = simulation_after(scene, {.step = 0.01, .integrator = integrator}, 20'000);
    EXPECT_FALSE(energy_warning(simulation));
  }
}

TEST(EnergyWarning, IgnoresWorkOfTheCurrent) {
  const std::string body = plate(1, 0.5) + "[body.drag]\nlinear = [900, 900, 900, 9, 9, 9]\n";
  const Scene scene = scene_of(kWater + "[water.current]\nvelocity = [1, 0, 0]\n" + body);
  const Simulation simulation = simulation_after(scene, {.step = 0.01}, 2000);
  const EnergyStats& energy = simulation.bodies().front().energy;
  EXPECT_GT(energy.max - energy.initial, 0.5 * energy.max_kinetic);
  EXPECT_FALSE(energy_warning(simulation));
}

const std::string kRipples = "[[water.waves]]\ntype = \"regular\"\nheight = 0.02\nperiod = 2.0\n";

TEST(BedMonitor, WarnsOnceAboutEachBodyBelowTheBed) {
  const Scene scene =
      scene_of(kWater + "depth = 5\n" + kRipples + plate(1, 0.5) + plate(2, 1.5) + plate(3, 1.2));
  Simulation simulation = simulation_of(scene, {.step = 0.01});
  BedMonitor monitor;
  std::vector<std::string> subjects;
  double time = 0.0;
  run_in_process(scene, simulation, 270, [&](const Simulation& now) {
    for (const Warning& warning : monitor.update(now)) {
      subjects.push_back(warning.subject);
      EXPECT_TRUE(contains(warning, "the bed does not stop bodies")) << warning.message();
      if (subjects.size() == 1) time = now.time();
    }
  });
  EXPECT_EQ(subjects, (std::vector<std::string>{"body 2 (plate 2)", "body 3 (plate 3)"}));
  // The lower face of plate 2 falls with a third of g from 0.15 m to 5 m, at first faster: its top is dry.
  EXPECT_NEAR(time, std::sqrt(2.0 * (5.0 - 0.15) / (kStandardGravity / 3.0)), 0.1);
}

TEST(BedMonitor, KnowsNoBedInDeepWater) {
  const Scene scene = scene_of(kWater + kRipples + plate(1, 3.0));
  Simulation simulation = simulation_of(scene, {.step = 0.1});
  BedMonitor monitor;
  run_in_process(scene, simulation, 100,
                 [&](const Simulation& now) { EXPECT_TRUE(monitor.update(now).empty()); });
}

TEST(ReceivedSeaWarning, NamesBodiesWithAddedMass) {
  const std::string added = "[body.added_mass]\nmatrix = [50, 50, 50, 9, 9, 9]\n";
  const std::string bodies = plate(1, 0.5) + plate(2, 0.5) + added + plate(3, 0.5) + added;
  const std::string received = kWater + "waves = \"received\"\n";
  EXPECT_TRUE(contains(received_sea_warning(simulation_of(scene_of(received + bodies), {})),
                       "body 2 (plate 2) and 1 more"));
  EXPECT_FALSE(received_sea_warning(simulation_of(scene_of(received + plate(1, 0.5)), {})));
  EXPECT_FALSE(received_sea_warning(simulation_of(scene_of(kWater + kRipples + bodies), {})));
}

TEST(EnergyLimit, AcceptsViolentMotions) {
  // Falls from 100 m, and a float of 2 kg that shoots up from 100 m.
  for (const std::string body : {"density = 300\nposition = [0, 0, 100]\norientation = [0.9, 0.3, 0.3, 0]\n",
                                 "density = 10\nposition = [0, 0, -100]\n"}) {
    const Scene scene =
        scene_of(kWater + kRipples + "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 1, 0.2] }\n" +
                 "[body.client]\n" + body);
    Simulation simulation = simulation_of(scene, {.step = 0.002});
    double fastest = 0.0;
    run_in_process(scene, simulation, 6000, [&](const Simulation& now) {
      fastest = std::max(fastest, now.bodies().front().state.velocity_W.norm());
    });
    EXPECT_GT(fastest, 40.0) << body;
  }
}

}  // namespace
}  // namespace buoyancy
