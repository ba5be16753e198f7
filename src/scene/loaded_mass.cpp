#include "scene/loaded_mass.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "hydrostatics/displacement_moments.h"
#include "hydrostatics/immersed_part.h"
#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

Mat3 inertia_from(const Mat3& second_moments) {
  return second_moments.trace() * Mat3::Identity() - second_moments;
}

// [m^5], of the liquid about its own centroid, at a density of 1 kg/m^3.
Mat3 frozen_inertia(const BodyTank& tank, const Tank& filled, const TankLiquid& liquid) {
  if (!liquid.has_free_surface) return tank.prepared_mesh->mass_properties.inertia_B;
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

// [kg m^2], that a mass at this distance from a point adds to the inertia about it.
Mat3 inertia_of_point(double mass, const Vec3& distance) {
  return inertia_from(mass * distance * distance.transpose());
}

}  // namespace

BodyMass mass_with_liquids(const Body& body, const BodyMass& own, const BodyCondition* condition,
                           const Vec3& up_B) {
  const std::vector<Tank> tanks = tanks_of(body, condition);
  LiquidSum liquids;  // about the body's own centre of mass
  std::vector<TankLiquid> found;
  for (const Tank& tank : tanks) {
    found.push_back(tank_liquid(tank, up_B));
    add_liquid(tank, found.back(), own.center_of_mass_B, liquids);
  }
  if (!(liquids.mass > 0.0)) return own;
  BodyMass sum;
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

Mat6 stiffness_of_weights(const BodyMass& own, std::span<const Tank> tanks, const Vec3& center_B,
                          const Eigen::Quaterniond& q_WB, const Water& water) {
  if (tanks.empty()) return Mat6::Zero();
  const Mat3 R_WB = q_WB.normalized().toRotationMatrix();
  const Vec3 up_B = R_WB.transpose() * water.up_W;
  LiquidSum liquids;
  for (const Tank& tank : tanks) {
    const TankLiquid liquid = tank_liquid(tank, up_B);
    add_liquid(tank, liquid, center_B, liquids);
    add_free_surface(tank, liquid, liquids);
  }
  DisplacementMoments<double> weights;
  weights.volume = own.mass + liquids.mass;
  weights.moment = own.mass * (own.center_of_mass_B - center_B) + liquids.moment;
  weights.waterplane_second_moments = liquids.free_surface;
  return -water.gravity * stiffness(weights.rotated(R_WB), water.up_W);
}

}  // namespace buoyancy
