#include "flotation/floating_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/format.h"
#include "flotation/displaced_sum.h"
#include "hydrostatics/density_steps.h"
#include "hydrostatics/lowest_vertex.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

std::optional<Error> fault_of(const PlacedMesh& placed, std::size_t count) {
  Error error{.subject = "floating body", .actual = "", .expected = "", .cause = "", .hint = ""};
  if (placed.mesh == nullptr || !placed.mesh->tree) {
    error.actual = "a mesh without a moment tree";
    error.expected = "meshes prepared with their trees";
    error.hint = "Prepare the mesh with WithTree::kYes";
    return error;
  }
  if (!(placed.signed_permeability == 1.0 ||
        (placed.signed_permeability >= -1.0 && placed.signed_permeability < 0.0))) {
    error.actual = "factor " + format_shortest(placed.signed_permeability);
    error.expected = "1 for what displaces water, or minus a permeability between 0 and 1";
    error.cause = "the sign of a permeability";
    return error;
  }
  if (!placed.position_B.allFinite() || !(placed.orientation_B.norm() > 0.0) ||
      !std::isfinite(placed.orientation_B.norm())) {
    error.actual = "a mesh whose position or orientation is not finite";
    error.expected = "three numbers in metres and a quaternion other than zero";
    return error;
  }
  if (placed.mesh->is_open() && count > 1) {
    error.actual = "an open mesh beside other meshes";
    error.expected = "closed meshes, or one open mesh alone";
    error.cause = "a hull without a deck";
    error.hint = "Close the mesh";
    return error;
  }
  return std::nullopt;
}

std::optional<Error> fault_of(const Tank& tank) {
  Error error{.subject = "tank of a floating body", .actual = "", .expected = "", .cause = "", .hint = ""};
  if (tank.mesh == nullptr || !tank.mesh->tree || tank.mesh->is_open()) {
    error.actual = "a mesh that is open or without a moment tree";
    error.expected = "a closed mesh prepared with its tree";
    return error;
  }
  if (tank.piston_axis_B && !(std::abs(tank.piston_axis_B->squaredNorm() - 1.0) <= 1e-9)) {
    error.actual = "a piston axis " + format_vector(*tank.piston_axis_B);
    error.expected = "a unit vector";
    return error;
  }
  const bool fits = tank.liquid_volume >= 0.0 && tank.liquid_volume <= tank.mesh->volume;
  if (fits && tank.density >= 0.0 && std::isfinite(tank.density)) return std::nullopt;
  error.actual = format_shortest(tank.liquid_volume) + " m^3 of density " + format_shortest(tank.density);
  error.expected =
      "a volume from 0 to " + format_shortest(tank.mesh->volume) + " m^3 and a density of 0 or more";
  return error;
}

}  // namespace

Expected<FloatingBody> FloatingBody::make(std::span<const PlacedMesh> meshes, double mass,
                                          const Vec3& center_of_mass_B, std::span<const Tank> tanks) {
  if (!(mass > 0.0) || !std::isfinite(mass) || !center_of_mass_B.allFinite()) {
    return make_error(
        {.subject = "floating body",
         .actual = "mass " + format_shortest(mass) + ", centre of mass " + format_vector(center_of_mass_B),
         .expected = "a finite mass above 0 (kg) and a finite centre of mass (m)",
         .cause = "",
         .hint = ""});
  }
  FloatingBody body;
  body.mass_ = mass;
  body.center_of_mass_B_ = center_of_mass_B;
  bool displaces = false;
  for (const PlacedMesh& placed : meshes) {
    if (const std::optional<Error> fault = fault_of(placed, meshes.size())) return make_error(*fault);
    const HydrostaticMesh& mesh = *placed.mesh;
    SignedVolume volume{.placed = placed};
    volume.placed.orientation_B.normalize();
    volume.R_B = volume.placed.orientation_B.toRotationMatrix();
    volume.is_turned = volume.placed.orientation_B.vec().norm() > 0.0;
    if (!volume.is_turned) volume.R_B.setIdentity();
    const Vec3 center_B = volume.R_B * mesh.center_B + placed.position_B;
    if (body.volumes_.empty()) body.center_B_ = center_B;
    volume.offset_B = (volume.R_B * mesh.center_B - body.center_B_) + placed.position_B;
    const bool is_moved = volume.is_turned || !volume.offset_B.isZero(0.0) || !placed.position_B.isZero(0.0);
    const double distance = mesh.diagonal + volume.offset_B.norm() + placed.position_B.norm();
    if (is_moved) volume.plane_rounding = 4.0 * kEpsilon * mesh.area * distance;
    body.volumes_.push_back(volume);

    displaces = displaces || placed.signed_permeability > 0.0;
    body.is_open_ = body.is_open_ || mesh.is_open();
    body.volume_ += placed.signed_permeability * mesh.volume;
    body.volume_tolerance_ += std::abs(placed.signed_permeability) * mesh.volume_tolerance();
    body.reach_ = std::max(body.reach_, volume.offset_B.norm() + mesh.max_lever_arm(mesh.center_B));
  }
  if (!displaces) {
    return make_error({.subject = "floating body",
                       .actual = "no mesh of factor 1",
                       .expected = "at least one mesh that displaces water",
                       .cause = "",
                       .hint = ""});
  }
  body.total_mass_ = mass;
  for (const Tank& tank : tanks) {
    if (const std::optional<Error> fault = fault_of(tank)) return make_error(*fault);
    body.tanks_.push_back(tank);
    body.total_mass_ += tank.liquid_mass();
    body.liquid_tolerance_ += tank.density * tank.mesh->volume_tolerance();
    const double offset = (tank.mesh->center_B - body.center_B_).norm();
    body.reach_ = std::max(body.reach_, offset + tank.mesh->max_lever_arm(tank.mesh->center_B));
  }
  return body;
}

Expected<FloatingBody> with_mass(const FloatingBody& body, double mass, const Vec3& center_of_mass_B,
                                 std::span<const Tank> tanks) {
  std::vector<PlacedMesh> meshes;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) meshes.push_back(volume.placed);
  return FloatingBody::make(meshes, mass, center_of_mass_B, tanks);
}

std::optional<FloatingState> floating_state(const FloatingBody& body, const Pose& pose, const Water& water) {
  const WaterPlane plane = water_plane_in_body(pose, water, body.center_B());
  if (!std::isfinite(plane.h_c) || !plane.up_B.allFinite() || is_boundary_wet(body, plane)) {
    return std::nullopt;
  }
  const Vec3 to_mass = body.center_of_mass_B() - body.center_B();
  LiquidSum liquids = liquid_sum(body, plane.up_B, FreeSurfaces::kYes);
  const Vec3 moment_of_mass = mass_moment(body, liquids);
  const Vec3 total_center_B = total_center_of_mass_B(body, liquids);
  liquids.moment -= liquids.mass * to_mass;  // now about the centre of mass
  const auto part_at = [&](double depth) { return immersed_sum(body, lowered(plane, depth)); };
  const std::optional<Hydrostatics> hydrostatics =
      hydrostatics_in(water, part_at, body.center_B(), body.volume_tolerance(), pose.q_WB,
                      body.center_of_mass_B(), total_center_B, liquids);
  if (!hydrostatics) return std::nullopt;

  const DisplacedSum displaced = displaced_sum(body, plane, water);
  const DisplacedBounds bounds = displaced_bounds(body, plane, water);
  const Vec3& k = plane.up_B;
  const double weight = body.total_mass() * water.gravity;       // [N]
  const double specific_weight = water.density * water.gravity;  // [N/m^3]
  FloatingState state{.hydrostatics = *hydrostatics};
  state.energy =
      water.gravity * (k.dot(moment_of_mass) - plane.h_c * body.total_mass()) -
      specific_weight * (k.dot(displaced.moment) - plane.h_c * displaced.volume + displaced.depth_moment);
  state.force_W = (specific_weight * displaced.volume - weight) * water.up_W;
  const Vec3 about_mass = displaced.moment - displaced.volume * to_mass;
  const Vec3 couple = specific_weight * about_mass - water.gravity * liquids.moment;
  state.torque_W = pose.q_WB.normalized() * couple.cross(k);
  state.force_error_bound = specific_weight * bounds.volume + kEpsilon * weight;
  state.torque_error_bound =
      specific_weight * bounds.moment + water.gravity * liquid_moment_bound(body, body.center_of_mass_B());
  if (!std::isfinite(state.energy) || !state.torque_W.allFinite()) return std::nullopt;
  return state;
}

double lowest_along(const FloatingBody& body, const Vec3& up_B) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const FloatingBody::SignedVolume& volume : body.volumes()) {
    if (volume.placed.signed_permeability < 0.0) continue;
    const Vec3 up = volume.R_B.transpose() * up_B;
    lowest = std::min(lowest, up_B.dot(volume.offset_B) + lowest_vertex(*volume.placed.mesh->tree, up));
  }
  return lowest;
}

}  // namespace buoyancy
