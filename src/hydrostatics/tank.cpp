#include "hydrostatics/tank.h"

#include <cmath>
#include <limits>

#include "hydrostatics/hierarchical.h"
#include "hydrostatics/immersed_part.h"
#include "hydrostatics/level_search.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The part of a tank below a level.
struct FilledTo {
  double level = 0.0;  // [m], of the plane over c
  Displacement below;
  double excess = 0.0;  // [m^3], over the liquid's volume
};

FilledTo fill_to(const Tank& tank, const Vec3& up_B, double level) {
  FilledTo filled{.level = level, .below = hierarchical(*tank.mesh, {.up_B = up_B, .h_c = level})};
  filled.excess = filled.below.volume - tank.liquid_volume;
  return filled;
}

FilledTo find_level(const Tank& tank, const Vec3& up_B) {
  constexpr int kMaxRounds = 200;
  const HydrostaticMesh& mesh = *tank.mesh;
  const double middle = 0.5 * up_B.dot(mesh.box_min + mesh.box_max);
  const double half = 0.5 * up_B.cwiseAbs().dot(mesh.box_max - mesh.box_min);
  const double low = middle - half;
  const double high = middle + half;
  const double exact = 2.0 * kEpsilon * tank.liquid_volume;
  const double rounding = 4.0 * kEpsilon * mesh.volume;

  double level = low + (high - low) * (tank.liquid_volume / mesh.volume);
  LevelSearch search(low, high, tank.liquid_volume / (level - low));  // the slope of a box
  FilledTo best;
  for (int round = 0;; ++round) {
    const FilledTo filled = fill_to(tank, up_B, level);
    if (round == 0 || std::abs(filled.excess) < std::abs(best.excess)) best = filled;
    search.add(level, filled.excess, filled.excess);
    const bool is_slow = search.is_slow(1);
    const bool is_found = std::abs(filled.excess) <= exact || search.is_narrow() ||
                          (is_slow && std::abs(best.excess) <= rounding);
    if (is_found || round == kMaxRounds) return best;
    level = search.next(is_slow);
  }
}

}  // namespace

TankLiquid tank_liquid(const Tank& tank, const Vec3& up_B) {
  TankLiquid liquid;
  const HydrostaticMesh& mesh = *tank.mesh;
  liquid.volume = tank.liquid_volume;
  if (!(tank.liquid_volume > 0.0)) return liquid;
  liquid.volume_error = mesh.rounding_bound();
  if (tank.liquid_volume >= mesh.volume) {
    liquid.centroid = mesh.centroid;
    return liquid;
  }
  const Vec3& across_B = tank.piston_axis_B ? *tank.piston_axis_B : up_B;
  const FilledTo filled = find_level(tank, across_B);
  liquid.has_free_surface = !tank.piston_axis_B;
  liquid.surface = {.up_B = across_B, .h_c = filled.level};
  liquid.volume = filled.below.volume;
  liquid.volume_error += filled.below.rounding + std::abs(filled.excess);
  if (liquid.volume > 0.0) liquid.centroid = filled.below.moment / liquid.volume;
  return liquid;
}

Mat3 free_surface_second_moments(const Tank& tank, const TankLiquid& liquid) {
  if (!liquid.has_free_surface) return Mat3::Zero();
  const DisplacementMoments<double> moments = immersed_part(*tank.mesh, liquid.surface).moments;
  if (!(moments.waterplane_area > 0.0)) return Mat3::Zero();
  return moments.moved(moments.waterplane_moment / moments.waterplane_area).waterplane_second_moments;
}

void add_liquid(const Tank& tank, const TankLiquid& liquid, const Vec3& about_B, FreeSurfaces free_surfaces,
                LiquidSum& sum) {
  if (!(tank.liquid_volume > 0.0)) return;
  const double mass = tank.liquid_mass();
  sum.mass += mass;
  sum.moment += mass * ((tank.mesh->center_B - about_B) + liquid.centroid);
  if (free_surfaces == FreeSurfaces::kNo) return;
  sum.free_surface += tank.density * free_surface_second_moments(tank, liquid);
}

LiquidSum liquid_sum(std::span<const Tank> tanks, const Vec3& up_B, const Vec3& about_B,
                     FreeSurfaces free_surfaces) {
  LiquidSum sum;
  for (const Tank& tank : tanks) add_liquid(tank, tank_liquid(tank, up_B), about_B, free_surfaces, sum);
  return sum;
}

}  // namespace buoyancy
