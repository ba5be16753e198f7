#include "scene/body_mass.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/format.h"
#include "hydrostatics/displacement_moments.h"
#include "hydrostatics/immersed_part.h"
#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

double given_density(const DynamicsSpec& spec, const Water& water) {
  return spec.density.value_or(0.5 * water.density);
}

Mat3 inertia_from(const Mat3& second_moments) {
  return second_moments.trace() * Mat3::Identity() - second_moments;
}

// [m^5], of the liquid about its own centroid, at a density of 1 kg/m^3.
Mat3 frozen_inertia(const BodyTank& tank, const Tank& filled, const TankLiquid& liquid) {
  if (filled.liquid_volume >= tank.capacity()) return tank.prepared_mesh->mass_properties.inertia_B;
  constexpr int kPanels = 16;
  const double offset = std::sqrt(0.6);  // Gauss' rule of three points
  const std::array<std::pair<double, double>, 3> rule{
      {{-offset, 5.0 / 18.0}, {0.0, 8.0 / 18.0}, {offset, 5.0 / 18.0}}};
  const HydrostaticMesh& mesh = *filled.mesh;
  const Vec3& up_B = liquid.surface.up_B;
  const double bottom =
      0.5 * (up_B.dot(mesh.box_min + mesh.box_max) - up_B.cwiseAbs().dot(mesh.box_max - mesh.box_min));
  const double panel = (liquid.surface.h_c - bottom) / kPanels;  // [m]
  double volume = 0.0;
  Mat3 second_moments = Mat3::Zero();
  for (int i = 0; i < kPanels; ++i) {
    for (const auto& [position, weight] : rule) {
      const double level = bottom + (i + 0.5 + 0.5 * position) * panel;
      const ImmersedPart part = immersed_part(mesh, {.up_B = up_B, .h_c = level});
      const DisplacementMoments<double> moments = part.moments.moved(liquid.centroid - part.point);
      volume += weight * panel * moments.waterplane_area;
      second_moments += weight * panel * moments.waterplane_second_moments;
    }
  }
  if (!(volume > 0.0)) return Mat3::Zero();  // a film of liquid
  return inertia_from(second_moments * (filled.liquid_volume / volume));
}

// Returns the inertia [kg m^2] of a point mass at this distance.
Mat3 inertia_of_point(double mass, const Vec3& distance) {
  return inertia_from(mass * distance * distance.transpose());
}

}  // namespace

std::optional<double> known_mass(const Body& body, const Water& water) {
  if (body.dynamics.mass) return body.dynamics.mass;
  if (body.prepared_mesh->mesh.is_open()) return std::nullopt;
  return given_density(body.dynamics, water) * body.prepared_mesh->mass_properties.volume;
}

std::optional<double> known_density(const Body& body, const Water& water) {
  if (!body.dynamics.mass || body.dynamics.density) return given_density(body.dynamics, water);
  if (body.prepared_mesh->mesh.is_open()) return std::nullopt;
  return *body.dynamics.mass / body.prepared_mesh->mass_properties.volume;
}

std::optional<Vec3> given_center_of_mass(const DynamicsSpec& dynamics, const PreparedMesh& prepared) {
  if (dynamics.center_of_mass_B) return dynamics.center_of_mass_B;
  if (prepared.mesh.is_open() || !(dynamics.mass || dynamics.density)) return std::nullopt;
  return prepared.mass_properties.centroid_B;
}

Expected<RigidBodyMass> mass_of_body(const Body& body, const Water& water) {
  const DynamicsSpec& spec = body.dynamics;
  const MassProperties& enclosed = body.prepared_mesh->mass_properties;
  if (body.prepared_mesh->mesh.is_open()) {
    std::string missing;
    for (const auto& [key, given] : {std::pair{"mass", spec.mass.has_value()},
                                     {"center_of_mass", spec.center_of_mass_B.has_value()},
                                     {"inertia", spec.inertia_B.has_value()}}) {
      if (!given) missing += (missing.empty() ? "" : ", ") + std::string(key);
    }
    if (!missing.empty()) {
      return make_error({"body " + std::to_string(body.id) + " (" + body.name + ")",
                         "an open mesh without " + missing,
                         "mass, center_of_mass and inertia in [body.client]",
                         "a simulation needs them, and an open mesh encloses no volume to derive them from",
                         "Set what is missing, or close the mesh"});
    }
  }
  RigidBodyMass result;
  result.mass = *known_mass(body, water);
  result.center_of_mass_B = spec.center_of_mass_B.value_or(enclosed.centroid_B);
  result.inertia_B =
      spec.inertia_B ? *spec.inertia_B : Mat3(enclosed.inertia_B * (result.mass / enclosed.volume));
  if (!(result.mass > 0.0) || !std::isfinite(result.mass) || !result.inertia_B.allFinite()) {
    return make_error({"body " + std::to_string(body.id) + " (" + body.name + ")",
                       "mass = " + format_number(result.mass, 6) + " kg",
                       "a mass above 0, and with its inertia in double's range",
                       "a density of " + format_number(given_density(spec, water), 6) +
                           " kg/m^3 times an enclosed volume of " + format_number(enclosed.volume, 6) +
                           " m^3",
                       "Set mass or density in [body.client]"});
  }
  return result;
}

Weights weights_of(const RigidBodyMass& own, const LiquidSum& liquids, const Vec3& about_B) {
  return {own.mass + liquids.mass, own.mass * (own.center_of_mass_B - about_B) + liquids.moment};
}

RigidBodyMass mass_with_liquids(const Body& body, const RigidBodyMass& own, const BodyCondition* condition,
                                const Vec3& up_B) {
  const std::vector<Tank> tanks = tanks_of(body, condition);
  LiquidSum liquids;  // about the body's own centre of mass
  std::vector<TankLiquid> found;
  for (const Tank& tank : tanks) {
    found.push_back(tank_liquid(tank, up_B));
    add_liquid(tank, found.back(), own.center_of_mass_B, FreeSurfaces::kNo, liquids);
  }
  if (!(liquids.mass > 0.0)) return own;
  RigidBodyMass sum;
  sum.mass = own.mass + liquids.mass;
  const Vec3 moved = liquids.moment / sum.mass;
  sum.center_of_mass_B = own.center_of_mass_B + moved;
  sum.inertia_B = own.inertia_B + inertia_of_point(own.mass, moved);
  for (std::size_t i = 0; i < tanks.size(); ++i) {
    const Tank& tank = tanks[i];
    if (!(tank.liquid_volume > 0.0)) continue;
    const Vec3 distance = (tank.mesh->center_B - sum.center_of_mass_B) + found[i].centroid;
    sum.inertia_B += tank.density * frozen_inertia(body.subdivision->tanks[i], tank, found[i]) +
                     inertia_of_point(tank.liquid_mass(), distance);
  }
  return sum;
}

Mat6 stiffness_of_weights(const RigidBodyMass& own, std::span<const Tank> tanks, const Vec3& center_B,
                          const Eigen::Quaterniond& q_WB, const Water& water) {
  if (tanks.empty()) return Mat6::Zero();
  const Mat3 R_WB = q_WB.normalized().toRotationMatrix();
  const Vec3 up_B = R_WB.transpose() * water.up_W;
  const LiquidSum liquids = liquid_sum(tanks, up_B, center_B, FreeSurfaces::kYes);
  const Weights weights = weights_of(own, liquids, center_B);
  DisplacementMoments<double> moments;
  moments.volume = weights.mass;
  moments.moment = weights.moment;
  moments.waterplane_second_moments = liquids.free_surface;
  return -water.gravity * stiffness(moments.rotated(R_WB), water.up_W);
}

}  // namespace buoyancy
