#include "simulation/simulation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace buoyancy {
namespace {

Load current_load(const SimulatedBody& body, const Water& water) {
  return load_on(body.rigid, body.state, body.wrench, water);
}

// own_wrench: the body's wrench belongs to its pose.
void record_energy(SimulatedBody& body, bool first, bool own_wrench, const Water& water) {
  EnergyRecord& energy = body.energy;
  energy.current =
      own_wrench
          ? mechanical_energy(body.rigid, body.state, body.wrench, water)
          : mechanical_energy(body.rigid, body.state, body.body->solver, water).value_or(energy.current);
  const double kinetic = kinetic_energy(body.rigid, body.state);
  if (first) energy = {energy.current, energy.current, energy.current, energy.current, kinetic};
  energy.least = std::min(energy.least, energy.current);
  energy.greatest = std::max(energy.greatest, energy.current);
  energy.greatest_kinetic = std::max(energy.greatest_kinetic, kinetic);
}

constexpr const char* kBlownUp =
    "the simulation has left the range of numbers: a step too large for the body";
constexpr const char* kSmallerStep = "Take a smaller --step";

std::string body_at(const SimulatedBody& body, double time) {
  return "body " + std::to_string(body.body->id) + " (" + body.body->name + ") at " + std::to_string(time) +
         " s";
}

Error not_ok_error(const SimulatedBody& body, double time) {
  Error error;
  error.subject = body_at(body, time);
  error.found = std::string("status ") + name(body.wrench.status);
  error.expectation = "status OK";
  switch (body.wrench.status) {
    case BodyStatus::kUnknownBody:
      error.cause = "buoyancyd runs another scene";
      error.remedy = "Start buoyancyd and buoyancy-client with the same scene file";
      break;
    case BodyStatus::kOpenEdgeWet:
      error.cause = "the mesh is open and its boundary got under water";
      error.remedy = "Close the mesh, or start the body lighter, higher or calmer";
      break;
    default:
      error.cause = kBlownUp;
      error.remedy = kSmallerStep;
  }
  return error;
}

}  // namespace

Expected<Simulation> Simulation::make(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene.water(), options);
  for (const Body& body : scene.bodies()) {
    if (!body.client.given) continue;
    Expected<RigidBody> rigid = make_rigid_body(body, scene.water());
    if (!rigid) return failure(rigid.error());
    SimulatedBody simulated;
    simulated.body = &body;
    simulated.rigid = *rigid;
    simulated.state = initial_state(*rigid, body.client);
    simulation.bodies_.push_back(simulated);
  }
  if (simulation.bodies_.empty()) {
    return failure({"the scene", "no body with a [body.client]", "at least one body to simulate",
                    "the scene was written for another simulator",
                    "Add [body.client] with position and density to the bodies that shall move"});
  }
  return simulation;
}

Simulation::Simulation(const Water& water, const SimulationOptions& options)
    : water_(water), options_(options) {
  if (options.late_steps > 0) held_.resize(static_cast<std::size_t>(options.late_steps) + 1);
}

std::int64_t Simulation::utime() const {
  return std::llround(time() * 1e6);
}

const Question& Simulation::question() {
  question_.key = {utime(), options_.session_id, step_number_};
  question_.lead_time = options_.lead_time;
  question_.bodies.clear();
  for (const SimulatedBody& body : bodies_) {
    RigidBodyState state = body.state;
    if (in_step_) {
      finish_step(options_.integrator, body.rigid, current_load(body, water_), options_.step, state);
    }
    question_.bodies.push_back(message_state(body.body->id, body.rigid, state));
  }
  return question_;
}

const Answer& Simulation::exchange_for_late(const Answer& newest) {
  if (held_.empty()) return newest;
  const auto slot = [&](std::int64_t step) { return static_cast<std::size_t>(step) % held_.size(); };
  held_[slot(step_number_)] = newest;
  return held_[slot(std::max<std::int64_t>(step_number_ - options_.late_steps, 0))];
}

void Simulation::accept(const Answer& newest) {
  const Answer& answer = exchange_for_late(newest);
  assert(answer.bodies.size() == bodies_.size());
  delay_ = static_cast<double>(step_number_ - answer.key.seq) * options_.step;
  const bool own_wrenches = delay_ == 0.0 && options_.lead_time == 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    SimulatedBody& body = bodies_[i];
    body.wrench = answer.bodies[i];
    if (in_step_) {
      finish_step(options_.integrator, body.rigid, current_load(body, water_), options_.step, body.state);
    }
    record_energy(body, !in_step_, own_wrenches, water_);
  }
  in_step_ = false;
}

void Simulation::advance() {
  assert(!in_step_);
  for (SimulatedBody& body : bodies_) {
    begin_step(options_.integrator, body.rigid, current_load(body, water_), options_.step, body.state);
  }
  ++step_number_;
  in_step_ = true;
}

Expected<void> Simulation::check_wrenches() const {
  for (const SimulatedBody& body : bodies_) {
    if (body.wrench.status != BodyStatus::kOk) return failure(not_ok_error(body, time()));
  }
  return {};
}

Expected<void> Simulation::check_motion() const {
  for (const SimulatedBody& body : bodies_) {
    const RigidBodyState& state = body.state;
    const bool finite = state.velocity_W.allFinite() && state.angular_momentum_W.allFinite() &&
                        std::isfinite(body.energy.current);
    if (finite || body.wrench.status != BodyStatus::kOk) continue;
    return failure({body_at(body, time()), "a velocity or energy that is not finite", "finite numbers",
                    kBlownUp, kSmallerStep});
  }
  return {};
}

Expected<RunEnd> run(Simulation& simulation, Asker& asker, std::int64_t steps, const std::atomic<bool>& stop,
                     const std::function<Expected<void>(const Simulation&)>& after_step) {
  while (true) {
    const Expected<const Answer*> answer = ask(asker, simulation.question());
    if (!answer && stop.load()) return RunEnd::kInterrupted;
    if (!answer) return failure(answer.error());
    simulation.accept(**answer);
    if (const Expected<void> finite = simulation.check_motion(); !finite) return failure(finite.error());
    if (const Expected<void> seen = after_step(simulation); !seen) return failure(seen.error());
    if (const Expected<void> ok = simulation.check_wrenches(); !ok) return failure(ok.error());
    if (simulation.step_number() >= steps) return RunEnd::kDone;
    if (stop.load()) return RunEnd::kInterrupted;
    simulation.advance();
  }
}

}  // namespace buoyancy
