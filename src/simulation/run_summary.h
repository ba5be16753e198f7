// What a run ended with: where and how the bodies float, how well energy was kept, and how the responses
// came.
//
// Attitude without heading: with k = R_WB^T up, the up direction in B's axes,
//   roll = atan2(k_y, k_z) about B's x, pitch = atan2(-k_x, hypot(k_y, k_z)) about B's y:
// the last two of the angles of R = Rz(yaw) Ry(pitch) Rx(roll) where up is +z.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simulation/simulation.h"

namespace buoyancy {

struct BodySummary {
  std::int32_t id = 0;
  std::string name;
  double mass = 0.0;          // kg
  double draft = 0.0;         // m: of the lowest vertex below the level; negative: it is above
  double heave = 0.0;         // m: of the centre of mass over the level
  double roll = 0.0;          // rad
  double pitch = 0.0;         // rad
  double energy_drift = 0.0;  // (last - first) / largest kinetic energy; 0 for a body that never moved
  double energy_range = 0.0;  // (greatest - least) / largest kinetic energy; likewise
};

struct RunSummary {
  std::int64_t steps = 0;  // done
  std::int64_t steps_requested = 0;
  bool interrupted = false;
  double time = 0.0;       // s, simulated
  double wall_time = 0.0;  // s
  SimulationOptions options;
  std::vector<BodySummary> bodies;
  ClientStats client;
  std::vector<Error> warnings;
};

BodySummary summarize(const SimulatedBody& body, const Water& water);  // O(vertices)

std::string to_text(const RunSummary& summary);  // a table for a terminal, with a final newline
std::string to_json(
    const RunSummary& summary);  // one object; angles in degrees, times in s; with a final newline

}  // namespace buoyancy
