// Core types of the optional hydrostatics output: the content of bodies_hydrostatics_t, without LCM.
// body_hydrostatics_t.lcm documents the fields, their frames and the meaning of NaN.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "messages/request.h"

namespace buoyancy {

struct BodyHydrostatics {
  std::int32_t body_id = 0;
  BodyStatus status = BodyStatus::kOk;
  double submerged_volume = 0.0;                           // [m^3]
  std::array<double, 3> center_of_buoyancy{};              // [m], W axes, relative to position
  double wetted_area = 0.0;                                // [m^2]
  double waterplane_area = 0.0;                            // [m^2]
  std::array<double, 3> waterplane_centroid{};             // [m], W axes, relative to position
  std::array<double, 2> waterplane_second_moments{};       // [m^4], about the axes through the centroid
  std::array<std::array<double, 3>, 2> waterplane_axes{};  // unit, W frame
  std::array<double, 2> metacentric_radii{};               // BM [m]
  std::array<std::array<double, 3>, 2> metacenters{};      // [m], W axes, relative to position
  std::array<double, 2> metacentric_heights{};             // GM [m]
  std::array<std::array<double, 6>, 6> stiffness{};        // rows [N, N m], columns [m, rad], W frame
};

struct BodiesHydrostatics {
  RequestId id;
  std::vector<BodyHydrostatics> bodies;
};

}  // namespace buoyancy
