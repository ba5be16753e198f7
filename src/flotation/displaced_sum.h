// Sums over the meshes of a floating body at a water plane in its frame.
//
// Sums that take a `water` with layers are also sums over the terms of its pressure, each times its step of
// density over the density at the surface (density_steps.h): that density times such a volume is the
// displaced mass. Planes are those of the surface.
#pragma once

#include "flotation/floating_body.h"
#include "flotation/waterline.h"
#include "hydrostatics/immersed_part.h"

namespace buoyancy {

// About the body's center_B, B axes.
struct DisplacedSum {
  double volume = 0.0;         // [m^3]
  Vec3 moment = Vec3::Zero();  // [m^4]
  // [m^4], of the volume under the top of each layer, times the depth of the top: its part of the energy
  double depth_moment = 0.0;
};

// What one of the body's meshes adds to the sum, with its sign.
DisplacedSum displaced_by(const FloatingBody::SignedVolume& volume, const WaterPlane& plane,
                          const Water& water);

// All planes are about the body's center_B. Complexity: that of `hierarchical` per mesh, and per layer.
DisplacedSum displaced_sum(const FloatingBody& body, const WaterPlane& plane, const Water& water);

struct DisplacedBounds {
  double volume = 0.0;  // [m^3], bound on the error of the volume
  double moment = 0.0;  // [m^4], of the moment's horizontal part, about the centre of mass
};
DisplacedBounds displaced_bounds(const FloatingBody& body, const WaterPlane& plane, const Water& water);

// The part's point is relative to the body's center_B.
ImmersedPart immersed_sum(const FloatingBody& body, const WaterPlane& plane);

// [m^2], of the meshes that displace water, without the waterplane.
double wetted_area_sum(const FloatingBody& body, const WaterPlane& plane);

// Sums the liquids in the tanks about the body's center_B, with their free surfaces if requested. Complexity:
// that of tank_liquid() per tank.
LiquidSum liquid_sum(const FloatingBody& body, const Vec3& up_B, FreeSurfaces free_surfaces);

// [kg m], first moment of the masses of the body and these liquids about the body's center_B.
Vec3 mass_moment(const FloatingBody& body, const LiquidSum& liquids);
// [m], the centre of mass of the body and these liquids, in B.
Vec3 total_center_of_mass_B(const FloatingBody& body, const LiquidSum& liquids);

// [kg m], bound on the error of the liquids' moment about a point.
double liquid_moment_bound(const FloatingBody& body, const Vec3& point_B);

// Sums the waterplane in the axes u and v = up x u of the plane, about the body's center_B. Its extent is
// that of the meshes that displace water, at the surface. u: unit, horizontal, B axes. Errors: see
// waterline().
Waterline waterline_sum(const FloatingBody& body, const WaterPlane& plane, const Vec3& u, const Water& water);

bool is_boundary_wet(const FloatingBody& body, const WaterPlane& plane);

// Heights of center_B over the water between which the body is neither dry nor fully submerged, in layered
// water under the top of the deepest layer; for an open mesh, at the lower end its boundary is at the
// surface.
struct HeightRange {
  double low = 0.0;   // [m]
  double high = 0.0;  // [m]
};
HeightRange height_range(const FloatingBody& body, const Vec3& up_B, const Water& water);

}  // namespace buoyancy
