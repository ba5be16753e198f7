#include "engine/result_comparison.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

// The error bound [m] of the centre of buoyancy M/V is 2 lever dV / V: |dM| <= lever dV, and the centre is no
// farther from the reference point than the lever, torque bound / force bound. It is kAnyCenter if V does not
// exceed its error bound.
constexpr double kAnyCenter = 1e300;
double center_bound(const BodyWrench& wrench) {
  const double force = std::hypot(wrench.force[0], wrench.force[1], wrench.force[2]);
  if (!(force > wrench.force_error_bound)) return kAnyCenter;
  return 2.0 * wrench.torque_error_bound / force;
}

}  // namespace

void WrenchDifferences::update(const WrenchDifferences& other) {
  force = std::max(force, other.force);
  torque = std::max(torque, other.torque);
  volume = std::max(volume, other.volume);
  center = std::max(center, other.center);
  force_in_bounds = std::max(force_in_bounds, other.force_in_bounds);
  torque_in_bounds = std::max(torque_in_bounds, other.torque_in_bounds);
  center_in_bounds = std::max(center_in_bounds, other.center_in_bounds);
}

WrenchDifferences compare_wrenches(const BodyWrench& now, const BodyWrench& baseline) {
  WrenchDifferences differences;
  differences.force = distance(now.force, baseline.force);
  differences.torque = distance(now.torque, baseline.torque);
  differences.volume = distance(now.submerged_volume, baseline.submerged_volume);
  differences.center = distance(now.center_of_buoyancy, baseline.center_of_buoyancy);
  differences.force_in_bounds =
      in_bounds(differences.force, now.force_error_bound + baseline.force_error_bound);
  differences.torque_in_bounds =
      in_bounds(differences.torque, now.torque_error_bound + baseline.torque_error_bound);
  differences.center_in_bounds = in_bounds(differences.center, center_bound(now) + center_bound(baseline));
  return differences;
}

// Each result carries the rounding error of sums over the body's surface: proportional to the area, times one
// length per dimension of the field beyond an area. docs/replay.md lists the tolerances.
void compare_hydrostatics(const BodyHydrostatics& now, const BodyHydrostatics& baseline, const Body& body,
                          const Water& water, MessageDifferences& differences) {
  const HydrostaticMesh& mesh = body.solver.mesh();
  const double length = mesh.diagonal;
  const double area = kRounding * mesh.area;
  const double second_moment = 4.0 * area * length * length;
  const double volume = 2.0 * mesh.volume_tolerance() + area * length;
  const double point = kRounding * mesh.max_lever_arm(Vec3::Zero());
  const double smaller_volume = std::min(now.submerged_volume, baseline.submerged_volume);
  const double smaller_plane = std::min(now.waterplane_area, baseline.waterplane_area);
  const double center = 2.0 * volume * length / smaller_volume + point;

  FieldDifferences fields;
  fields.add("submerged_volume", now.submerged_volume, baseline.submerged_volume, volume);
  fields.add_if_defined("center_of_buoyancy", now.center_of_buoyancy, baseline.center_of_buoyancy, center);
  fields.add("wetted_area", now.wetted_area, baseline.wetted_area, area);
  fields.add("waterplane_area", now.waterplane_area, baseline.waterplane_area, area);
  fields.add_if_defined("waterplane_centroid", now.waterplane_centroid, baseline.waterplane_centroid,
                        2.0 * area * length / smaller_plane + point);
  const double gap = std::min(now.waterplane_second_moments[1] - now.waterplane_second_moments[0],
                              baseline.waterplane_second_moments[1] - baseline.waterplane_second_moments[0]);
  for (std::size_t i = 0; i < 2; ++i) {
    fields.add("waterplane_second_moments", now.waterplane_second_moments[i],
               baseline.waterplane_second_moments[i], second_moment);
    // The axes are arbitrary if both second moments are equal within their error.
    if (!(2.0 * second_moment >= gap)) {
      fields.add_axis("waterplane_axes", now.waterplane_axes[i], baseline.waterplane_axes[i],
                      2.0 * second_moment / gap + kRounding);
    } else if (!std::ranges::equal(now.waterplane_axes[i], baseline.waterplane_axes[i],
                                   [](double a, double b) { return std::isnan(a) == std::isnan(b); })) {
      fields.add("waterplane_axes", now.waterplane_axes[i], baseline.waterplane_axes[i], 0.0);
    }
    const double radius =
        (second_moment + std::max(now.metacentric_radii[i], baseline.metacentric_radii[i]) * volume) /
        smaller_volume;
    fields.add_if_defined("metacentric_radii", now.metacentric_radii[i], baseline.metacentric_radii[i],
                          radius);
    fields.add_if_defined("metacenters", now.metacenters[i], baseline.metacenters[i], center + radius);
    fields.add_if_defined("metacentric_heights", now.metacentric_heights[i], baseline.metacentric_heights[i],
                          center + radius);
  }
  const double lever = mesh.max_lever_arm(body.reference_B) + length;
  const double weight = deepest_density(water) * water.gravity;  // N/m^3
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      double tolerance = weight * area;
      if ((row < 3) != (column < 3)) tolerance *= 2.0 * lever;
      if (row >= 3 && column >= 3) tolerance = weight * (4.0 * area * lever + 2.0 * volume) * lever;
      fields.add("stiffness", now.stiffness[row][column], baseline.stiffness[row][column], tolerance);
    }
  }
  fields.add_to(differences);
}

}  // namespace buoyancy
