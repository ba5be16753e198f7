#include "hydrostatics/hydrostatics.h"

#include <algorithm>
#include <limits>

#include "hydrostatics/density_steps.h"
#include "hydrostatics/immersed_part.h"
#include "hydrostatics/immersion.h"
#include "hydrostatics/wetted_moments.h"

namespace buoyancy {

std::optional<Hydrostatics> hydrostatics(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                                         const Vec3& reference_B,
                                         const std::optional<Vec3>& center_of_mass_B) {
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  const auto part_at = [&](double depth) { return immersed_part(mesh, lowered(plane, depth)); };
  return hydrostatics_in(water, part_at, mesh.center_B, mesh.volume_tolerance(), pose.q_WB, reference_B,
                         center_of_mass_B);
}

WettedArea wetted_area(const HydrostaticMesh& mesh, const Pose& pose, const Water& water) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  switch (immersion(mesh, plane)) {
    case Immersion::kDry:
      return {};
    case Immersion::kSubmerged:
      return {mesh.area, 64.0 * kEpsilon * mesh.area};
    case Immersion::kPiercing:
      break;
  }
  const auto area_at = [&](double rise) {
    WaterPlane moved = plane;
    moved.h_c += rise;
    moved.h_c_rest = 0.0;
    return std::clamp(wetted_moments(*mesh.tree, moved).area, 0.0, mesh.area);
  };
  const double rise = 32.0 * kEpsilon * mesh.diagonal;  // exceeds the rounding of heights
  const double value = area_at(0.0);
  return {value, std::max(area_at(rise) - value, value - area_at(-rise)) + 64.0 * kEpsilon * mesh.area};
}

}  // namespace buoyancy
