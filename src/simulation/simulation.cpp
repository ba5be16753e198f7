#include "simulation/simulation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/format.h"
#include "scene/start_pose.h"

namespace buoyancy {
namespace {

Load current_load(const SimulatedBody& body, const Water& water) {
  return total_load(body.rigid, body.state, body.wrench, water);
}

// wrench_is_current: the body's wrench belongs to its present pose.
void record_energy(SimulatedBody& body, bool first, bool wrench_is_current, const Water& water) {
  EnergyStats& energy = body.energy;
  energy.current =
      wrench_is_current && water.layers.empty()
          ? mechanical_energy(body.rigid, body.state, body.wrench, water)
          : mechanical_energy(body.rigid, body.state, body.body->solver, water).value_or(energy.current);
  double kinetic = kinetic_energy(body.rigid, body.state);
  if (body.hydrodynamics) {
    const double added = wrench_is_current
                             ? body.hydrodynamics->added_kinetic_energy(body.state)
                             : body.hydrodynamics->added_kinetic_energy_at_pose(body.state).value_or(0.0);
    energy.current += added;
    kinetic += added;
  }
  if (first) {
    energy.initial = energy.min = energy.max = energy.current;
    energy.max_kinetic = kinetic;
  }
  energy.min = std::min(energy.min, energy.current);
  energy.max = std::max(energy.max, energy.current);
  energy.max_kinetic = std::max(energy.max_kinetic, kinetic);
}

// A received sea is taken for the highest waves measured at sea: their height [m] and largest speed [m/s].
constexpr double kReceivedWaveHeight = 30.0;
constexpr double kReceivedWaveSpeed = 50.0;

constexpr const char* kDiverged = "the simulation diverged: the step is too large for the body";
constexpr const char* kUseSmallerStep = "Use a smaller --step";

std::string body_at(const SimulatedBody& body, double time) {
  return "body " + std::to_string(body.body->id) + " (" + body.body->name + ") at " + std::to_string(time) +
         " s";
}

Error not_ok_error(const SimulatedBody& body, double time) {
  Error error;
  error.subject = body_at(body, time);
  error.actual = std::string("status ") + to_string(body.wrench.status);
  error.expected = "status OK";
  switch (body.wrench.status) {
    case BodyStatus::kUnknownBody:
      error.cause = "buoyancyd runs a different scene";
      error.hint = "Start buoyancyd and buoyancy-client with the same scene file";
      break;
    case BodyStatus::kOpenEdgeWet:
      error.cause = "the mesh is open and its boundary is submerged";
      error.hint = "Close the mesh, or start with a lighter body, a higher position or a slower motion";
      break;
    case BodyStatus::kNoSea:
      error.cause = "the scene's waves are received, and buoyancyd has not received a sea for this time";
      error.hint = "Start what publishes BUOYANCY_SEA, or BUOYANCY_SEA_GRID, before the client";
      break;
    case BodyStatus::kBadCondition:
      error.cause = "buoyancyd has received a condition of a compartment or tank that it cannot use";
      error.hint = "See its log, and correct what publishes BUOYANCY_CONDITION";
      break;
    case BodyStatus::kNotCertified:
      error.cause =
          "a trough of the waves uncovers the sea bed there, or waves are far shorter than the body";
      error.hint = "Use lower waves, deeper water or a lower cutoff";
      break;
    default:
      error.cause = kDiverged;
      error.hint = kUseSmallerStep;
  }
  return error;
}

}  // namespace

Expected<Simulation> Simulation::make(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  StartFinder starts(scene);
  for (const Body& body : scene.bodies()) {
    if (!body.dynamics.given) continue;
    const Expected<DynamicsSpec> start = starts.start_of(body);
    if (!start) return make_error(start.error());
    Body started = body;
    started.dynamics = *start;
    Expected<RigidBody> rigid = make_rigid_body(started, scene.water());
    if (!rigid) return make_error(rigid.error());
    SimulatedBody simulated;
    simulated.body = &body;
    simulated.rigid = *rigid;
    simulated.state = initial_state(*rigid, *start);
    if (body.subdivision != nullptr) simulated.condition = initial_condition(*body.subdivision);
    if (body.hydrodynamics != nullptr) {
      simulated.hydrodynamics =
          std::make_unique<HydrodynamicMotion>(body, *rigid, scene.water(), scene.current());
      simulation.has_hydrodynamics_ = true;
    }
    simulation.bodies_.push_back(std::move(simulated));
  }
  if (simulation.bodies_.empty()) {
    return make_error({"the scene", "no body with a [body.client]", "at least one body to simulate",
                       "the scene was written for another simulator",
                       "Add [body.client] with position and density to each body to simulate"});
  }
  return simulation;
}

Simulation::Simulation(const Scene& scene, const SimulationOptions& options)
    : water_(scene.water()),
      current_speed_(scene.current().max_speed()),
      has_waves_(scene.sea() != nullptr || scene.receives_sea()),
      receives_sea_(scene.receives_sea()),
      depth_(std::numeric_limits<double>::infinity()),
      waters_(scene),
      options_(options),
      conditions_(scene, options.step) {
  if (receives_sea_) {
    wave_height_ = kReceivedWaveHeight;
    wave_speed_ = kReceivedWaveSpeed;
  } else if (const Sea* const sea = scene.sea()) {
    depth_ = sea->depth();
    wave_height_ = 2.0 * sea->max_elevation();
    const PreparedComponents& waves = sea->prepared();
    for (std::size_t i = 0; i < waves.size(); ++i) {
      wave_speed_ = std::max(wave_speed_, waves.angular_frequency[i] / waves.wave_number[i]);
    }
  }
  if (options.delay_steps > 0) delay_line_.resize(static_cast<std::size_t>(options.delay_steps) + 1);
}

std::int64_t Simulation::utime() const {
  return std::llround(time() * 1e6);
}

const WrenchRequest& Simulation::request() {
  request_.id = {utime(), options_.session_id, step_number_};
  request_.lead_time = options_.lead_time;
  request_.bodies.clear();
  for (const SimulatedBody& body : bodies_) {
    RigidBodyState state = body.state;
    if (in_step_) finish_step(body, state);
    request_.bodies.push_back(to_body_state(body.body->id, body.rigid, state));
  }
  if (has_hydrodynamics_) sent_.push_back(request_);
  return request_;
}

const WrenchResponse& Simulation::delayed_response(const WrenchResponse& latest) {
  if (delay_line_.empty()) return latest;
  const auto slot = [&](std::int64_t step) { return static_cast<std::size_t>(step) % delay_line_.size(); };
  delay_line_[slot(step_number_)] = latest;
  return delay_line_[slot(std::max<std::int64_t>(step_number_ - options_.delay_steps, 0))];
}

void Simulation::accept(const WrenchResponse& latest) {
  const WrenchResponse& response = delayed_response(latest);
  assert(response.bodies.size() == bodies_.size());
  delay_ = static_cast<double>(step_number_ - response.id.seq) * options_.step;
  const bool wrenches_are_current = delay_ == 0.0 && options_.lead_time == 0.0;
  WaterState water;
  if (has_hydrodynamics_) water = waters_.move_to(response.id.utime, options_.lead_time).water;
  while (sent_.size() > 1 && sent_.front().id.seq < response.id.seq) sent_.pop_front();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    SimulatedBody& body = bodies_[i];
    body.wrench = response.bodies[i];
    if (body.hydrodynamics) {
      body.hydrodynamics->take(body.wrench, sent_.front().bodies[i], options_.lead_time, water, body.state);
    }
    if (in_step_) finish_step(body, body.state);
    const bool first = !in_step_ || body.condition_changed;
    record_energy(body, first, wrenches_are_current, water_);
    if (first) body.energy.available = available_energy(body);
    body.condition_changed = false;
  }
  in_step_ = false;
}

double Simulation::available_energy(const SimulatedBody& body) const {
  const HydrostaticMesh& mesh = body.body->prepared_mesh->mesh;
  double mass = body.rigid.mass + deepest_density(water_) * std::abs(mesh.volume);
  if (body.hydrodynamics && body.body->hydrodynamics->coefficients().added_mass) {
    mass += body.body->hydrodynamics->coefficients().added_mass->matrix.diagonal().head<3>().maxCoeff();
  }
  const double height =
      std::abs(water_.up_W.dot(body.state.center_W) - water_.level) + mesh.diagonal + wave_height_;
  const double squared_speeds =
      body.state.velocity_W.squaredNorm() + current_speed_ * current_speed_ + wave_speed_ * wave_speed_;
  return mass * (water_.gravity * height + squared_speeds) + body.energy.max_kinetic;
}

void Simulation::finish_step(const SimulatedBody& body, RigidBodyState& state) const {
  if (body.hydrodynamics) {
    body.hydrodynamics->finish_step(options_.integrator, options_.step, state);
  } else {
    buoyancy::finish_step(options_.integrator, body.rigid, current_load(body, water_), options_.step, state);
  }
}

void Simulation::advance() {
  assert(!in_step_);
  for (SimulatedBody& body : bodies_) {
    if (body.hydrodynamics) {
      body.hydrodynamics->begin_step(options_.integrator, options_.step, body.state);
    } else {
      begin_step(options_.integrator, body.rigid, current_load(body, water_), options_.step, body.state);
    }
  }
  ++step_number_;
  in_step_ = true;
  for (const ConditionSchedule::Event& event : conditions_.events_at(step_number_)) apply(event);
}

void Simulation::apply(const ConditionSchedule::Event& event) {
  const ConditionChange& change = event.change;
  const auto body = std::ranges::find(bodies_, event.body, &SimulatedBody::body);
  const auto index = static_cast<std::size_t>(change.index);
  if (change.kind == ConditionKind::kTank) {
    body->condition.liquid_volumes[index] = change.liquid_volume;
  } else {
    body->condition.flooded[index] = change.flooded;
  }
  set_condition(*body->body, body->condition, water_, body->rigid, body->state);
  if (body->hydrodynamics) body->hydrodynamics->set_rigid_body(body->rigid);
  body->condition_changed = true;
}

Expected<void> Simulation::check_wrenches() const {
  for (const SimulatedBody& body : bodies_) {
    if (body.wrench.status != BodyStatus::kOk) return make_error(not_ok_error(body, time()));
  }
  return {};
}

Expected<void> Simulation::check_motion() const {
  for (const SimulatedBody& body : bodies_) {
    const RigidBodyState& state = body.state;
    const bool finite = state.velocity_W.allFinite() && state.angular_momentum_W.allFinite() &&
                        std::isfinite(body.energy.current);
    if (body.wrench.status != BodyStatus::kOk) continue;
    if (!finite) {
      return make_error({body_at(body, time()), "a velocity or energy that is not finite", "finite numbers",
                         kDiverged, kUseSmallerStep});
    }
    const double rise = body.energy.current - body.energy.initial;
    if (!(rise > kEnergyLimit * body.energy.available)) continue;
    return make_error(
        {body_at(body, time()),
         format_text("its mechanical energy rose by {:3} J, to a speed of {:3} m/s", rise,
                     state.velocity_W.norm()),
         format_text(
             "a rise of at most {:3} J: ten times what gravity, waves and current can give to it here",
             kEnergyLimit * body.energy.available),
         std::string(kDiverged) + ", responses are late, or the waves are too steep for linear theory",
         std::string(kUseSmallerStep) + " or lock-step mode, and see buoyancyd --check"});
  }
  return {};
}

Expected<RunOutcome> run(Simulation& simulation, SimulationClient& client, std::int64_t steps,
                         const std::function<bool()>& is_stopped,
                         const std::function<Expected<void>(const Simulation&)>& after_step) {
  while (true) {
    if (ConditionSchedule& conditions = simulation.conditions(); !conditions.empty()) {
      const std::int64_t step = simulation.step_number();
      const std::vector<ConditionChange>& repeated = conditions.repeated_at(step);
      set_conditions(client, conditions.announced_at(step), repeated);
    }
    const Expected<const WrenchResponse*> response = buoyancy::request(client, simulation.request());
    if (!response && is_stopped()) return RunOutcome::kInterrupted;
    if (!response) return make_error(response.error());
    simulation.accept(**response);
    if (const Expected<void> finite = simulation.check_motion(); !finite) return make_error(finite.error());
    if (const Expected<void> observed = after_step(simulation); !observed)
      return make_error(observed.error());
    if (const Expected<void> ok = simulation.check_wrenches(); !ok) return make_error(ok.error());
    if (simulation.step_number() >= steps) return RunOutcome::kCompleted;
    if (is_stopped()) return RunOutcome::kInterrupted;
    simulation.advance();
  }
}

}  // namespace buoyancy
