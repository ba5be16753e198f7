#include "flotation/tank_table.h"

#include <limits>

#include "hydrostatics/hierarchical.h"
#include "hydrostatics/lowest_vertex.h"

namespace buoyancy {

SoundingPipe sounding_pipe(const Tank& tank, const ShipAxes& axes, const std::optional<Vec3>& foot_B) {
  const HydrostaticMesh& mesh = *tank.mesh;
  const Vec3 up_B = tank.piston_axis_B.value_or(axes.up_B);
  const double lowest = lowest_vertex(*mesh.tree, up_B);
  const double highest = -lowest_vertex(*mesh.tree, -up_B);
  Vec3 foot = mesh.centroid + (lowest - up_B.dot(mesh.centroid)) * up_B;  // about c
  if (foot_B && !tank.piston_axis_B) foot = *foot_B - mesh.center_B;
  return {mesh.center_B + foot, highest - up_B.dot(foot)};
}

TankTableRow tank_table_row(const Tank& tank, const ShipAxes& axes, const HeelTrim& angles,
                            const SoundingPipe& pipe, double sounding) {
  const HydrostaticMesh& mesh = *tank.mesh;
  const Vec3 along_B = tank.piston_axis_B.value_or(axes.up_B);
  const Vec3 up_B = tank.piston_axis_B ? along_B : up_at(axes, angles);
  TankLiquid liquid;
  liquid.surface = {.up_B = up_B,
                    .h_c = up_B.dot(pipe.foot_B - mesh.center_B) + sounding * up_B.dot(along_B)};
  const Displacement below = hierarchical(mesh, liquid.surface);
  const double rounding = mesh.rounding_bound() + below.rounding;

  TankTableRow row{.angles = angles, .sounding = sounding};
  if (!(below.volume > rounding)) {
    row.centroid_B = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return row;
  }
  const bool is_full = mesh.volume - below.volume <= rounding;
  row.volume = is_full ? mesh.volume : below.volume;
  row.mass = tank.density * row.volume;
  row.centroid_B = mesh.center_B + (is_full ? mesh.centroid : Vec3(below.moment / below.volume));
  liquid.has_free_surface = !is_full && !tank.piston_axis_B;
  const Mat3 moments = tank.density * free_surface_second_moments(tank, liquid);
  const Vec3 across_B = starboard_at(axes, angles.heel);
  const Vec3 forward_B = up_B.cross(across_B);
  row.free_surface_moment_t = across_B.dot(moments * across_B);
  row.free_surface_moment_l = forward_B.dot(moments * forward_B);
  return row;
}

}  // namespace buoyancy
