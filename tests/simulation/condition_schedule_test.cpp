#include "simulation/condition_schedule.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/condition_timeline.h"
#include "messages/conversions.h"
#include "simulation/run_warnings.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kStep = 0.01;

// A box of 4 x 2 x 1 m with two compartments and a tank. events: sections of [body.client].
Scene box_with(const std::string& events, const std::string& client = "") {
  return scene_of(
      "[water]\ndensity = 1000\n[[body]]\nid = 7\nshape = { type = \"box\", size = [4, 2, 1] }\n"
      "[[body.compartment]]\nshape = { type = \"box\", size = [1, 2, 1] }\nposition = [1.5, 0, 0]\nflooded = "
      "0\n[[body.compartment]]\nshape = { type = \"box\", size = [1, 2, 1] }\nposition = [-1.5, 0, 0]\n"
      "flooded = 0.25\n[[body.tank]]\nshape = { type = \"box\", size = [1, 1, 0.5] }\n"
      "position = [0.5, 0, -0.2]\nfill = 0.5\n[body.client]\nmass = 3000\nposition = [0, 0, 0.1]\n" +
      client + events);
}

std::string flood(double time, int compartment, double flooded) {
  return "[[body.client.event]]\ntime = " + std::to_string(time) +
         "\ncompartment = " + std::to_string(compartment) + "\nflooded = " + std::to_string(flooded) + "\n";
}

std::string pump(double time, double volume) {
  return "[[body.client.event]]\ntime = " + std::to_string(time) +
         "\ntank = 0\nliquid_volume = " + std::to_string(volume) + "\n";
}

TEST(ConditionSchedule, AppliesAnEventAtTheFirstStepThatIsNotBeforeIt) {
  const Scene scene = box_with(pump(0.305, 0.1) + flood(0.3, 1, 1.0) + flood(0.001, 0, 0.5));
  ConditionSchedule schedule(scene, kStep);
  std::map<std::int64_t, std::size_t> applied;
  for (std::int64_t step = 0; step < 100; ++step) {
    const std::size_t count = schedule.events_at(step).size();
    if (count > 0) applied[step] = count;
  }
  EXPECT_EQ(applied, (std::map<std::int64_t, std::size_t>{{1, 1}, {30, 1}, {31, 1}}));
  EXPECT_TRUE(ConditionSchedule(box_with(""), kStep).empty());
}

TEST(ConditionSchedule, UsesTheLastOfSeveralEventsAtAStep) {
  const Scene scene = box_with(flood(0.301, 0, 0.5) + flood(0.302, 0, 0.75) + flood(0.302, 1, 0.5));
  ConditionSchedule schedule(scene, kStep);
  const auto events = schedule.events_at(31);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].change.flooded, 0.75);
  EXPECT_EQ(events[1].change.index, 1);
}

// The service must know the condition of each step whatever is lost or comes in another order before it.
TEST(ConditionSchedule, AnnouncesEveryConditionInTimeInSpiteOfLosses) {
  const Scene scene =
      box_with(flood(0.02, 0, 0.5) + flood(0.05, 0, 0.75) + flood(0.5, 0, 0.0) + flood(0.55, 1, 1.0) +
               flood(0.6, 0, 1.0) + pump(0.3, 0.4) + pump(0.31, 0.1) + pump(0.9, 0.5));
  std::uint32_t random = 1;
  const auto is_lost = [&random] { return ((random = 1664525U * random + 1013904223U) >> 16U) % 4U == 0U; };
  for (int run = 0; run < 20; ++run) {
    ConditionSchedule schedule(scene, kStep);
    ConditionTimeline timeline(scene);
    BodyCondition expected = initial_condition(*scene.bodies()[0].subdivision);
    for (std::int64_t step = 0; step < 120; ++step) {
      std::vector<ConditionChange> sent = schedule.announced_at(step);
      std::vector<std::uint8_t> bytes;
      for (const ConditionSchedule::Event& event : schedule.events_at(step)) {
        if (event.change.kind == ConditionKind::kTank) {
          expected.liquid_volumes[0] = event.change.liquid_volume;
        } else {
          expected.flooded[static_cast<std::size_t>(event.change.index)] = event.change.flooded;
        }
      }
      // Lock-step clients send some requests again.
      const bool is_repeated = step % 17 == 5;
      if (is_repeated) sent = schedule.repeated_at(step);
      if (step % 2 == 1) std::ranges::reverse(sent);
      for (const ConditionChange& change : sent) {
        if (!is_repeated && is_lost()) continue;
        ASSERT_TRUE(timeline.receive(encoded(change), scene));
      }
      BodyCondition known;
      UtimeRange range;
      ASSERT_TRUE(timeline.condition_at(step * 10'000, 0, scene, known, range));
      EXPECT_EQ(known, expected) << "run " << run << ", step " << step;
    }
  }
}

// No announcement may take back a later one: an event is announced when the one before of its compartment or
// tank has taken effect, and the more often the fewer requests are left.
TEST(ConditionSchedule, AnnouncesAnEventOnlyAfterTheOneBefore) {
  std::mt19937 random(11);
  for (int run = 0; run < 50; ++run) {
    struct Announcements {
      std::int64_t first = 0;
      std::int64_t last = 0;
    };
    std::map<double, Announcements> expected;  // by the event's value
    std::string events;
    for (int target = 0; target < 3; ++target) {
      std::int64_t before = -1;
      for (std::int64_t step = 1 + random() % 30; step < kRenewedSteps;
           step += 1 + random() % (run % 2 == 0 ? 3 : 25)) {
        const double value = static_cast<double>(expected.size() + 1) / 1000.0;
        const double time = kStep * static_cast<double>(step);
        events += target == 2 ? pump(time, value) : flood(time, target, value);
        expected[value] = {std::max({std::int64_t{0}, before + 1, step - kAnnouncedSteps}), step};
        before = step;
      }
    }
    const Scene scene = box_with(events);
    ConditionSchedule schedule(scene, kStep);
    std::map<double, std::vector<std::int64_t>> announced;
    for (std::int64_t step = 0; step < kRenewedSteps; ++step) {
      for (const ConditionChange& change : schedule.announced_at(step))
        announced[change.kind == ConditionKind::kTank ? change.liquid_volume : change.flooded].push_back(
            step);
    }
    for (const auto& [value, of] : expected) {
      const std::vector<std::int64_t>& steps = announced[value];
      const std::int64_t requests = of.last - of.first + 1;
      const std::int64_t copies = (kMinAnnouncements + requests - 1) / requests;
      ASSERT_EQ(steps.size(), static_cast<std::size_t>(requests * copies)) << events;
      EXPECT_EQ(steps.front(), of.first) << value << " of " << events;
      EXPECT_EQ(steps.back(), of.last) << value << " of " << events;
    }
  }
}

// A client that never sends a request again reaches a service that was restarted all the same.
TEST(ConditionSchedule, AnnouncesAgainWhatHolds) {
  const Scene scene = box_with(flood(0.1, 0, 1.0) + pump(0.2, 0.4));
  ConditionSchedule schedule(scene, kStep);
  ConditionTimeline restarted(scene);
  for (std::int64_t step = 100; step < 100 + kRenewedSteps; ++step) {
    for (const ConditionChange& change : schedule.announced_at(step)) {
      ASSERT_TRUE(restarted.receive(encoded(change), scene));
    }
  }
  BodyCondition known;
  UtimeRange range;
  ASSERT_TRUE(restarted.condition_at(2'000'000, 0, scene, known, range));
  EXPECT_EQ(known.flooded[0], 1.0);
  EXPECT_EQ(known.liquid_volumes[0], 0.4);
}

TEST(ConditionSchedule, ReplacesWhatAnEarlierRunLeftBehind) {
  const Scene scene = box_with(flood(0.5, 0, 1.0) + pump(0.2, 0.0));
  InProcessClient client(scene);
  SimulationClient service{std::move(client)};
  std::vector<double> first;
  std::vector<double> second;
  for (std::vector<double>* forces : {&first, &second}) {
    Simulation simulation = simulation_of(scene, {.step = kStep, .session_id = forces == &first ? 1 : 2});
    const auto never = [] { return false; };
    const auto outcome = run(simulation, service, 100, never, [&](const Simulation& now) {
      forces->push_back(now.bodies()[0].wrench.force[2]);
      return Expected<void>{};
    });
    ASSERT_TRUE(outcome);
    const ConditionChange earlier{
        .utime = 100'000, .body_id = 7, .kind = ConditionKind::kCompartment, .index = 0, .flooded = 0.5};
    set_conditions(service, std::vector{earlier}, {});
  }
  EXPECT_EQ(first, second);
}

TEST(SimulatedEvents, FloodTheBodyAtTheirTime) {
  const Scene scene = box_with(flood(0.5, 0, 1.0));
  const Scene intact = box_with("");
  std::vector<double> volumes;
  std::vector<double> expected;
  for (const auto& [of, at_steps] : {std::pair{&scene, &volumes}, std::pair{&intact, &expected}}) {
    std::vector<double>& observed = *at_steps;
    Simulation simulation = simulation_of(*of, {.step = kStep});
    run_in_process(*of, simulation, 50, [&](const Simulation& now) {
      observed.push_back(now.bodies()[0].wrench.submerged_volume);
    });
  }
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(volumes[i], expected[i]) << i;
  EXPECT_LT(volumes[50], 0.8 * expected[50]);
}

TEST(SimulatedEvents, PumpLiquidWithoutAPush) {
  // The velocities of the body stay, and so do those of its origin and its pose in the request of that step.
  const std::string spin = "linear_velocity = [1, 2, 0.5]\nangular_velocity = [0.3, -0.2, 0.1]\n";
  const Scene scene = box_with(pump(0.01, 0.0), spin);
  const Scene still = box_with("", spin);
  Simulation pumped = simulation_of(scene, {.step = kStep});
  Simulation same = simulation_of(still, {.step = kStep});
  for (const auto& [simulation, of] : {std::pair{&pumped, &scene}, std::pair{&same, &still}}) {
    run_in_process(*of, *simulation, 0);
    simulation->advance();
  }
  const SimulatedBody& a = pumped.bodies()[0];
  const SimulatedBody& b = same.bodies()[0];
  EXPECT_NEAR(a.rigid.mass, 3000.0, 1e-9);
  EXPECT_NEAR(b.rigid.mass, 3250.0, 1e-9);
  const BodyState after = to_body_state(7, a.rigid, a.state);
  const BodyState before = to_body_state(7, b.rigid, b.state);
  EXPECT_LE((to_vec3(after.position) - to_vec3(before.position)).norm(), 1e-14);
  EXPECT_EQ(after.quaternion_wxyz, before.quaternion_wxyz);
  EXPECT_LE((to_vec3(after.linear_velocity) - to_vec3(before.linear_velocity)).norm(), 1e-14);
  EXPECT_LE((to_vec3(after.angular_velocity) - to_vec3(before.angular_velocity)).norm(), 1e-14);
}

TEST(SimulatedEvents, BeginTheEnergyAnew) {
  const Scene scene = box_with(flood(1.0, 0, 1.0) + pump(2.0, 0.5));
  const Simulation simulation = simulation_after(scene, {.step = 0.002}, 5000);
  EXPECT_FALSE(energy_warning(simulation));
  const EnergyStats& energy = simulation.bodies()[0].energy;
  EXPECT_LT(energy.max - energy.min, 1e-3 * energy.max_kinetic);
  EXPECT_NEAR(simulation.bodies()[0].rigid.mass, 3500.0, 1e-9);
}

TEST(SimulatedEvents, KeepAddedMassAndDragInStep) {
  const Scene scene = scene_of(
      "[water]\ndensity = 1000\n[[body]]\nid = 7\nshape = { type = \"box\", size = [4, 2, 1] }\n"
      "[[body.tank]]\nshape = { type = \"box\", size = [1, 1, 0.5] }\nposition = [0, 0, -0.25]\nfill = 0\n"
      "[body.added_mass]\nmatrix = [500, 500, 3000, 300, 900, 900]\nimmersion = \"none\"\n"
      "[body.client]\ndensity = 400\nstart = \"equilibrium\"\n" +
      pump(1.0, 0.5));
  const Simulation simulation = simulation_after(scene, {.step = 0.002}, 10'000);
  const EnergyStats& energy = simulation.bodies()[0].energy;
  EXPECT_GT(energy.max_kinetic, 1.0) << "it bobs after the tank is filled";
  EXPECT_LT(energy.max - energy.min, 1e-3 * energy.max_kinetic);
}

}  // namespace
}  // namespace buoyancy
