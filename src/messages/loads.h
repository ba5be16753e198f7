// Core types of the optional loads output: the content of bodies_loads_t, without LCM. body_loads_t.lcm
// documents the fields and their frames.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "messages/request.h"

namespace buoyancy {

struct BodyLoads {
  std::int32_t body_id = 0;
  BodyStatus status = BodyStatus::kOk;
  double immersion = 0.0;                             // 0 to 1
  std::array<double, 3> buoyancy_force{};             // [N], W frame
  std::array<double, 3> buoyancy_torque{};            // [N m], W frame, like all about the reference point
  std::array<double, 3> drag_force{};                 // [N]
  std::array<double, 3> drag_torque{};                // [N m]
  std::array<double, 3> added_mass_force{};           // [N]
  std::array<double, 3> added_mass_torque{};          // [N m]
  std::array<std::array<double, 6>, 6> added_mass{};  // [kg, kg m, kg m^2], W axes
  std::array<std::array<double, 6>, 6> damping{};     // rows [N, N m], columns [m/s, rad/s], W axes
  std::array<double, 3> water_velocity{};             // [m/s], W frame
};

struct BodiesLoads {
  RequestId id;
  std::vector<BodyLoads> bodies;
};

}  // namespace buoyancy
