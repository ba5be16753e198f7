// Poses and wrenches in arrays, as the functions of src/query take them.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "messages/request.h"
#include "query/pose_arrays.h"

namespace buoyancy {

struct PoseTable {
  std::vector<double> positions, quaternions, linear_velocities, angular_velocities;
  std::vector<std::int64_t> utimes;

  std::size_t size() const { return positions.size() / 3; }
  PoseArrays arrays() const {
    return {positions, quaternions, linear_velocities, angular_velocities, utimes};
  }

  BodyState state(std::size_t i, std::int32_t body_id) const {
    BodyState state;
    state.body_id = body_id;
    for (std::size_t k = 0; k < 4; ++k) state.quaternion_wxyz[k] = quaternions[4 * i + k];
    for (std::size_t k = 0; k < 3; ++k) {
      state.position[k] = positions[3 * i + k];
      if (!linear_velocities.empty()) state.linear_velocity[k] = linear_velocities[3 * i + k];
      if (!angular_velocities.empty()) state.angular_velocity[k] = angular_velocities[3 * i + k];
    }
    return state;
  }
};

// Poses of a body of about this size [m] about the origin: dry, crossing the surface and submerged, with
// quaternions that are unit to six decimals only.
inline PoseTable random_poses(std::size_t count, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  PoseTable table;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      table.positions.push_back((k == 2 ? 1.5 * size : 20.0) * unit(random));
      table.linear_velocities.push_back(2.0 * unit(random));
      table.angular_velocities.push_back(unit(random));
    }
    double q[4];
    double norm = 0.0;
    for (double& component : q) {
      component = unit(random);
      norm += component * component;
    }
    for (const double component : q) {
      table.quaternions.push_back(std::round(component / std::sqrt(norm) * 1e6) / 1e6);
    }
  }
  return table;
}

struct WrenchTable {
  std::vector<std::int32_t> statuses;
  std::vector<double> forces, torques, volumes, centers, force_bounds, torque_bounds;

  explicit WrenchTable(std::size_t n)
      : statuses(n, -1),
        forces(3 * n),
        torques(3 * n),
        volumes(n),
        centers(3 * n),
        force_bounds(n),
        torque_bounds(n) {}
  WrenchArrays arrays() { return {statuses, forces, torques, volumes, centers, force_bounds, torque_bounds}; }

  bool operator==(const WrenchTable&) const = default;
};

// The same wrench, to the bit?
inline bool equals(const WrenchTable& table, std::size_t i, const BodyWrench& wrench) {
  bool same = table.statuses[i] == static_cast<std::int32_t>(wrench.status) &&
              table.volumes[i] == wrench.submerged_volume &&
              table.force_bounds[i] == wrench.force_error_bound &&
              table.torque_bounds[i] == wrench.torque_error_bound;
  for (std::size_t k = 0; k < 3; ++k) {
    same = same && table.forces[3 * i + k] == wrench.force[k] &&
           table.torques[3 * i + k] == wrench.torque[k] &&
           table.centers[3 * i + k] == wrench.center_of_buoyancy[k];
  }
  return same;
}

}  // namespace buoyancy
