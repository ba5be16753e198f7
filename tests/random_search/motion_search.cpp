#include "tests/random_search/motion_search.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/request_handler.h"

namespace buoyancy {
namespace {

struct Energies {
  double start = 0.0;            // [J]
  double highest = 0.0;          // [J]
  double largest_kinetic = 0.0;  // [J]
  double kinetic_growth = 0.0;   // largest growth in a step, relative to the kinetic energy before
  bool finite = true;

  double rise() const { return highest - start; }  // [J]
};

double kinetic_energy_of(const SimulatedBody& body) {
  return kinetic_energy(body.rigid, body.state) + body.hydrodynamics->added_kinetic_energy(body.state);
}

Energies simulate(const SceneDescription& description, const SimulationOptions& options, std::int64_t steps) {
  const Scene scene = Scene::prepare(description).value();
  Simulation simulation = Simulation::make(scene, options).value();
  RequestHandler handler(scene, {.max_sessions = 1, .threads = 1});
  std::vector<std::uint8_t> bytes;
  WrenchResponse response;
  Energies energies;
  double before = 0.0;
  while (true) {
    encode(simulation.request(), bytes);
    energies.finite = !decode(handler.handle(bytes), response) && energies.finite;
    simulation.accept(response);
    const SimulatedBody& body = simulation.bodies().front();
    energies.finite = energies.finite && simulation.check_motion() && simulation.check_wrenches();
    if (!energies.finite) return energies;
    const double kinetic = kinetic_energy_of(body);
    if (simulation.step_number() > 0) {
      // The rounding of weight and buoyancy, which cancel, changes the speed by `noise` [m/s], also of a body
      // that has nearly come to rest.
      const double noise = 1e-12 * simulation.water().gravity * options.step;
      const double speed = std::sqrt(before) + noise * std::sqrt(0.5 * body.rigid.mass);
      const double allowed = speed * speed;
      energies.kinetic_growth = std::max(energies.kinetic_growth, (kinetic - allowed) / allowed);
    }
    before = kinetic;
    if (simulation.step_number() >= steps) break;
    simulation.advance();
  }
  const EnergyStats& energy = simulation.bodies().front().energy;
  energies.start = energy.initial;
  energies.highest = energy.max;
  energies.largest_kinetic = energy.max_kinetic;
  return energies;
}

constexpr const char* kSubmergedRow = "submerged: growth of the kinetic energy in a step, of itself";
constexpr const char* kVerletRow =
    "piercing, velocity_verlet: energy over its start, of the largest kinetic energy";
constexpr const char* kEulerRow = "piercing, semi_implicit_euler: likewise";

SearchStats run_case(std::uint64_t seed, std::int64_t at) {
  const MotionCase motion = random_motion_case(seed, at);
  const bool piercing = motion.kind == MotionKind::kPiercing;
  const bool verlet = motion.options.integrator == Integrator::kVelocityVerlet;
  const Energies damped = simulate(motion.scene, motion.options, motion.steps);
  const Energies undamped = simulate(motion.scene_without_drag(), motion.options, motion.steps);
  // One scale for both runs: the body without drag is usually the faster.
  const double scale = std::max({damped.largest_kinetic, undamped.largest_kinetic, 1e-300});
  const double rise = piercing ? damped.rise() / scale : damped.kinetic_growth;
  const double own = piercing ? undamped.rise() / scale : undamped.kinetic_growth;
  SearchStats stats;
  stats.cases = 1;
  SearchFigures& figures = stats.rows[!piercing ? kSubmergedRow : verlet ? kVerletRow : kEulerRow];
  figures.counts = {{"cases", 1}, {"steps", motion.steps}, {"above that without drag", rise > own ? 1 : 0}};
  figures.largest["rise"].add(rise, at);
  figures.largest["rise without drag"].add(own, at);
  std::vector<std::string> violations;
  if (!damped.finite || !undamped.finite) violations.emplace_back("a number that is not finite");
  if (!piercing && std::max(rise, own) > kRoundingGrowth) {
    violations.push_back("kinetic energy grows by " + two_digits(rise) + " of itself, without drag by " +
                         two_digits(own));
  }
  if (piercing && rise > std::max(own, documented_oscillation(motion.options.integrator))) {
    violations.push_back("energy rises by " + two_digits(rise) +
                         " of the largest kinetic energy, without drag by " + two_digits(own));
  }
  stats.add_violations(at, motion.text(), violations);
  return stats;
}

}  // namespace

RandomSearch motion_search() {
  const auto number_of = [](const char* what) {
    return SearchColumn{"case", [what](const SearchFigures& figures) {
                          const auto found = figures.largest.find(what);
                          return std::to_string(found == figures.largest.end() ? -1 : found->second.at);
                        }};
  };
  RandomSearch one;
  one.name = "motion";
  one.description = "Search for a motion with drag or added mass that gains energy";
  one.first_column = "bodies";
  one.rows = {kSubmergedRow, kVerletRow, kEulerRow};
  one.run = [](std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
    return sum_in_parallel(static_cast<std::size_t>(end - begin), threads, [&](std::size_t i) {
      return run_case(seed, begin + static_cast<std::int64_t>(i));
    });
  };
  one.replay = [](std::uint64_t seed, std::int64_t number) {
    const SearchStats stats = run_case(seed, number);
    return stats.failures.empty() ? SearchFailure{number, random_motion_case(seed, number).text(), {}}
                                  : stats.failures.front();
  };
  one.columns = {count_column("cases", "cases"),
                 count_column("steps", "steps"),
                 largest_column("largest rise", "rise"),
                 number_of("rise"),
                 largest_column("without drag", "rise without drag"),
                 number_of("rise without drag"),
                 count_column("rise above that without drag", "above that without drag")};
  return one;
}

}  // namespace buoyancy
