// Rigid-body simulation of the bodies of a scene that have a [body.client].
//
// Each step sends one request, for the poses at the step's end; its response completes the step and starts
// the next one. Step n is at the time n h exactly (not an accumulated sum), utime is that time in
// microseconds, and seq is n. No value of a request depends on a clock, so the same scene gives the same
// bytes in every run.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "engine/water_at_time.h"
#include "simulation/condition_schedule.h"
#include "simulation/hydrodynamic_motion.h"
#include "simulation/integrator.h"
#include "simulation/simulation_client.h"

namespace buoyancy {

struct SimulationOptions {
  double step = 1e-3;  // [s], > 0
  Integrator integrator = Integrator::kVelocityVerlet;
  double lead_time = 0.0;  // [s], sent with every request
  // Delay in steps, >= 0, with which responses are used; until then the first response is used.
  std::int64_t delay_steps = 0;
  std::int64_t session_id = 0;
};

// Mechanical energy [J] over the run (rigid_body.h), with the kinetic energy of added mass, computed for the
// present poses whatever the delay of their wrenches. It is conserved only without damping and drag, in water
// at rest and with wrenches that are not late. An event of the scene changes it, so the values begin anew
// with the response to the first request after an event of the body.
struct EnergyStats {
  double initial = 0.0;
  double current = 0.0;
  double min = 0.0;
  double max = 0.0;
  double max_kinetic = 0.0;
  // What gravity, waves and current can give to the body in the scene's scale, see docs/runs.md.
  double available = 0.0;
};

// A rise by more than this multiple of the available energy has no cause in the scene: the motion diverged.
inline constexpr double kEnergyLimit = 10.0;

struct SimulatedBody {
  const Body* body = nullptr;  // in the scene
  RigidBody rigid;
  RigidBodyState state;
  BodyWrench wrench;                                  // in use
  std::unique_ptr<HydrodynamicMotion> hydrodynamics;  // of a body with drag or added mass
  BodyCondition condition;                            // of its compartments and tanks
  bool condition_changed = false;                     // by an event of the present step
  EnergyStats energy;
};

class Simulation {
 public:
  // scene must outlive the simulation. Bodies start as StartFinder says (scene/start_pose.h). Errors: no body
  // with a [body.client]; those of make_rigid_body() and of StartFinder::start_of().
  static Expected<Simulation> make(const Scene& scene, const SimulationOptions& options);

  // Returns the request for the current poses, valid until the next call. The velocities of
  // velocity_verlet are predicted with the load of the last response.
  const WrenchRequest& request();
  // The events of the scene, which are announced with the requests.
  ConditionSchedule& conditions() { return conditions_; }
  // Takes the wrenches and completes the velocities. response: one wrench per body, in order.
  void accept(const WrenchResponse& response);
  // Moves the poses to the next step, and applies the events at it. Precondition: accept() was called.
  void advance();

  // Errors: a body whose wrench is not OK. A simulator must not continue without its force.
  Expected<void> check_wrenches() const;
  // Errors: a body whose velocity, angular momentum or energy is not finite though its wrench is OK, or whose
  // energy rose by more than kEnergyLimit times what is available.
  Expected<void> check_motion() const;

  // Number of steps whose wrenches were accepted: step_number() - 1 between advance() and accept().
  std::int64_t completed_steps() const { return in_step_ ? step_number_ - 1 : step_number_; }
  std::int64_t step_number() const { return step_number_; }                          // 0 initially
  double time() const { return static_cast<double>(step_number_) * options_.step; }  // [s]
  std::int64_t utime() const;                                                        // [us]
  double delay() const { return delay_; }  // [s], age of the wrenches in use
  const std::vector<SimulatedBody>& bodies() const { return bodies_; }
  const Water& water() const { return water_; }
  // True if the scene has waves. They do work on the bodies; the mechanical energy is that in water at rest.
  bool has_waves() const { return has_waves_; }
  // [m], depth of the sea bed under the level; infinite in deep water and in a received sea.
  double depth() const { return depth_; }
  // True if the service receives the waves. The water's velocity in them is then not known here.
  bool receives_sea() const { return receives_sea_; }
  // True if the scene has a current, which does work on the bodies with drag or added mass.
  bool has_current() const { return current_speed_ > 0.0; }
  const SimulationOptions& options() const { return options_; }

 private:
  Simulation(const Scene& scene, const SimulationOptions& options);

  const WrenchResponse& delayed_response(const WrenchResponse& latest);
  void finish_step(const SimulatedBody& body, RigidBodyState& state) const;
  double available_energy(const SimulatedBody& body) const;  // [J], in its present state
  void apply(const ConditionSchedule::Event& event);

  Water water_;
  double current_speed_;  // [m/s], the largest at any height
  bool has_waves_ = false;
  bool receives_sea_ = false;
  double depth_ = 0.0;              // [m]
  double wave_height_ = 0.0;        // [m], from the deepest trough to the highest crest
  double wave_speed_ = 0.0;         // [m/s], of the fastest component
  WaterAtTime waters_;              // of the scene, without waves that are received
  bool has_hydrodynamics_ = false;  // true if a simulated body has drag or added mass
  SimulationOptions options_;
  ConditionSchedule conditions_;
  std::vector<SimulatedBody> bodies_;
  std::int64_t step_number_ = 0;
  bool in_step_ = false;   // between advance() and accept()
  WrenchRequest request_;  // reused
  double delay_ = 0.0;
  // The last delay_steps + 1 responses as a ring buffer, step n at n modulo its size; empty without a delay.
  std::vector<WrenchResponse> delay_line_;
  // The requests from that of the response in use on, if a body has drag or added mass.
  std::deque<WrenchRequest> sent_;
};

enum class RunOutcome { kCompleted, kInterrupted };

// Runs `steps` steps, or until is_stopped(), called in every step, returns true. Calls after_step at the
// start and after every step, even the one whose wrenches end the run, but never with a state that is not
// finite and a wrench that is OK. An error of after_step ends the run.
Expected<RunOutcome> run(Simulation& simulation, SimulationClient& client, std::int64_t steps,
                         const std::function<bool()>& is_stopped,
                         const std::function<Expected<void>(const Simulation&)>& after_step);

}  // namespace buoyancy
