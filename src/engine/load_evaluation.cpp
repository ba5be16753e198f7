#include "engine/load_evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/hydrostatics.h"
#include "messages/conversions.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// [m^3], bound on the error of the submerged volume.
double volume_error_bound(const Body& body, const WaterState& water, const BodyOutcome& outcome) {
  const HydrostaticMesh& mesh = body.solver.mesh();
  const bool constant =
      outcome.result.immersion == Immersion::kSubmerged && body.solver.method() == Method::kHierarchical;
  if (constant) return mesh.rounding_bound();
  if (water.waves != nullptr) return outcome.in_waves.volume_error_bound;
  // At rest the force along up is rho g V, also where a method only approximates V.
  const double specific_weight = water.at_rest->density * water.at_rest->gravity;
  return specific_weight > 0.0 ? outcome.result.force_error_bound / specific_weight : mesh.volume;
}

// A factor within [0, 1] whose error cannot exceed the distance to the farther end.
ImmersionFactor factor_within_unit(double value, double error) {
  const double inside = std::clamp(value, 0.0, 1.0);
  return {inside, std::min(error, std::max(inside, 1.0 - inside))};
}

ImmersionFactor immersion_factor(ImmersionScaling scaling, const Body& body, const WaterState& water,
                                 const Pose& pose, const BodyOutcome& outcome) {
  if (outcome.result.immersion == Immersion::kDry) return {0.0, 0.0};
  const HydrostaticMesh& mesh = body.solver.mesh();
  const double volume = outcome.result.volume + outcome.flooded_volume;  // of the hull
  const bool wet = volume > mesh.volume_tolerance();
  switch (scaling) {
    case ImmersionScaling::kVolume:
      return factor_within_unit(wet ? volume / mesh.volume : 0.0,
                                volume_error_bound(body, water, outcome) / mesh.volume + 4.0 * kEpsilon);
    case ImmersionScaling::kWettedArea: {
      const WettedArea area = wetted_area(mesh, pose, *water.at_rest);
      return factor_within_unit(area.value / mesh.area, area.error / mesh.area + 4.0 * kEpsilon);
    }
    case ImmersionScaling::kNone: {
      // The factor jumps from 0 to 1 where a volume begins to count. Rounding errors of the volume decide on
      // which side a body is, but the larger error of an approximation leaves it undecided.
      const double error = volume_error_bound(body, water, outcome);
      const bool undecided = error > 4.0 * mesh.volume_tolerance() && std::abs(volume) <= error;
      return {wet ? 1.0 : 0.0, undecided ? 1.0 : 0.0};
    }
  }
  return {0.0, 0.0};
}

void set_matrix(const Mat6& matrix, std::array<std::array<double, 6>, 6>& fields) {
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      fields[row][column] = matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    }
  }
}

std::array<double, 3> force_of(const Vec6& wrench) {
  return {wrench[0], wrench[1], wrench[2]};
}
std::array<double, 3> torque_of(const Vec6& wrench) {
  return {wrench[3], wrench[4], wrench[5]};
}

void add(const Vec6& wrench_W, BodyWrench& wrench) {
  for (std::size_t i = 0; i < 3; ++i) {
    wrench.force[i] += wrench_W[static_cast<Eigen::Index>(i)];
    wrench.torque[i] += wrench_W[static_cast<Eigen::Index>(i + 3)];
  }
}

BodyLoads buoyancy_alone(const BodyWrench& buoyancy) {
  BodyLoads loads;
  loads.body_id = buoyancy.body_id;
  loads.status = buoyancy.status;
  loads.buoyancy_force = buoyancy.force;
  loads.buoyancy_torque = buoyancy.torque;
  return loads;
}

bool is_finite(const BodyWrench& wrench) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(wrench.force, finite) && std::ranges::all_of(wrench.torque, finite) &&
         !std::isnan(wrench.force_error_bound) && !std::isnan(wrench.torque_error_bound);
}

}  // namespace

BodyTwist twist_of(const BodyState& state) {
  return {to_vec3(state.linear_velocity), to_vec3(state.angular_velocity)};
}

FlowAtBody flow_at_body(const WaterState& water, const Current& current, const Vec3& p_W) {
  FlowAtBody motion;
  motion.velocity_W = current.at(*water.at_rest, p_W);
  if (water.waves == nullptr) return motion;
  const WaterAtPoint point = water.waves->at(p_W);
  motion.velocity_W += point.velocity_W;
  motion.acceleration_W = point.acceleration_W;
  const Sea& sea = water.waves->sea();
  const SeaExpansion& expansion = water.waves->sea().expansion();
  const double rounding = 8.0 * kEpsilon * (p_W.lpNorm<1>() + std::abs(sea.water().level));  // of positions
  if (!sea.surfaces().empty()) {
    // The difference of two surfaces over the time between them; of one surface there is no velocity.
    const double between = water.waves->time_between_surfaces();
    if (between == 0.0) return motion;
    const auto [elevation, slope, curvature] = expansion.amplitude_sums;
    motion.velocity_error = 2.0 * (0x1p-40 * elevation + slope * rounding) / between;
    return motion;
  }
  // The acceleration of a component is at most g a k, and its velocity at most g a k over its frequency. The
  // phases are exact to 1e-15 of a turn, and the position is rounded.
  const double steepness = expansion.amplitude_sums[1];
  const double phase = 1e-14 + kEpsilon * static_cast<double>(sea.components().size()) +
                       rounding * expansion.k_max * (1.0 + steepness);
  motion.acceleration_error = sea.water().gravity * steepness * phase;
  motion.velocity_error = motion.acceleration_error / std::ranges::min(sea.prepared().angular_frequency);
  return motion;
}

HydrodynamicState hydrodynamic_state(const Body& body, const WaterState& water, const Current& current,
                                     const Pose& pose, const BodyTwist& twist, const BodyOutcome& outcome) {
  HydrodynamicState state;
  state.motion = {pose.q_WB.normalized().toRotationMatrix(), twist.velocity_W, twist.angular_velocity_W};
  const auto* const drag = body.hydrodynamics->drag_placement();
  const auto* const added = body.hydrodynamics->added_mass_placement();
  const auto water_at = [&](const Vec3& center_B) {
    return flow_at_body(water, current, pose.p_WB + state.motion.R_WB * center_B);
  };
  if (drag != nullptr) {
    state.at_drag.water = water_at(drag->center_B);
    state.at_drag.immersion = immersion_factor(drag->immersion, body, water, pose, outcome);
  }
  if (added != nullptr) {
    const bool same_place = drag != nullptr && drag->center_B == added->center_B;
    const bool same_immersion = drag != nullptr && drag->immersion == added->immersion;
    state.at_added_mass.water = same_place ? state.at_drag.water : water_at(added->center_B);
    state.at_added_mass.immersion = same_immersion
                                        ? state.at_drag.immersion
                                        : immersion_factor(added->immersion, body, water, pose, outcome);
  }
  return state;
}

void add_hydrodynamic_load(const HydrodynamicLoad& load, BodyWrench& wrench) {
  add(load.drag_W, wrench);
  add(load.added_mass_W, wrench);
  wrench.force_error_bound += load.force_error_bound;
  wrench.torque_error_bound += load.torque_error_bound;
  if (!is_finite(wrench)) wrench = {.body_id = wrench.body_id, .status = BodyStatus::kOutOfRange};
}

BodyLoads to_loads(const Body& body, const BodyWrench& buoyancy, const FlowAtBody& at_origin) {
  BodyLoads loads = buoyancy_alone(buoyancy);
  const HydrostaticMesh& mesh = body.solver.mesh();
  if (!mesh.is_open()) loads.immersion = std::clamp(buoyancy.submerged_volume / mesh.volume, 0.0, 1.0);
  loads.water_velocity = to_array(at_origin.velocity_W);
  return loads;
}

BodyLoads to_loads(const Body& body, const BodyWrench& buoyancy, const HydrodynamicState& state,
                   const HydrodynamicLoad& load) {
  BodyLoads loads = buoyancy_alone(buoyancy);
  const Surroundings& surroundings =
      body.hydrodynamics->coefficients().drag ? state.at_drag : state.at_added_mass;
  loads.immersion = surroundings.immersion.value;
  loads.water_velocity = to_array(surroundings.water.velocity_W);
  loads.drag_force = force_of(load.drag_W);
  loads.drag_torque = torque_of(load.drag_W);
  loads.added_mass_force = force_of(load.added_mass_W);
  loads.added_mass_torque = torque_of(load.added_mass_W);
  const HydrodynamicMatrices matrices = body.hydrodynamics->matrices(state);
  set_matrix(matrices.added_mass_W, loads.added_mass);
  set_matrix(matrices.damping_W, loads.damping);
  return loads;
}

void add_loads(const Body& body, const WaterState& water, const Current& current, const Pose& pose,
               const BodyTwist& twist, const BodyOutcome& buoyancy, BodyWrench& wrench, BodyLoads* loads) {
  if (body.hydrodynamics == nullptr) {
    if (loads != nullptr) *loads = to_loads(body, wrench, flow_at_body(water, current, pose.p_WB));
    return;
  }
  // A dry body has neither drag nor added mass.
  if (buoyancy.result.immersion == Immersion::kDry && loads == nullptr) return;
  const HydrodynamicState state = hydrodynamic_state(body, water, current, pose, twist, buoyancy);
  const HydrodynamicLoad load = body.hydrodynamics->load(state);
  if (loads != nullptr) *loads = to_loads(body, wrench, state, load);
  add_hydrodynamic_load(load, wrench);
}

}  // namespace buoyancy
