// Core types of the hydrostatics that a scene may ask for: what bodies_hydrostatics_t says, without LCM.
// Fields, frames and what NaN means: body_hydrostatics_t.lcm.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "messages/request.h"

namespace buoyancy {

struct BodyHydrostatics {
  std::int32_t body_id = 0;
  BodyStatus status = BodyStatus::kOk;
  double submerged_volume = 0.0;                           // m^3
  std::array<double, 3> center_of_buoyancy{};              // m, W axes, relative to position
  double wetted_area = 0.0;                                // m^2
  double waterplane_area = 0.0;                            // m^2
  std::array<double, 3> waterplane_centroid{};             // m, W axes, relative to position
  std::array<double, 2> waterplane_second_moments{};       // m^4, about the axes through the centroid
  std::array<std::array<double, 3>, 2> waterplane_axes{};  // W, unit
  std::array<double, 2> metacentric_radii{};               // m, BM
  std::array<std::array<double, 3>, 2> metacenters{};      // m, W axes, relative to position
  std::array<double, 2> metacentric_heights{};             // m, GM
  std::array<std::array<double, 6>, 6> stiffness{};        // N, N m over m, rad; W
};

struct BodiesHydrostatics {
  RequestId key;
  std::vector<BodyHydrostatics> bodies;
};

}  // namespace buoyancy
