// Arrays, owned by the caller, of many poses of one body and of their wrenches: for machine learning,
// parameter sweeps and the bindings to other languages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace buoyancy {

// n poses. Arrays are contiguous, in the order of the poses.
struct PoseArrays {
  std::span<const double> positions;           // [m], W frame, of B's origin; 3 n
  std::span<const double> quaternions_wxyz;    // q_WB; 4 n
  std::span<const double> linear_velocities;   // [m/s], W frame, of B's origin; 3 n, or empty: at rest
  std::span<const double> angular_velocities;  // [rad/s], W frame; 3 n, or empty: at rest
  std::span<const std::int64_t> utimes;        // [us]; n, or 1 for all poses, or empty: 0

  std::size_t size() const { return positions.size() / 3; }
  std::int64_t utime(std::size_t i) const {
    if (utimes.empty()) return 0;
    return utimes.size() == 1 ? utimes.front() : utimes[i];
  }
  PoseArrays part(std::size_t begin, std::size_t end) const {
    const auto rows = [begin, end](std::span<const double> all, std::size_t columns) {
      return all.empty() ? all : all.subspan(begin * columns, (end - begin) * columns);
    };
    return {rows(positions, 3), rows(quaternions_wxyz, 4), rows(linear_velocities, 3),
            rows(angular_velocities, 3), utimes.size() <= 1 ? utimes : utimes.subspan(begin, end - begin)};
  }
};

// The fields of each pose's wrench, with the units and frames of the message (messages/request.h). A pose
// whose status is not 0 has zeros.
struct WrenchArrays {
  std::span<std::int32_t> statuses;       // values of BodyStatus; n
  std::span<double> forces;               // [N], W frame; 3 n
  std::span<double> torques;              // [N m], W frame, about the body's reference point; 3 n
  std::span<double> volumes;              // [m^3], submerged; n
  std::span<double> centers_of_buoyancy;  // [m], W axes, relative to the position; 3 n
  std::span<double> force_error_bounds;   // [N]; n
  std::span<double> torque_error_bounds;  // [N m]; n

  WrenchArrays part(std::size_t begin, std::size_t end) const {
    const auto rows = [begin, end](auto all, std::size_t columns) {
      return all.subspan(begin * columns, (end - begin) * columns);
    };
    return {rows(statuses, 1),
            rows(forces, 3),
            rows(torques, 3),
            rows(volumes, 1),
            rows(centers_of_buoyancy, 3),
            rows(force_error_bounds, 1),
            rows(torque_error_bounds, 1)};
  }
};

}  // namespace buoyancy
