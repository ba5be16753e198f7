// Summary of a run: final attitude and draft of the bodies, energy conservation, and client statistics.
//
// The attitude omits the heading: with k = R_WB^T up, the up direction in B's axes,
//   roll = atan2(k_y, k_z) about B's x, pitch = atan2(-k_x, hypot(k_y, k_z)) about B's y:
// the last two angles of R = Rz(yaw) Ry(pitch) Rx(roll) where up is +z.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace buoyancy {

struct BodySummary {
  std::int32_t id = 0;
  std::string name;
  double mass = 0.0;   // [kg]
  double draft = 0.0;  // [m], depth of the lowest vertex below the level; negative above it
  // [m], height of the centre of mass above the level; in reports and the live view, of B's origin
  double heave = 0.0;
  double roll = 0.0;          // [rad]
  double pitch = 0.0;         // [rad]
  double energy_drift = 0.0;  // (last - first) / max kinetic energy; 0 for a body that never moved
  double energy_range = 0.0;  // (max - min) / max kinetic energy; 0 for a body that never moved
};

struct RunSummary {
  std::int64_t steps = 0;  // completed
  std::int64_t steps_requested = 0;
  bool interrupted = false;
  double time = 0.0;       // [s], simulated
  double wall_time = 0.0;  // [s]
  SimulationOptions options;
  std::vector<BodySummary> bodies;
  ClientStats client;
  std::vector<Warning> warnings;
};

BodySummary summarize(const SimulatedBody& body, const Water& water);  // O(vertices)

// A table for a terminal, with a final newline.
std::string to_text(const RunSummary& summary);
// One JSON object, angles in degrees, times in seconds, with a final newline.
std::string to_json(const RunSummary& summary);

}  // namespace buoyancy
