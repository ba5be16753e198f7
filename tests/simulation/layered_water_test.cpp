// Simulated bodies in layered water.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulation/run_summary.h"
#include "simulation/run_warnings.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

const std::string kFuelOnWater = "[water]\ndensity = 850\n[[water.layer]]\nbelow = -2\ndensity = 1000\n";

std::string box(const std::string& client) {
  return "[[body]]\nid = 1\nshape = { type = \"box\", size = [1, 0.8, 0.6] }\n[body.client]\n" + client;
}

// A box of 925 kg/m^3 turns on the water under the fuel: its energy has no trend, and its error is of
// order 2.
TEST(LayeredWater, ABodyOnAnInterfaceKeepsItsEnergy) {
  const Scene scene = scene_of(kFuelOnWater + box("density = 925\nposition = [0, 0, -1.9]\norientation = "
                                                  "[0.95, 0.25, 0.1, 0]\n"));
  double ranges[2];
  for (int i = 0; i < 2; ++i) {
    const double step = i == 0 ? 0.02 : 0.01;
    Simulation simulation = simulation_of(scene, {.step = step, .integrator = Integrator::kVelocityVerlet});
    run_in_process(scene, simulation, std::llround(60.0 / step));
    EXPECT_FALSE(energy_warning(simulation));
    const EnergyStats& energy = simulation.bodies()[0].energy;
    EXPECT_GT(energy.max_kinetic, 1.0);
    ranges[i] = (energy.max - energy.min) / energy.max_kinetic;
  }
  EXPECT_LT(ranges[1], 2e-3);
  EXPECT_LT(ranges[1], 0.35 * ranges[0]);
}

TEST(LayeredWater, ABodyStartsAndStaysWhereItFloats) {
  const Scene scene = scene_of(kFuelOnWater + box("density = 925\nstart = \"equilibrium\"\n"));
  Simulation simulation = simulation_of(scene, {.step = 0.01});
  const double height = simulation.bodies()[0].state.center_W.z();
  EXPECT_NEAR(height, -2.0, 1e-12);  // half of its mass in each water
  run_in_process(scene, simulation, 200);
  EXPECT_NEAR(simulation.bodies()[0].state.center_W.z(), height, 1e-9);
}

}  // namespace
}  // namespace buoyancy
