#include "hydrostatics/immersed_part.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/immersion.h"
#include "hydrostatics/wetted_moments.h"

namespace buoyancy {
namespace {

// second_moments_W: about the centroid. Only its horizontal part is used.
void add_principal_moments(const Mat3& second_moments_W, const Vec3& up_W, Hydrostatics& result) {
  const Vec3 u = up_W.unitOrthogonal();
  const Vec3 v = up_W.cross(u);
  const double uu = u.dot(second_moments_W * u);
  const double vv = v.dot(second_moments_W * v);
  const double uv = 0.5 * (u.dot(second_moments_W * v) + v.dot(second_moments_W * u));
  const double half_difference = 0.5 * (uu - vv);
  const double radius = std::sqrt(half_difference * half_difference + uv * uv);
  const double mean = 0.5 * (uu + vv);
  // The axis in the waterplane's longest direction has the smaller second moment.
  Vec3 longest = half_difference >= 0.0 ? Vec3((half_difference + radius) * u + uv * v)
                                        : Vec3(uv * u + (radius - half_difference) * v);
  const double length = longest.norm();
  longest = length > 0.0 ? Vec3(longest / length) : u;
  result.waterplane_second_moments = {std::max(0.0, mean - radius), mean + radius};
  result.waterplane_axes_W = {longest, up_W.cross(longest)};
}

// moments_W: about point_W, which is relative to p_WB.
void add_waterplane(const DisplacementMoments<double>& moments_W, const Vec3& point_W, const Vec3& up_W,
                    Hydrostatics& result) {
  result.waterplane_area = moments_W.waterplane_area;
  if (!(result.waterplane_area > 0.0)) return;
  const Vec3 to_centroid_W = moments_W.waterplane_moment / result.waterplane_area;
  result.waterplane_centroid_W = point_W + to_centroid_W;
  add_principal_moments(moments_W.moved(to_centroid_W).waterplane_second_moments, up_W, result);
}

// moments_W: about point_W, which is relative to p_WB. mass_to_point_W: from the centre of mass, if it is
// known, to point_W. Requires a preceding call of add_waterplane().
void add_metacenters(const DisplacementMoments<double>& moments_W, const Vec3& point_W, const Vec3& up_W,
                     const std::optional<Vec3>& mass_to_point_W, Hydrostatics& result) {
  const Vec3 to_buoyancy_W = moments_W.moment / moments_W.volume;
  result.center_of_buoyancy_W = point_W + to_buoyancy_W;
  for (std::size_t i = 0; i < 2; ++i) {
    const double radius = result.waterplane_second_moments[i] / moments_W.volume;
    result.metacentric_radii[i] = radius;
    result.metacenters_W[i] = result.center_of_buoyancy_W + radius * up_W;
    if (mass_to_point_W) {
      result.metacentric_heights[i] = up_W.dot(*mass_to_point_W + to_buoyancy_W) + radius;
    }
  }
}

// Subtracts the free-surface effect from the metacentric heights, which stay NaN where they are unknown.
void subtract_free_surface(const Mat3& free_surface_W, const Water& water, Hydrostatics& result) {
  const double displaced_mass = water.density * result.volume;
  if (result.waterplane_area > 0.0) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 across = water.up_W.cross(result.waterplane_axes_W[i]);
      result.metacentric_heights[i] -= across.dot(free_surface_W * across) / displaced_mass;
    }
    return;
  }
  // Without a waterplane the free surfaces alone define the axes, in the order of ascending height.
  Hydrostatics of_surfaces;
  add_principal_moments(free_surface_W, water.up_W, of_surfaces);
  for (std::size_t i = 0; i < 2; ++i) {
    result.metacentric_heights[i] -= of_surfaces.waterplane_second_moments[1 - i] / displaced_mass;
  }
}

bool finite(const Hydrostatics& result) {
  return std::isfinite(result.volume) && std::isfinite(result.wetted_area) &&
         std::isfinite(result.waterplane_area) && std::isfinite(result.waterplane_second_moments[1]) &&
         result.stiffness.allFinite();
}

}  // namespace

ImmersedPart immersed_part(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  ImmersedPart part;
  switch (immersion(mesh, plane)) {
    case Immersion::kDry:
      break;
    case Immersion::kSubmerged:
      part.moments.volume = mesh.volume;
      part.point = mesh.centroid;
      part.wetted_area = mesh.area;
      break;
    case Immersion::kPiercing: {
      const WettedMoments wetted = wetted_moments(*mesh.tree, plane);
      part.moments = displacement_moments(wetted.moments, wetted.height, plane.up_B);
      part.point = wetted.point;
      part.wetted_area = wetted.area;
      const double area_tolerance = 64.0 * std::numeric_limits<double>::epsilon() * mesh.area;
      if (!(part.moments.waterplane_area > area_tolerance)) {
        part.moments.waterplane_area = 0.0;
        part.moments.waterplane_moment.setZero();
        part.moments.waterplane_second_moments.setZero();
      }
      break;
    }
  }
  return part;
}

double wetted_area(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  switch (immersion(mesh, plane)) {
    case Immersion::kDry:
      return 0.0;
    case Immersion::kSubmerged:
      return mesh.area;
    case Immersion::kPiercing:
      break;
  }
  return wetted_area(*mesh.tree, plane);
}

void add_scaled(const ImmersedPart& part, const Vec3& offset_B, double factor, ImmersedPart& sum) {
  if (part.moments.volume == 0.0 && part.wetted_area == 0.0) return;
  const bool is_first = sum.moments.volume == 0.0 && sum.wetted_area == 0.0;
  const Vec3 point = offset_B + part.point;
  if (is_first) sum.point = point;
  const DisplacementMoments<double> moments = is_first ? part.moments : part.moments.moved(sum.point - point);
  sum.moments.volume += factor * moments.volume;
  sum.moments.moment += factor * moments.moment;
  sum.moments.waterplane_area += factor * moments.waterplane_area;
  sum.moments.waterplane_moment += factor * moments.waterplane_moment;
  sum.moments.waterplane_second_moments += factor * moments.waterplane_second_moments;
  if (factor > 0.0) sum.wetted_area += part.wetted_area;
}

std::optional<Hydrostatics> hydrostatics_of(const ImmersedPart& part, const Vec3& origin_B,
                                            double volume_tolerance, const Eigen::Quaterniond& q_WB,
                                            const Water& water, const Vec3& reference_B,
                                            const std::optional<Vec3>& center_of_mass_B,
                                            const LiquidSum& liquids) {
  const Mat3 R_WB = q_WB.normalized().toRotationMatrix();
  const DisplacementMoments<double> moments_W = part.moments.rotated(R_WB);
  const Vec3 point_W = R_WB * (origin_B + part.point);  // from p_WB

  Hydrostatics result;
  result.density = water.density;
  result.volume = moments_W.volume;
  result.wetted_area = part.wetted_area;
  add_waterplane(moments_W, point_W, water.up_W, result);
  if (result.volume > volume_tolerance) {
    std::optional<Vec3> mass_to_point_W;
    if (center_of_mass_B) mass_to_point_W = R_WB * ((origin_B - *center_of_mass_B) + part.point);
    add_metacenters(moments_W, point_W, water.up_W, mass_to_point_W, result);
  }
  const Vec3 to_reference_W = R_WB * ((reference_B - origin_B) - part.point);
  result.stiffness = water.density * water.gravity * stiffness(moments_W.moved(to_reference_W), water.up_W);
  if (liquids.mass > 0.0) {
    // The liquid's weight is the negative of a displacement at a level that keeps the liquid's volume.
    DisplacementMoments<double> weight;
    weight.volume = liquids.mass;
    weight.moment = liquids.moment;
    weight.waterplane_second_moments = liquids.free_surface;
    weight = weight.rotated(R_WB);
    result.stiffness -= water.gravity * stiffness(weight, water.up_W);
    subtract_free_surface(weight.waterplane_second_moments, water, result);
  }
  if (!finite(result)) return std::nullopt;
  return result;
}

}  // namespace buoyancy
