// Simulated bodies with compartments and tanks.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "base/format.h"
#include "engine/body_evaluation.h"
#include "messages/conversions.h"
#include "scene/body_motions.h"
#include "simulation/natural_frequency.h"
#include "simulation/run_summary.h"
#include "simulation/run_warnings.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

const std::string kWater = "[water]\ndensity = 1000\n";

std::string box(const std::string& size, const std::string& position) {
  return "shape = { type = \"box\", size = " + size + " }\nposition = " + position + "\n";
}

// A barge of 4 x 2 x 1 m. sections: its parts, compartments and tanks; client: lines of [body.client].
std::string barge(int id, const std::string& sections, const std::string& client) {
  return "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [4, 2, 1] }\n" +
         "reference_point = [0.3, -0.2, 0.1]\n" + sections + "[body.client]\n" + client;
}

std::string tank(double fill, double density = 1000.0) {
  return "[[body.tank]]\n" + box("[2, 1.6, 0.5]", "[0.2, 0.1, -0.2]") + "fill = " + std::to_string(fill) +
         "\ndensity = " + std::to_string(density) + "\n";
}

const std::string kRolling =  // by 0.3 rad
    "mass = 2400\ncenter_of_mass = [0, 0, -0.1]\nposition = [0, 0, 0.15]\n"
    "orientation = [0.98877107793604, 0.14943813247360, 0, 0]\n";

// The energy of the first body over a run, over its largest kinetic energy.
struct EnergyOfRun {
  double range = 0.0;
  double drift = 0.0;  // from the mean over the first tenth of the run to that over the last
};

EnergyOfRun energy_of(const Scene& scene, double duration, double step) {
  Simulation simulation = simulation_of(scene, {.step = step});
  const std::int64_t steps = std::llround(duration / step);
  const std::int64_t window = steps / 10;
  double first = 0.0;
  double last = 0.0;
  run_in_process(scene, simulation, steps, [&](const Simulation& now) {
    const double energy = now.bodies()[0].energy.current;
    if (now.step_number() < window) first += energy;
    if (now.step_number() > steps - window) last += energy;
  });
  EXPECT_FALSE(energy_warning(simulation));
  const EnergyStats& energy = simulation.bodies()[0].energy;
  const double mean_count = static_cast<double>(window);
  return {(energy.max - energy.min) / energy.max_kinetic,
          std::abs(last - first) / mean_count / energy.max_kinetic};
}

const std::string kCompartment =
    "[[body.compartment]]\npermeability = 0.8\n" + box("[1, 1.2, 1]", "[1.4, -0.3, 0]");

TEST(SubdividedBody, KeepsItsEnergy) {
  // Some 100 periods of roll. The error of velocity Verlet is of order 2, as without a tank.
  const EnergyOfRun empty = energy_of(scene_of(kWater + barge(1, tank(0.0), kRolling)), 200.0, 0.005);
  for (const std::string& sections : {tank(0.5), kCompartment + tank(0.5)}) {
    const Scene scene = scene_of(kWater + barge(1, sections, kRolling));
    const EnergyOfRun coarse = energy_of(scene, 200.0, 0.01);
    const EnergyOfRun fine = energy_of(scene, 200.0, 0.005);
    EXPECT_LT(coarse.range, 2e-3);
    EXPECT_LT(fine.range, 0.3 * coarse.range);
    EXPECT_LT(fine.range, 2.0 * empty.range);
    EXPECT_LT(fine.drift, 0.1 * fine.range);
  }
}

// For a body at rest -dE/ds along a small motion equals the power of the load, at every pose.
TEST(Potential, MatchesTheWorkOfTheLoads) {
  const std::string client = "mass = 2400\ncenter_of_mass = [0.1, -0.2, -0.1]\n";
  for (const Scene& scene : {scene_of(kWater + "level = 2\n" + barge(1, "", client)),
                             scene_of(kWater + "level = 2\n" + barge(1, kCompartment + tank(0.4), client)),
                             scene_of("[world]\nup = [0.3, -0.4, 0.8]\n" + kWater +
                                      barge(1, kCompartment + tank(0.4, 800.0), client))}) {
    const Body& described = scene.bodies().front();
    const Water& water = scene.water();
    const RigidBody rigid = make_rigid_body(described, water).value();
    const auto wrench_at = [&](const RigidBodyState& state) {
      BodyOutcome outcome;
      evaluate(described, {&scene.water(), nullptr},
               {.status = BodyStatus::kOk, .pose = pose_of(rigid, state)}, outcome);
      return to_wrench(1, outcome);
    };
    std::mt19937 random(31);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    for (int i = 0; i < 50; ++i) {
      RigidBodyState state;
      state.q_WB = Eigen::Quaterniond{uniform(random), uniform(random), uniform(random), uniform(random)};
      state.q_WB.normalize();
      state.center_W = vector();
      state.center_W += (water.level + uniform(random) - water.up_W.dot(state.center_W)) * water.up_W;
      const Vec3 shift_W = vector();
      const Vec3 turn_W = vector();
      const auto energy_at = [&](double s) {
        RigidBodyState at = state;
        at.center_W += s * shift_W;
        at.q_WB = Eigen::AngleAxisd(s * turn_W.norm(), turn_W.normalized()) * state.q_WB;
        const double energy = mechanical_energy(rigid, at, wrench_at(at), water);
        EXPECT_NEAR(energy, mechanical_energy(rigid, at, described.solver, water).value(),
                    1e-11 * rigid.mass * water.gravity);
        return energy;
      };
      const double h = 1e-4;
      const Load load = total_load(rigid, state, wrench_at(state), water);
      const double power = load.force_W.dot(shift_W) + load.torque_W.dot(turn_W);
      EXPECT_NEAR(-(energy_at(h) - energy_at(-h)) / (2.0 * h), power, 1e-5 * rigid.mass * water.gravity) << i;
    }
  }
}

TEST(SubdividedBody, MovesWithAFullTankAsWithBallast) {
  // 2,400 kg and 1,600 kg of 2 x 1.6 x 0.5 m as one rigid body.
  const Vec3 own(0, 0, -0.1);
  const Vec3 liquid(0.2, 0.1, -0.2);
  const Vec3 center = (2400.0 * own + 1600.0 * liquid) / 4000.0;
  const auto about_center = [&](double mass, const Vec3& at, const Vec3& size) {
    const Vec3 d = at - center;
    const Vec3 squares = size.cwiseProduct(size);
    return Mat3(mass / 12.0 * Mat3((squares.sum() * Vec3::Ones() - squares).asDiagonal()) +
                mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose()));
  };
  const Mat3 inertia = about_center(2400.0, own, {4, 2, 1}) + about_center(1600.0, liquid, {2, 1.6, 0.5});
  std::string rigid = kRolling;
  const std::string given = "mass = 2400\ncenter_of_mass = [0, 0, -0.1]\n";
  rigid.replace(0, given.size(),
                "mass = 4000\ncenter_of_mass = [" + format_vector(center, 17) + "]\ninertia = [" +
                    format_vector(inertia.diagonal(), 17) + ", " +
                    format_vector({inertia(0, 1), inertia(0, 2), inertia(1, 2)}, 17) + "]\n");
  const Scene with_tank = scene_of(kWater + barge(1, tank(1.0), kRolling));
  const Scene with_ballast = scene_of(kWater + barge(1, "", rigid));
  const Simulation a = simulation_after(with_tank, {.step = 0.005}, 2000);
  const Simulation b = simulation_after(with_ballast, {.step = 0.005}, 2000);
  const RigidBodyState& of_tank = a.bodies()[0].state;
  const RigidBodyState& of_ballast = b.bodies()[0].state;
  EXPECT_LE((of_tank.center_W - of_ballast.center_W).norm(), 1e-9);
  EXPECT_LE(of_tank.q_WB.angularDistance(of_ballast.q_WB), 1e-9);
  EXPECT_NEAR(a.bodies()[0].energy.current, b.bodies()[0].energy.current, 1e-6);
}

TEST(SubdividedBody, FallsWithG) {
  const Scene scene = scene_of(kWater + barge(1, tank(0.5), "density = 300\nposition = [0, 0, 100]\n"));
  Simulation simulation = simulation_of(scene, {.step = 0.01});
  const double start = simulation.bodies()[0].state.center_W.z();
  run_in_process(scene, simulation, 100);
  const SimulatedBody& body = simulation.bodies()[0];
  EXPECT_NEAR(body.rigid.mass, 2400.0 + 800.0, 1e-9);
  EXPECT_NEAR(body.state.center_W.z(), start - 0.5 * kStandardGravity, 1e-11);
  EXPECT_LE(body.state.angular_momentum_W.norm(), 1e-9);
}

TEST(SubdividedBody, NaturalFrequenciesAgreeWithTheCheck) {
  // Symmetric, so that no motions are coupled; with a low inertia, pitch is the fastest.
  const std::string sections = "[[body.tank]]\nfill = 0.5\n" + box("[2, 1.6, 0.5]", "[0, 0, -0.2]") +
                               "[[body.compartment]]\n" + box("[1, 2, 1]", "[0, 0, 0]");
  const Scene scene =
      scene_of(kWater + barge(1, sections,
                              "mass = 2400\ncenter_of_mass = [0, 0, -0.1]\ninertia = [300, 300, 400]\n"
                              "start = \"equilibrium\"\n"));
  const NaturalMotions motions = scene_motions(scene).at(0).motions->natural.value();
  const Simulation simulation = simulation_of(scene, {});
  const SimulatedBody& body = simulation.bodies()[0];
  const HighestNaturalFrequency highest =
      highest_natural_frequency(scene.bodies()[0], body.rigid, body.state, scene.water());
  EXPECT_GT(motions.pitch.frequency, motions.heave.frequency);
  EXPECT_NEAR(highest.frequency, motions.pitch.frequency, 1e-6 * highest.frequency);
  EXPECT_GE(natural_frequency_bound(scene.bodies()[0], body.rigid, scene.water()), highest.frequency);
}

TEST(SubdividedBody, StaysAtItsEquilibrium) {
  const std::string compartment = "[[body.compartment]]\n" + box("[1, 1, 1]", "[1.5, 0.5, 0]");
  const Scene scene = scene_of(
      kWater +
      barge(
          1, tank(0.5) + compartment,
          "density = 250\ncenter_of_mass = [0, 0, -0.2]\nstart = \"equilibrium\"\nposition = [3, 4, 50]\n") +
      "[[body]]\nid = 2\nshape = { type = \"box\", size = [4, 1, 1] }\n[body.client]\ndensity = 500\n"
      "start = \"equilibrium\"\n");
  Simulation simulation = simulation_of(scene, {.step = 0.01});
  const std::vector<RigidBodyState> start{simulation.bodies()[0].state, simulation.bodies()[1].state};
  run_in_process(scene, simulation, 1000);
  for (std::size_t i = 0; i < 2; ++i) {
    const SimulatedBody& body = simulation.bodies()[i];
    EXPECT_LE((body.state.center_W - start[i].center_W).norm(), 1e-9) << i;
    EXPECT_LE(body.state.q_WB.angularDistance(start[i].q_WB), 1e-9) << i;
    EXPECT_EQ(summarize(body, scene.water()).energy_drift, 0.0) << "only rounding moves it";
  }
}

TEST(SubdividedBody, CannotStartAfloatIfItSinks) {
  const Scene scene = scene_of(kWater + barge(1, tank(1.0), "density = 900\nstart = \"equilibrium\"\n"));
  const Expected<Simulation> simulation = Simulation::make(scene, {});
  ASSERT_FALSE(simulation);
  EXPECT_THAT(simulation.error().message(), HasSubstr("a mass of 8800 kg with the liquids in its tanks"));
}

TEST(SubdividedBody, ScalesDragWithTheImmersionOfItsHull) {
  // A neutrally buoyant body under water, and a step that is 20 times its time of decay: what is left of the
  // drag of a response would be an explicit force, which turns the velocity around.
  const Scene scene =
      scene_of(kWater + barge(1,
                              "[[body.compartment]]\n" + box("[1, 2, 1]", "[0, 0, 0]") +
                                  "[body.drag]\nlinear = [2.4e5, 2.4e5, 2.4e5, 2.4e5, 2.4e5, 2.4e5]\n",
                              "mass = 6000\ncenter_of_mass = [0, 0, 0]\nposition = [0, 0, -5]\n"
                              "linear_velocity = [2, 0, 0]\n"));
  Simulation simulation = simulation_of(scene, {.step = 0.5});
  double speed = 2.0;
  run_in_process(scene, simulation, 50, [&](const Simulation& now) {
    const double present = now.bodies()[0].state.velocity_W.x();
    EXPECT_LE(present, speed) << now.step_number();
    EXPECT_GE(present, 0.0) << now.step_number();
    speed = present;
  });
  EXPECT_LT(speed, 1e-9);
}

}  // namespace
}  // namespace buoyancy
