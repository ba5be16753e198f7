#include "engine/loads_comparison.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

using Matrix = std::array<std::array<double, 6>, 6>;

constexpr double kReceivedWaveVelocity = 10.0;  // [m/s], scale of waves that come in messages

// Returns the error of a submerged volume over the whole one: at rest, and where the pressure is proportional
// to the depth, that of the force rho g V; else it is unknown, and at most 1.
double volume_fraction_error(const WrenchLimits& limits, const Body& body, const Scene& scene) {
  const bool other_pressure = scene.receives_sea() || (scene.sea() != nullptr &&
                                                       scene.sea()->pressure() != WavePressure::kHydrostatic);
  const double weight = scene.water().density * scene.water().gravity * body.solver.mesh().volume;
  if (other_pressure || !(weight > 0.0)) return 1.0;
  return std::min(1.0, limits.force / weight + kRounding);
}

// Returns the error of a scaling's factor over the factor itself.
double relative_error(ImmersionScaling scaling, const WrenchLimits& limits, const Body& body,
                      const Scene& scene) {
  const double fraction = limits.submerged_volume / body.solver.mesh().volume;
  if (scaling == ImmersionScaling::kNone || !(fraction > 0.0)) return 0.0;
  if (scaling == ImmersionScaling::kWettedArea) return kRounding / fraction;
  return volume_fraction_error(limits, body, scene) / fraction;
}

// Returns the sum [m/s] of the speeds of which the water's velocity consists.
double water_velocity_scale(const Scene& scene) {
  double scale = scene.current().max_speed();
  if (scene.receives_sea()) return scale + kReceivedWaveVelocity;
  if (scene.sea() == nullptr) return scale;
  for (const WaveComponent& wave : scene.sea()->components())
    scale += wave.amplitude * wave.angular_frequency;
  return scale;
}

// Returns the largest entry of a 3 x 3 block in both matrices.
double largest(const Matrix& a, const Matrix& b, std::size_t first_row, std::size_t first_column) {
  double value = 0.0;
  for (std::size_t row = first_row; row < first_row + 3; ++row) {
    for (std::size_t column = first_column; column < first_column + 3; ++column) {
      value = std::max({value, std::abs(a[row][column]), std::abs(b[row][column])});
    }
  }
  return value;
}

// relative: the allowed difference over the largest term of an entry. lever: [m], by which the blocks of
// forces contribute to those of torques.
void add_matrix(std::string_view field, const Matrix& now, const Matrix& baseline, double relative,
                double lever, FieldDifferences& fields) {
  const double force_v = largest(now, baseline, 0, 0);
  const double force_w = largest(now, baseline, 0, 3) + lever * force_v;
  const double torque_v = largest(now, baseline, 3, 0) + lever * force_v;
  const double torque_w = largest(now, baseline, 3, 3) + lever * (force_w + torque_v);
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      const double of_force = column < 3 ? force_v : force_w;
      const double of_torque = column < 3 ? torque_v : torque_w;
      fields.add(field, now[row][column], baseline[row][column], relative * (row < 3 ? of_force : of_torque));
    }
  }
}

}  // namespace

WrenchLimits limits_of(const BodyWrench& now, const BodyWrench& baseline) {
  return {.force = now.force_error_bound + baseline.force_error_bound,
          .torque = now.torque_error_bound + baseline.torque_error_bound,
          .submerged_volume = std::max(now.submerged_volume, baseline.submerged_volume)};
}

void compare_loads(const BodyLoads& now, const BodyLoads& baseline, const WrenchLimits& limits,
                   const Body& body, const Scene& scene, MessageDifferences& differences) {
  FieldDifferences fields;
  fields.add("immersion", now.immersion, baseline.immersion, volume_fraction_error(limits, body, scene));
  fields.add("buoyancy_force", now.buoyancy_force, baseline.buoyancy_force, limits.force);
  fields.add("buoyancy_torque", now.buoyancy_torque, baseline.buoyancy_torque, limits.torque);
  fields.add("drag_force", now.drag_force, baseline.drag_force, limits.force);
  fields.add("drag_torque", now.drag_torque, baseline.drag_torque, limits.torque);
  fields.add("added_mass_force", now.added_mass_force, baseline.added_mass_force, limits.force);
  fields.add("added_mass_torque", now.added_mass_torque, baseline.added_mass_torque, limits.torque);
  fields.add("water_velocity", now.water_velocity, baseline.water_velocity,
             kRounding * water_velocity_scale(scene));
  double of_drag = 0.0;
  double of_added_mass = 0.0;
  if (body.hydrodynamics != nullptr) {
    const auto& [drag, added_mass] = body.hydrodynamics->coefficients();
    if (drag) of_drag = relative_error(drag->immersion, limits, body, scene);
    if (added_mass) of_added_mass = relative_error(added_mass->immersion, limits, body, scene);
  }
  const HydrostaticMesh& mesh = body.solver.mesh();
  const double lever = mesh.max_lever_arm(body.reference_B) + mesh.diagonal;
  add_matrix("added_mass", now.added_mass, baseline.added_mass, of_added_mass + kRounding, lever, fields);
  add_matrix("damping", now.damping, baseline.damping, std::max(of_drag, of_added_mass) + kRounding, lever,
             fields);
  fields.add_to(differences);
}

}  // namespace buoyancy
