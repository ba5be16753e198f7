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
  if (highest < -margin && !mesh.open()) return Immersion::kWet;
  return Immersion::kCrossing;
}

Immersion immersion_at_a_glance(const HydrostaticMesh& mesh, const Pose& pose, const Water& water) {
  const RoughWaterPlane plane = rough_water_plane_in_body(pose, water, mesh.center_B, mesh.diagonal);
  // Where the squares overflow no comparison holds; where they underflow their error would not be one.
  if (!(plane.norm_squared > 1e-100)) return Immersion::kCrossing;
  const Vec3 middle = 0.5 * (mesh.box_min + mesh.box_max);
  const Vec3 half = 0.5 * (mesh.box_max - mesh.box_min);
  const double height = plane.up_B.dot(middle) - plane.h_c;
  const double reach = plane.up_B.cwiseAbs().dot(half);
  if (height - reach > plane.error) return Immersion::kDry;
  if (height + reach < -plane.error && !mesh.open()) return Immersion::kWet;
  return Immersion::kCrossing;
}

}  // namespace buoyancy
