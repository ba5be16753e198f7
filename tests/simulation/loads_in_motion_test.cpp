// What bodies with drag and added mass do, each against its closed form, in the simulator's own process.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "messages/conversions.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {
namespace {

constexpr double kDensity = 1000.0;  // [kg/m^3], of the water
const std::string kWater = "[water]\ndensity = 1000\n";

const SimulatedBody& only_body(const Simulation& simulation) {
  return simulation.bodies().front();
}

TEST(Drag, GivesTerminalVelocityOfReleasedSphere) {
  for (const double density : {7800.0, 100.0}) {
    const Scene scene = scene_of(kWater + R"(
[[body]]
id = 1
shape = { type = "sphere", radius = 0.1, segments = 16 }
[body.drag]
linear = [2, 2, 2, 0.1, 0.1, 0.1]
quadratic = [15, 15, 15, 0.1, 0.1, 0.1]
[body.added_mass]
matrix = [2, 2, 2, 0, 0, 0]
[body.client]
position = [0, 0, -500]
density = )" + std::to_string(density) +
                                 "\n");
    const double volume = scene.bodies().front().prepared_mesh->mass_properties.volume;
    const double weight = (density - kDensity) * volume * kStandardGravity;  // in water
    // 15 v^2 + 2 v = weight.
    const double terminal = (std::sqrt(1.0 + 15.0 * std::abs(weight)) - 1.0) / 15.0;
    for (const Integrator integrator : kBothIntegrators) {
      for (const double step : {0.001, 0.1}) {
        const auto steps = static_cast<std::int64_t>(std::lround(20.0 / step));
        const Simulation simulation =
            simulation_after(scene, {.step = step, .integrator = integrator}, steps);
        const SimulatedBody& body = only_body(simulation);
        EXPECT_NEAR(-body.state.velocity_W.z(), std::copysign(terminal, weight), 1e-6 * terminal)
            << density << ", " << step;
      }
    }
  }
}

TEST(Drag, NeitherOvershootsNorAlternatesHoweverLarge) {
  const Scene scene = scene_of(kWater + R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 0.5, 0.3] }
[body.drag]
linear = [1e3, 1e6, 1e12, 1e3, 1e6, 1e12]
quadratic = [1e9, 1e3, 0, 1e9, 1e3, 0]
[body.added_mass]
matrix = [100, 2000, 5000, 10, 200, 500]
[body.client]
density = 1000
position = [0, 0, -50]
linear_velocity = [3, 2, 1]
angular_velocity = [0.3, 0.2, 0.1]
)");
  for (const Integrator integrator : kBothIntegrators) {
    Simulation simulation = simulation_of(scene, {.step = 0.1, .integrator = integrator});
    double before = INFINITY;
    double largest_growth = 0.0;
    run_in_process(scene, simulation, 100, [&](const Simulation& now) {
      const SimulatedBody& body = only_body(now);
      const double energy =
          kinetic_energy(body.rigid, body.state) + body.hydrodynamics->added_kinetic_energy(body.state);
      // The rounding of buoyancy and weight leaves 1e-40 J.
      largest_growth = std::max(largest_growth, energy - before * (1.0 + 1e-12));
      before = energy;
    });
    EXPECT_LT(largest_growth, 1e-30);
    EXPECT_LT(only_body(simulation).state.velocity_W.norm(), 1e-3);
  }
}

TEST(Drag, SlowsMotionAlongAnAxisWithoutChangeOfSign) {
  // The rate of the decay, times the step of 0.1 s, is 1e-4 to 1e8.
  for (int exponent = -4; exponent <= 8; ++exponent) {
    const double drag = 2000.0 * std::pow(10.0, exponent);
    const std::string six = "[" + std::to_string(drag) + ", 0, 0, 0, 0, 0]\n";
    for (const char* key : {"linear = ", "quadratic = "}) {
      const Scene scene = scene_of(kWater + R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 0.5, 0.4] }
[body.drag]
)" + key + six + R"([body.client]
density = 1000
position = [0, 0, -50]
linear_velocity = [1, 0, 0]
)");
      Simulation simulation = simulation_of(scene, {.step = 0.1});
      double before = 1.0;
      bool decreases = true;
      run_in_process(scene, simulation, 50, [&](const Simulation& now) {
        const double velocity = only_body(now).state.velocity_W.x();
        decreases = decreases && velocity >= -1e-15 && velocity <= before * (1.0 + 1e-12) + 1e-15;
        before = velocity;
      });
      EXPECT_TRUE(decreases) << key << drag;
    }
  }
}

TEST(Drag, IsHalvedForHalfSubmergedBodyAndAbsentInAir) {
  // The box floats with half of it submerged, or flies.
  for (const double height : {0.0, 50.0}) {
    const Scene scene = scene_of(kWater + R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.4] }
[body.drag]
linear = [400, 400, 400, 0, 0, 0]
[body.client]
density = 500
linear_velocity = [2, 0, 0]
position = [0, 0, )" + std::to_string(height) +
                                 "]\n");
    const Simulation simulation = simulation_after(scene, {.step = 0.001}, 1000);
    const SimulatedBody& body = only_body(simulation);
    const double expected = height > 0.0 ? 2.0 : 2.0 * std::exp(-0.5 * 400.0 / 200.0);
    EXPECT_NEAR(body.state.velocity_W.x(), expected, 1e-6) << height;
    EXPECT_NEAR(body.wrench.force[0], height > 0.0 ? 0.0 : -200.0 * expected, 1e-3) << height;
  }
}

TEST(Drag, CarriesFreeBodyAlongWithTheCurrent) {
  const Scene scene = scene_of(kWater + R"(
[water.current]
velocity = [0.5, -0.2, 0]
[[body]]
id = 1
shape = { type = "sphere", radius = 0.2, segments = 12 }
[body.drag]
linear = [50, 50, 50, 1, 1, 1]
quadratic = [20, 20, 20, 1, 1, 1]
[body.added_mass]
matrix = [17, 17, 17, 0, 0, 0]
[body.client]
density = 1000
position = [0, 0, -20]
)");
  const Simulation simulation = simulation_after(scene, {.step = 0.01}, 3000);
  const SimulatedBody& body = only_body(simulation);
  EXPECT_LT((body.state.velocity_W - Vec3(0.5, -0.2, 0.0)).norm(), 1e-9);
  const double weight = body.rigid.mass * kStandardGravity;
  EXPECT_LT((to_vec3(body.wrench.force) - Vec3(0, 0, weight)).norm(), 1e-9 * weight);
}

// A slender body under water that moves obliquely.
std::string slender(const std::string& more) {
  return kWater + R"(
[[body]]
id = 1
shape = { type = "box", size = [2, 0.3, 0.3] }
[body.added_mass]
matrix = [10, 170, 170, 0, 50, 50]
[body.client]
density = 1000
position = [0, 0, -50]
linear_velocity = [1, 0.2, 0]
)" + more;
}

TEST(AddedMass, TurnsSlenderBodyBroadsideOn) {
  const Scene scene = scene_of(slender("angular_damping = 20\n"));
  const double step = 1e-4;
  // Munk's moment N = -(A22 - A11) u v, on the inertia of body and water.
  const Simulation first = simulation_after(scene, {.step = step}, 1);
  const double moment = -(170.0 - 10.0) * 1.0 * 0.2;
  EXPECT_NEAR(only_body(first).wrench.torque[2], moment, 1e-3 * std::abs(moment));
  const double inertia = 1000.0 * 0.18 * (4.0 + 0.09) / 12.0 + 50.0;
  const double rate = angular_velocity_W(only_body(first).rigid, only_body(first).state).z() / step;
  EXPECT_NEAR(rate, moment / inertia, 1e-3 * std::abs(moment / inertia));

  const Simulation last = simulation_after(scene, {.step = 0.01}, 20'000);
  const Vec3 velocity_B = only_body(last).state.q_WB.conjugate() * only_body(last).state.velocity_W;
  EXPECT_LT(std::abs(velocity_B.x()), 0.02 * std::abs(velocity_B.y()));
}

// The mean period of the heave of a box of 1 x 1 x 0.4 m that floats at half its height.
double heave_period(const std::string& added_mass, double step, std::int64_t steps) {
  const Scene scene = scene_of(kWater + R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.4] }
[body.added_mass]
matrix = [0, 0, )" + added_mass +
                               R"(
[body.client]
density = 500
position = [0, 0, 0.002]
)");
  Simulation simulation = simulation_of(scene, {.step = step});
  PeriodMeter meter;
  run_in_process(scene, simulation, steps, [&](const Simulation& now) {
    meter.update(only_body(now).state.center_W.z(), now.time(), step);
  });
  EXPECT_GE(meter.periods(), 3);
  const SimulatedBody& body = only_body(simulation);
  EXPECT_LT(body.energy.max - body.energy.min, 1e-3 * body.energy.max_kinetic);
  return meter.mean();
}

TEST(AddedMass, LengthensHeavePeriod) {
  const double stiffness = kDensity * kStandardGravity;
  const auto period = [&](double mass) { return 2.0 * std::numbers::pi * std::sqrt(mass / stiffness); };
  for (const double added : {0.0, 200.0, 4000.0}) {
    const std::string number = std::to_string(added) + ", 0, 0, 0]\nimmersion = ";
    EXPECT_NEAR(heave_period(number + "\"none\"", 0.001, 20'000) / period(200.0 + added), 1.0, 1e-3) << added;
    // Half of the box is in the water.
    EXPECT_NEAR(heave_period(number + "\"volume\"", 0.001, 20'000) / period(200.0 + 0.5 * added), 1.0, 1e-3)
        << added;
  }
}

TEST(AddedMass, MovesNeutralSphereAsTheWaterMovesInWaves) {
  // The added mass of a sphere is half of what it displaces: (m + A) a = (rho V + A) a_water. The waves are
  // low, since the closed form is that of small motions.
  const auto scene_with = [](const std::string& velocity) {
    return scene_of(kWater + R"(
[[water.waves]]
type = "regular"
height = 0.004
period = 4.0
[[body]]
id = 1
tolerance = 1e-7
shape = { type = "sphere", radius = 0.1, segments = 12 }
[body.added_mass]
matrix = [2, 2, 2, 0, 0, 0]
[body.client]
density = 1000
position = [0, 0, -1]
)" + velocity);
  };
  const Scene at_rest = scene_with("");
  EXPECT_NEAR(0.5 * kDensity * at_rest.bodies().front().prepared_mesh->mass_properties.volume, 2.0, 0.3);
  const Vec3 start = SeaSnapshot(*at_rest.sea()).at(Vec3(0, 0, -1)).velocity_W;
  const double amplitude = start.norm();
  EXPECT_GT(amplitude, 0.001);

  const Scene scene = scene_with("linear_velocity = [" + std::to_string(start.x()) + ", " +
                                 std::to_string(start.y()) + ", " + std::to_string(start.z()) + "]\n");
  Simulation simulation = simulation_of(scene, {.step = 0.01});
  SeaSnapshot sea(*scene.sea());
  double largest = 0.0;
  run_in_process(scene, simulation, 1200, [&](const Simulation& now) {
    sea.set_time(now.utime());
    const Vec3 of_water = sea.at(only_body(now).state.center_W).velocity_W;
    largest = std::max(largest, (only_body(now).state.velocity_W - of_water).norm());
  });
  // The load of the waves is within 1e-7 of the weight, which may add up to 1e-5 m/s in this time.
  EXPECT_LT(largest, 5e-3 * amplitude);
}

// A box in steep waves, whose immersion changes in every wave. How far it drifts tells relative to what its
// velocity is when its added mass changes. The references are those of an independent integration, by the
// classical Runge-Kutta method in modal velocities relative to the water, whose equation has no ds/dt. In the
// short waves, the motion is sensitive to every detail from 13 s on.
TEST(AddedMass, DriftsInWavesAsTheFrameInvariantEquationSays) {
  const struct {
    const char* period;
    std::int64_t steps;
    double drift;  // [m]
  } cases[] = {{"2.0", 3000, 12.515}, {"3.0", 6000, -5.484}};
  for (const auto& test : cases) {
    const Scene scene = scene_of(R"(
[[water.waves]]
type = "regular"
height = 0.6
period = )" + std::string(test.period) +
                                 R"(
[[body]]
id = 1
tolerance = 1e-4
shape = { type = "box", size = [2, 1, 0.5] }
[body.drag]
linear = [30, 60, 400, 40, 150, 60]
center = [0, 0, 0]
[body.added_mass]
matrix = [100, 250, 800, 40, 80, 90]
center = [0, 0, 0]
[body.client]
mass = 400
center_of_mass = [0, 0, -0.1]
inertia = [60, 180, 200]
position = [0, 0, 0.05]
)");
    const Simulation simulation = simulation_after(scene, {.step = 0.004}, test.steps);
    const SimulatedBody& body = only_body(simulation);
    EXPECT_NEAR(pose_of(body.rigid, body.state).p_WB.x(), test.drift, 0.01 * std::abs(test.drift));
  }
}

// Fully submerged and neutrally buoyant at its height, it ends with the water there.
TEST(Current, CarriesABodyAsAtTheHeightOfItsDrag) {
  const Scene scene = scene_of(
      "[water]\ndensity = 1000\n[[water.current.profile]]\nheight = 0\nvelocity = [0.8, 0, 0]\n"
      "[[water.current.profile]]\nheight = -8\nvelocity = [0, 0.4, 0]\n[[body]]\nid = 1\nshape = { type = "
      "\"sphere\", radius = 0.2, segments = 24 }\n[body.drag]\nlinear = [30, 30, 30, 1, 1, 1]\nquadratic = "
      "[20, 20, 20, 1, 1, 1]\n[body.added_mass]\nmatrix = [9, 9, 9, 0, 0, 0]\n[body.client]\ndensity = "
      "1000\nposition = [0, 0, -2]\n");
  Simulation simulation = simulation_of(scene, {.step = 0.02});
  run_in_process(scene, simulation, 3000);
  const Vec3& velocity_W = simulation.bodies()[0].state.velocity_W;
  EXPECT_NEAR(simulation.bodies()[0].state.center_W.z(), -2.0, 1e-6);
  EXPECT_LE((velocity_W - Vec3(0.6, 0.1, 0.0)).norm(), 1e-6);
}

}  // namespace
}  // namespace buoyancy
