// Describes gravity and the water at rest that bodies float in.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/vec3.h"

namespace buoyancy {

inline constexpr double kStandardGravity = 9.80665;  // [m/s^2]
inline constexpr double kSeawaterDensity = 1025.0;   // [kg/m^3]

// Water of another density, under that above it.
struct WaterLayer {
  double below = 0.0;    // [m], the layer is where up . x_W < below, down to the next one
  double density = 0.0;  // [kg/m^3], at least that above it

  bool operator==(const WaterLayer&) const = default;
};

inline constexpr std::size_t kMaxWaterLayers = 16;

struct Water {
  Vec3 up_W = Vec3::UnitZ();          // unit
  double level = 0.0;                 // [m], the surface is where up . x_W = level
  double density = kSeawaterDensity;  // [kg/m^3], >= 0, down to the first layer; > 0 where there is one
  double gravity = kStandardGravity;  // [m/s^2], >= 0
  // From the top down: heights fall. At most kMaxWaterLayers; empty: one density.
  std::vector<WaterLayer> layers{};
};

// The pressure in layered water is the sum of those in waters of one density, each with its own surface:
//   p = g sum_i step_i max(0, h_i - up . x_W),
// where h_i is the top of layer i and step_i its density minus that above it. The water's own surface and
// density are the first term. Every load of layered water is therefore the sum of the loads of these waters.
//
// Returns the term of a layer. A surface that lies below the layer's height, as a received sea's may, is its
// top. No heap allocation.
inline Water water_of_step(const Water& water, std::size_t layer) {
  const double above = layer == 0 ? water.density : water.layers[layer - 1].density;
  return {.up_W = water.up_W,
          .level = std::min(water.layers[layer].below, water.level),
          .density = water.layers[layer].density - above,
          .gravity = water.gravity};
}

// [kg/m^3], the largest density of the water.
inline double deepest_density(const Water& water) {
  return water.layers.empty() ? water.density : water.layers.back().density;
}

}  // namespace buoyancy
