#include "hydrostatics/tank.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/hierarchical.h"
#include "hydrostatics/immersed_part.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The tank up to a level.
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

// The volume rises with the level: false position, with bisection where that is slow.
FilledTo find_level(const Tank& tank, const Vec3& up_B) {
  constexpr int kMaxRounds = 200;
  const HydrostaticMesh& mesh = *tank.mesh;
  const double middle = 0.5 * up_B.dot(mesh.box_min + mesh.box_max);
  const double half = 0.5 * up_B.cwiseAbs().dot(mesh.box_max - mesh.box_min);
  double low = middle - half;
  double high = middle + half;
  const double scale = std::max(std::abs(low), std::abs(high));
  const double exact = 2.0 * kEpsilon * tank.liquid_volume;
  const double rounding = 4.0 * kEpsilon * mesh.volume;

  FilledTo best = fill_to(tank, up_B, low + (high - low) * (tank.liquid_volume / mesh.volume));
  FilledTo last = best;
  double older_excess = std::numeric_limits<double>::infinity();
  double area = tank.liquid_volume / (best.level - low);  // [m^2], of the surface, roughly
  for (int round = 0; round < kMaxRounds; ++round) {
    (last.excess > 0.0 ? high : low) = last.level;
    if (std::abs(last.excess) <= exact || high - low <= 2.0 * kEpsilon * scale) break;
    const bool is_slow = round >= 2 && std::abs(last.excess) > 0.5 * older_excess;
    if (is_slow && std::abs(best.excess) <= rounding) break;
    double level = area > 0.0 ? last.level - last.excess / area : high;
    if (!(level > low && level < high) || is_slow) level = 0.5 * (low + high);
    const FilledTo next = fill_to(tank, up_B, level);
    if (next.level != last.level && next.excess != last.excess) {
      area = (next.excess - last.excess) / (next.level - last.level);
    }
    older_excess = std::abs(last.excess);
    last = next;
    if (std::abs(last.excess) < std::abs(best.excess)) best = last;
  }
  return best;
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
  const FilledTo filled = find_level(tank, up_B);
  liquid.has_free_surface = true;
  liquid.surface = {.up_B = up_B, .h_c = filled.level};
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

void add_liquid(const Tank& tank, const TankLiquid& liquid, const Vec3& about_B, LiquidSum& sum) {
  if (!(tank.liquid_volume > 0.0)) return;
  const double mass = tank.liquid_mass();
  sum.mass += mass;
  sum.moment += mass * ((tank.mesh->center_B - about_B) + liquid.centroid);
}

void add_free_surface(const Tank& tank, const TankLiquid& liquid, LiquidSum& sum) {
  sum.free_surface += tank.density * free_surface_second_moments(tank, liquid);
}

}  // namespace buoyancy
