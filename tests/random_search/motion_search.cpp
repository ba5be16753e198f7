#include "tests/random_search/motion_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <mutex>
#include <thread>

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

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data();
}

void run_case(std::uint64_t seed, std::int64_t at, MotionSearchStats& stats) {
  const MotionCase motion = random_motion_case(seed, at);
  const bool piercing = motion.kind == MotionKind::kPiercing;
  const bool verlet = motion.options.integrator == Integrator::kVelocityVerlet;
  MotionFigures& figures = stats.figures.at(!piercing ? 0 : verlet ? 1 : 2);
  const Energies damped = simulate(motion.scene, motion.options, motion.steps);
  const Energies undamped = simulate(motion.scene_without_drag(), motion.options, motion.steps);
  ++figures.cases;
  figures.steps += motion.steps;
  std::string violation;
  if (!damped.finite || !undamped.finite) violation = "a number that is not finite";
  // One scale for both runs: the body without drag is usually the faster.
  const double scale = std::max({damped.largest_kinetic, undamped.largest_kinetic, 1e-300});
  const double rise = piercing ? damped.rise() / scale : damped.kinetic_growth;
  const double own = piercing ? undamped.rise() / scale : undamped.kinetic_growth;
  figures.rise.add(rise, at);
  figures.rise_undamped.add(own, at);
  if (rise > own) ++figures.above_own;
  if (!piercing && std::max(rise, own) > kRoundingGrowth) {
    violation = "kinetic energy grows by " + number(rise) + " of itself, without drag by " + number(own);
  }
  if (piercing && rise > std::max(own, documented_oscillation(motion.options.integrator))) {
    violation =
        "energy rises by " + number(rise) + " of the largest kinetic energy, without drag by " + number(own);
  }
  if (!violation.empty()) stats.failures.push_back({at, motion.text(), violation});
}

}  // namespace

MotionFigures& MotionFigures::operator+=(const MotionFigures& other) {
  cases += other.cases;
  steps += other.steps;
  rise.add(other.rise.value, other.rise.at);
  rise_undamped.add(other.rise_undamped.value, other.rise_undamped.at);
  above_own += other.above_own;
  return *this;
}

MotionSearchStats& MotionSearchStats::operator+=(const MotionSearchStats& other) {
  for (std::size_t i = 0; i < figures.size(); ++i) figures[i] += other.figures[i];
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
  return *this;
}

MotionSearchStats search_motions(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
  MotionSearchStats total;
  std::mutex mutex;
  const auto work = [&](unsigned offset) {
    MotionSearchStats own;
    for (std::int64_t at = begin + offset; at < end; at += threads) run_case(seed, at, own);
    const std::lock_guard<std::mutex> lock(mutex);
    total += own;
  };
  std::vector<std::thread> workers;
  for (unsigned i = 1; i < threads; ++i) workers.emplace_back(work, i);
  work(0);
  for (std::thread& worker : workers) worker.join();
  std::ranges::sort(total.failures, {}, &FailedMotionCase::number);
  return total;
}

std::string markdown(const MotionSearchStats& stats) {
  std::string text =
      "| bodies | cases | steps | largest rise | case | without drag | case | rise above that without drag "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n";
  constexpr std::array<const char*, 3> kNames{
      "submerged: growth of the kinetic energy in a step, of itself",
      "piercing, velocity_verlet: energy over its start, of the largest kinetic energy",
      "piercing, semi_implicit_euler: likewise"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const MotionFigures& figures = stats.figures[i];
    text += std::string("| ") + kNames[i] + " | " + std::to_string(figures.cases) + " | " +
            std::to_string(figures.steps) + " | " + number(figures.rise.value) + " | " +
            std::to_string(figures.rise.at) + " | " + number(figures.rise_undamped.value) + " | " +
            std::to_string(figures.rise_undamped.at) + " | " + std::to_string(figures.above_own) + " |\n";
  }
  return text;
}

}  // namespace buoyancy
