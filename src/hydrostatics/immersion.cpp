#include "hydrostatics/immersion.h"

#include <limits>

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

Immersion immersion(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 at_min = plane.up_B.cwiseProduct(mesh.box_min);
  const Vec3 at_max = plane.up_B.cwiseProduct(mesh.box_max);
  const double lowest = at_min.cwiseMin(at_max).sum() - plane.h_c;
  const double highest = at_min.cwiseMax(at_max).sum() - plane.h_c;
  const double margin = plane.error + 8.0 * kEpsilon * (mesh.diagonal + std::abs(plane.h_c));
  if (lowest > margin) return Immersion::kDry;
  if (highest < -margin && !mesh.is_open()) return Immersion::kSubmerged;
  return Immersion::kPiercing;
}

Immersion quick_immersion(const HydrostaticMesh& mesh, const Pose& pose, const Water& water) {
  const RoughWaterPlane plane = rough_water_plane_in_body(pose, water, mesh.center_B, mesh.diagonal);
  // If the squares overflow, no comparison below holds; if they underflow, plane.error is not a bound.
  if (!(plane.norm_squared > 1e-100)) return Immersion::kPiercing;
  const auto box_min = Point<double>::from(mesh.box_min);
  const auto box_max = Point<double>::from(mesh.box_max);
  const Point<double>& up = plane.up_B;
  const double height = dot(up, 0.5 * (box_min + box_max)) - plane.h_c;
  const double reach = dot({std::abs(up.x), std::abs(up.y), std::abs(up.z)}, 0.5 * (box_max - box_min));
  if (height - reach > plane.error) return Immersion::kDry;
  if (height + reach < -plane.error && !mesh.is_open()) return Immersion::kSubmerged;
  return Immersion::kPiercing;
}

}  // namespace buoyancy
