#include "engine/subdivision_load.h"

#include <cmath>
#include <limits>

#include "hydrostatics/density_steps.h"
#include "hydrostatics/immersed_part.h"
#include "scene/body_mass.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The weight of a result in the mean of centres of buoyancy: its volume [m^3], or in layered water, where the
// centre is that of the displaced mass, its force along up [N].
double center_weight(const BuoyancyResult& result, const Water& water) {
  return water.layers.empty() ? result.volume : water.up_W.dot(result.force_W);
}

void add_scaled(const WaveBuoyancyResult& compartment, double factor, WaveBuoyancyResult& sum) {
  const BuoyancyResult& lost = compartment.result;
  BuoyancyResult& result = sum.result;
  const double size = std::abs(factor);
  result.force_W += factor * lost.force_W;
  result.torque_W += factor * lost.torque_W;
  result.volume += factor * lost.volume;
  result.force_error_bound += size * lost.force_error_bound;
  result.torque_error_bound += size * lost.torque_error_bound;
  sum.work_capped = sum.work_capped || compartment.work_capped;
  sum.sea_too_steep = sum.sea_too_steep || compartment.sea_too_steep;
  sum.patches += compartment.patches;
  sum.volume_error_bound += size * compartment.volume_error_bound;
}

void add_weight(const Tank& tank, const Water& water, const Mat3& R_WB, const Vec3& reference_B,
                BuoyancyResult& sum) {
  if (!(tank.liquid_volume > 0.0)) return;
  const TankLiquid liquid = tank_liquid(tank, R_WB.transpose() * water.up_W);
  const double specific_weight = tank.density * water.gravity;  // [N/m^3]
  const double weight = specific_weight * tank.liquid_volume;   // [N]
  const Vec3 lever_B = (tank.mesh->center_B - reference_B) + liquid.centroid;
  sum.force_W -= weight * water.up_W;
  sum.torque_W -= weight * (R_WB * lever_B).cross(water.up_W);
  // The rotation to W rounds the lever, and the product rounds the weight. A volume that is given as a share
  // of the tank's has the error of the tank's volume.
  const double lever = tank.mesh->max_lever_arm(reference_B);
  sum.force_error_bound += 4.0 * kEpsilon * weight + specific_weight * tank.mesh->rounding_bound();
  const double volume_error = liquid.volume_error + tank.mesh->rounding_bound();
  sum.torque_error_bound += specific_weight * volume_error * lever + 16.0 * kEpsilon * weight * lever;
}

bool is_finite(const BuoyancyResult& result) {
  return result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
         !std::isnan(result.force_error_bound) && !std::isnan(result.torque_error_bound);
}

// [m], of body and liquids, in B; nullopt if the scene does not define the mass. liquids: about B's origin.
std::optional<Vec3> total_center_of_mass(const Body& body, const Water& water, const LiquidSum& liquids) {
  if (!body.center_of_mass_B || !(liquids.mass > 0.0)) return body.center_of_mass_B;
  const Expected<RigidBodyMass> own = mass_of_body(body, water);
  if (!own) return std::nullopt;
  const Weights weights = weights_of(*own, liquids, Vec3::Zero());
  return Vec3(weights.moment / weights.mass);
}

double flooded_at(const Subdivision& subdivision, const BodyCondition* condition, std::size_t i) {
  return condition == nullptr ? subdivision.compartments[i].flooded : condition->flooded[i];
}

Tank tank_at(const Subdivision& subdivision, const BodyCondition* condition, std::size_t i) {
  const BodyTank& tank = subdivision.tanks[i];
  return with_liquid(tank, condition == nullptr ? tank.liquid_volume : condition->liquid_volumes[i]);
}

}  // namespace

double add_subdivision_load(const Body& body, const BodyCondition* condition, const WaterState& water,
                            const Pose& pose, WaveBuoyancyResult& sum) {
  BuoyancyResult& result = sum.result;
  if (result.status != BuoyancyStatus::kOk) return 0.0;
  const Subdivision& subdivision = *body.subdivision;
  Vec3 moment_W = center_weight(result, *water.at_rest) * result.center_of_buoyancy_W;
  double flooded_volume = 0.0;
  for (std::size_t i = 0; i < subdivision.compartments.size(); ++i) {
    const BodyCompartment& compartment = subdivision.compartments[i];
    const double flooded = flooded_at(subdivision, condition, i);
    if (flooded == 0.0) continue;
    const double factor = factor_of(compartment, flooded);
    const WaveBuoyancyResult lost =
        buoyancy_of(compartment.solver, *compartment.prepared_mesh, water, pose, body.reference_B);
    if (lost.result.status != BuoyancyStatus::kOk) {
      sum = {};
      result.status = lost.result.status;
      return 0.0;
    }
    add_scaled(lost, factor, sum);
    const double weight = center_weight(lost.result, *water.at_rest);
    moment_W += factor * Vec3(weight * lost.result.center_of_buoyancy_W);
    flooded_volume -= factor * lost.result.volume;
  }
  if (flooded_volume != 0.0) {
    const HydrostaticMesh& mesh = body.solver.mesh();
    const bool has_center = std::abs(result.volume) > mesh.volume_tolerance();
    const double weight = center_weight(result, *water.at_rest);
    result.center_of_buoyancy_W = has_center && weight != 0.0 ? Vec3(moment_W / weight) : Vec3::Zero();
  }
  if (!subdivision.tanks.empty()) {
    const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
    for (std::size_t i = 0; i < subdivision.tanks.size(); ++i) {
      add_weight(tank_at(subdivision, condition, i), *water.at_rest, R_WB, body.reference_B, result);
    }
  }
  if (!is_finite(result)) {
    sum = {};
    result.status = BuoyancyStatus::kOutOfRange;
    return 0.0;
  }
  return flooded_volume;
}

std::optional<Hydrostatics> subdivided_hydrostatics(const Body& body, const BodyCondition* condition,
                                                    const Water& water, const Pose& pose) {
  const Subdivision& subdivision = *body.subdivision;
  const HydrostaticMesh& hull = body.solver.mesh();
  const auto for_each_volume = [&](const auto& visit) {
    visit(hull, 1.0);
    for (std::size_t i = 0; i < subdivision.compartments.size(); ++i) {
      const BodyCompartment& compartment = subdivision.compartments[i];
      visit(compartment.prepared_mesh->mesh, factor_of(compartment, flooded_at(subdivision, condition, i)));
    }
  };
  double volume_tolerance = 0.0;
  for_each_volume([&](const HydrostaticMesh& mesh, double factor) {
    volume_tolerance += std::abs(factor) * mesh.volume_tolerance();
  });
  const auto part_at = [&](double depth) {
    ImmersedPart sum;
    for_each_volume([&](const HydrostaticMesh& mesh, double factor) {
      const WaterPlane plane = lowered(water_plane_in_body(pose, water, mesh.center_B), depth);
      add_scaled(immersed_part(mesh, plane), mesh.center_B - hull.center_B, factor, sum);
    });
    return sum;
  };
  LiquidSum liquids;  // about B's origin
  const Vec3 up_B = pose.q_WB.normalized().conjugate() * water.up_W;
  for (std::size_t i = 0; i < subdivision.tanks.size(); ++i) {
    const Tank tank = tank_at(subdivision, condition, i);
    add_liquid(tank, tank_liquid(tank, up_B), Vec3::Zero(), FreeSurfaces::kYes, liquids);
  }
  const std::optional<Vec3> center_B = total_center_of_mass(body, water, liquids);
  liquids.moment -= liquids.mass * body.reference_B;  // now about the reference point
  return hydrostatics_in(water, part_at, hull.center_B, volume_tolerance, pose.q_WB, body.reference_B,
                         center_B, liquids);
}

}  // namespace buoyancy
