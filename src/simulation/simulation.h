// The simulator: the bodies of a scene that have a [body.client], moved step by step by the responses to the
// requests they ask.
//
// One request per step, about the pose at the step's end; its response finishes the step and begins the next.
// Step n stands at the time n h exactly (no sum that drifts), utime is that in microseconds, seq is n:
// nothing in a request comes from a clock, so the same scene gives the same bytes in every run.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "simulation/integrator.h"
#include "simulation/request_client.h"

namespace buoyancy {

struct SimulationOptions {
  double step = 1e-3;  // s, > 0
  Integrator integrator = Integrator::kVelocityVerlet;
  double lead_time = 0.0;        // s, sent with every request
  std::int64_t delay_steps = 0;  // every response is used so many steps late, >= 0; the first one till then
  std::int64_t session_id = 0;
};

// Mechanical energy over the run, J (rigid_body.h), of the poses as they are, however late their wrenches
// are. It is conserved only without damping and with wrenches that are not late.
struct EnergyStats {
  double initial = 0.0;
  double current = 0.0;
  double min = 0.0;
  double max = 0.0;
  double max_kinetic = 0.0;
};

struct SimulatedBody {
  const Body* body = nullptr;  // the scene's
  RigidBody rigid;
  RigidBodyState state;
  BodyWrench wrench;  // that moves it
  EnergyStats energy;
};

class Simulation {
 public:
  // scene must outlive the simulation. Errors: no body with a [body.client]; those of make_rigid_body.
  static Expected<Simulation> make(const Scene& scene, const SimulationOptions& options);

  // About the current poses, with the velocities as far as they are known: velocity_verlet's are those that
  // the last response's load leads to. Valid until the next call.
  const WrenchRequest& request();
  // Takes the wrenches and completes the velocities. answer: one wrench per body, in order.
  void accept(const WrenchResponse& response);
  // Moves the poses to the next step. After accept.
  void advance();

  // Errors: a body whose wrench is not OK. A simulator must not go on without its force.
  Expected<void> check_wrenches() const;
  // Errors: a body whose velocity, angular momentum or energy is not finite though its wrench is OK.
  Expected<void> check_motion() const;

  // Steps whose wrenches have been accepted; one less than step_number() between advance and accept.
  std::int64_t completed_steps() const { return in_step_ ? step_number_ - 1 : step_number_; }
  std::int64_t step_number() const { return step_number_; }                          // 0 at the start
  double time() const { return static_cast<double>(step_number_) * options_.step; }  // s
  std::int64_t utime() const;                                                        // us
  double delay() const { return delay_; }  // s: by which the wrenches in use are late
  const std::vector<SimulatedBody>& bodies() const { return bodies_; }
  const Water& water() const { return water_; }
  const SimulationOptions& options() const { return options_; }

 private:
  Simulation(const Water& water, const SimulationOptions& options);

  const WrenchResponse& delayed_response(const WrenchResponse& newest);

  Water water_;
  SimulationOptions options_;
  std::vector<SimulatedBody> bodies_;
  std::int64_t step_number_ = 0;
  bool in_step_ = false;   // between advance and accept
  WrenchRequest request_;  // reused
  double delay_ = 0.0;
  // The last delay_steps + 1 answers, that to step n at n modulo their number; empty if none is to be late.
  std::vector<WrenchResponse> delay_line_;
};

enum class RunOutcome { kCompleted, kInterrupted };

// Runs `steps` steps, or until stop becomes true. after_step sees the simulation at its start and after every
// step, also the one whose wrenches end the run, but nothing that is not finite beside a wrench that is OK;
// an error of it ends the run.
Expected<RunOutcome> run(Simulation& simulation, RequestClient& client, std::int64_t steps,
                         const std::atomic<bool>& stop,
                         const std::function<Expected<void>(const Simulation&)>& after_step);

}  // namespace buoyancy
