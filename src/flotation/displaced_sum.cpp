#include "flotation/displaced_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/density_steps.h"
#include "hydrostatics/hierarchical.h"

namespace buoyancy {
namespace {

using SignedVolume = FloatingBody::SignedVolume;

// Returns the plane in the mesh's frame, about the mesh's centre.
WaterPlane plane_of(const SignedVolume& volume, const WaterPlane& plane) {
  if (!volume.is_turned && volume.offset_B.isZero(0.0)) return plane;
  WaterPlane moved;
  moved.up_B = volume.R_B.transpose() * plane.up_B;
  moved.h_c = plane.h_c - plane.up_B.dot(volume.offset_B);
  return moved;
}

}  // namespace

DisplacedSum displaced_by(const SignedVolume& volume, const WaterPlane& plane, const Water& water) {
  DisplacedSum sum{.volume = -0.0};  // to which a single term of -0 adds up, too
  for_each_step(water, [&](double step, double depth) {
    const Displacement displaced = hierarchical(*volume.placed.mesh, plane_of(volume, lowered(plane, depth)));
    const double factor = step * volume.placed.signed_permeability;
    sum.volume += factor * displaced.volume;
    sum.moment += factor * (volume.R_B * displaced.moment + displaced.volume * volume.offset_B);
    sum.depth_moment += factor * depth * displaced.volume;
  });
  return sum;
}

DisplacedSum displaced_sum(const FloatingBody& body, const WaterPlane& plane, const Water& water) {
  DisplacedSum sum;
  for (const SignedVolume& volume : body.volumes()) {
    const DisplacedSum part = displaced_by(volume, plane, water);
    sum.volume += part.volume;
    sum.moment += part.moment;
    sum.depth_moment += part.depth_moment;
  }
  return sum;
}

DisplacedBounds displaced_bounds(const FloatingBody& body, const WaterPlane& plane, const Water& water) {
  DisplacedBounds bounds;
  for (const SignedVolume& volume : body.volumes()) {
    const HydrostaticMesh& mesh = *volume.placed.mesh;
    double rounding = 0.0;
    for_each_step(water, [&](double step, double depth) {
      const Displacement displaced = hierarchical(mesh, plane_of(volume, lowered(plane, depth)));
      rounding += step * (mesh.rounding_bound() + displaced.rounding + volume.plane_rounding);
    });
    const double error = std::abs(volume.placed.signed_permeability) * rounding;
    const Vec3 reference = volume.R_B.transpose() * (body.center_of_mass_B() - volume.placed.position_B);
    bounds.volume += error;
    bounds.moment += error * mesh.max_lever_arm(reference);
  }
  return bounds;
}

ImmersedPart immersed_sum(const FloatingBody& body, const WaterPlane& plane) {
  ImmersedPart sum;
  for (const SignedVolume& volume : body.volumes()) {
    ImmersedPart part = immersed_part(*volume.placed.mesh, plane_of(volume, plane));
    if (volume.is_turned) {
      part.moments = part.moments.rotated(volume.R_B);
      part.point = volume.R_B * part.point;
    }
    add_scaled(part, volume.offset_B, volume.placed.signed_permeability, sum);
  }
  return sum;
}

double wetted_area_sum(const FloatingBody& body, const WaterPlane& plane) {
  double area = 0.0;
  for (const SignedVolume& volume : body.volumes()) {
    if (volume.placed.signed_permeability > 0.0) {
      area += wetted_area(*volume.placed.mesh, plane_of(volume, plane));
    }
  }
  return area;
}

LiquidSum liquid_sum(const FloatingBody& body, const Vec3& up_B, FreeSurfaces free_surfaces) {
  return liquid_sum(body.tanks(), up_B, body.center_B(), free_surfaces);
}

Vec3 mass_moment(const FloatingBody& body, const LiquidSum& liquids) {
  return body.mass() * (body.center_of_mass_B() - body.center_B()) + liquids.moment;
}

Vec3 total_center_of_mass_B(const FloatingBody& body, const LiquidSum& liquids) {
  if (body.tanks().empty()) return body.center_of_mass_B();
  return body.center_B() + mass_moment(body, liquids) / body.total_mass();
}

double liquid_moment_bound(const FloatingBody& body, const Vec3& point_B) {
  // The error of the level adds at most as much as the rounding of the volume under it.
  constexpr double kWithLevel = 2.0;
  double bound = 0.0;
  for (const Tank& tank : body.tanks()) {
    bound += kWithLevel * tank.density * tank.mesh->max_rounding_bound() * tank.mesh->max_lever_arm(point_B);
  }
  return bound;
}

Waterline waterline_sum(const FloatingBody& body, const WaterPlane& plane, const Vec3& u,
                        const Water& water) {
  const Vec3 v = plane.up_B.cross(u);
  Waterline sum;
  for (const SignedVolume& volume : body.volumes()) {
    const Mat3 R = volume.R_B.transpose();
    for_each_step(water, [&](double step, double depth) {
      const Waterline line = waterline(*volume.placed.mesh, plane_of(volume, lowered(plane, depth)),
                                       {.u = R * u, .v = R * v, .origin = R * -volume.offset_B});
      const double factor = step * volume.placed.signed_permeability;
      sum.area += factor * line.area;
      sum.u += factor * line.u;
      sum.v += factor * line.v;
      sum.uu += factor * line.uu;
      sum.uv += factor * line.uv;
      sum.vv += factor * line.vv;
      if (factor < 0.0 || depth > 0.0) return;
      sum.min_u = std::min(sum.min_u, line.min_u);
      sum.max_u = std::max(sum.max_u, line.max_u);
      sum.min_v = std::min(sum.min_v, line.min_v);
      sum.max_v = std::max(sum.max_v, line.max_v);
    });
  }
  return sum;
}

bool is_boundary_wet(const FloatingBody& body, const WaterPlane& plane) {
  if (!body.is_open()) return false;
  const SignedVolume& volume = body.volumes().front();
  const WaterPlane of_mesh = plane_of(volume, plane);
  const HydrostaticMesh& mesh = *volume.placed.mesh;
  return std::any_of(mesh.boundary_vertices.begin(), mesh.boundary_vertices.end(),
                     [&](std::int32_t i) { return of_mesh.height(mesh.vertex(i)) < 0.0; });
}

HeightRange height_range(const FloatingBody& body, const Vec3& up_B, const Water& water) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  HeightRange range{kInfinity, -kInfinity};
  double deepest = 0.0;  // [m], top of a layer
  for (const SignedVolume& volume : body.volumes()) {
    const HydrostaticMesh& mesh = *volume.placed.mesh;
    const Vec3 up = volume.R_B.transpose() * up_B;
    const double middle = up_B.dot(volume.offset_B) + 0.5 * up.dot(mesh.box_min + mesh.box_max);
    const double half = 0.5 * up.cwiseAbs().dot(mesh.box_max - mesh.box_min) + 1e-9 * mesh.diagonal;
    range.low = std::min(range.low, -(middle + half));
    range.high = std::max(range.high, -(middle - half));
    if (!mesh.is_open()) continue;
    double lowest = kInfinity;
    for (const std::int32_t i : mesh.boundary_vertices) {
      lowest = std::min(lowest, up_B.dot(volume.offset_B) + up.dot(mesh.vertex(i)));
    }
    range.low = -lowest + 1e-12 * mesh.diagonal;
  }
  if (!body.is_open()) for_each_step(water, [&](double, double depth) { deepest = depth; });
  range.low -= deepest;
  return range;
}

}  // namespace buoyancy
