// The terms of the pressure of layered water (base/water.h), and the hydrostatics that follow from them.
#pragma once

#include <algorithm>
#include <optional>

#include "base/water.h"
#include "hydrostatics/immersed_part.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// Calls visit(step, depth) for the surface, and for the top of each layer. step: the term's density over that
// at the surface, where it is 1. depth: [m], of the top under the surface. The density at the surface times
// the sum of step times any integral over the volume, or the area, under a top is what layered water puts in
// the place of density times integral. Precondition: with layers, the density at the surface is above 0.
template <typename Visit>
void for_each_step(const Water& water, const Visit& visit) {
  visit(1.0, 0.0);
  for (std::size_t i = 0; i < water.layers.size(); ++i) {
    const Water step = water_of_step(water, i);
    visit(step.density / water.density, water.level - step.level);
  }
}

// The plane of a top from that of the surface. depth: [m].
inline WaterPlane lowered(WaterPlane plane, double depth) {
  plane.h_c -= depth;
  return plane;
}

// The mean density of what a body displaces, over that at the surface. sum: of step times the volume under
// each top; volume: that under the surface, both [m^3]. Rounding errors of small volumes leave the mean
// within the densities of the water.
inline double mean_step(const Water& water, double sum, double volume) {
  if (!(volume > 0.0)) return 1.0;
  return std::clamp(sum / volume, 1.0, deepest_density(water) / water.density);
}

// What hydrostatics_of() takes for layered water.
struct MeanImmersedPart {
  ImmersedPart part;
  Water water;  // of one density, the mean of that which the body displaces
};

// Layered water is as water of the mean density of what the body displaces: with volume and wetted area under
// the surface, and with moments of the volume, and waterplane, that are sums over the terms, each times its
// step over that of the mean density. Centre of buoyancy, metacentres, stiffness and displaced mass follow
// from them as in water of one density. part_at(depth): returns the immersed part below a top.
template <typename PartAt>
MeanImmersedPart mean_immersed_part(const Water& water, const PartAt& part_at) {
  const ImmersedPart surface = part_at(0.0);
  ImmersedPart sum;
  for_each_step(water, [&](double step, double depth) {
    add_scaled(depth > 0.0 ? part_at(depth) : surface, Vec3::Zero(), step, sum);
  });
  const double mean = mean_step(water, sum.moments.volume, surface.moments.volume);
  ImmersedPart part;
  add_scaled(sum, Vec3::Zero(), 1.0 / mean, part);
  part.wetted_area = surface.wetted_area;
  return {
      part,
      {.up_W = water.up_W, .level = water.level, .density = mean * water.density, .gravity = water.gravity}};
}

// Computes what hydrostatics() returns, in water with or without layers. part_at: see mean_immersed_part().
// The other arguments are those of hydrostatics_of() for one density.
template <typename PartAt>
std::optional<Hydrostatics> hydrostatics_in(const Water& water, const PartAt& part_at, const Vec3& origin_B,
                                            double volume_tolerance, const Eigen::Quaterniond& q_WB,
                                            const Vec3& reference_B,
                                            const std::optional<Vec3>& center_of_mass_B,
                                            const LiquidSum& liquids = {}) {
  if (water.layers.empty()) {
    return hydrostatics_of(part_at(0.0), origin_B, volume_tolerance, q_WB, water, reference_B,
                           center_of_mass_B, liquids);
  }
  const MeanImmersedPart mean = mean_immersed_part(water, part_at);
  return hydrostatics_of(mean.part, origin_B, volume_tolerance, q_WB, mean.water, reference_B,
                         center_of_mass_B, liquids);
}

}  // namespace buoyancy
