#include "wave_loads/wave_buoyancy.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "wave_loads/wave_load.h"
#include "wave_loads/wave_surface_methods.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// [m], of positions: beyond it, their rounding alone is larger than waves.
constexpr double kFarthest = 1e15;

Water with_level(Water water, double level) {
  water.level = level;
  return water;
}

// Against the highest crest and the lowest trough: kDry and kSubmerged are certain.
Immersion immersion_in_waves(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  const Water& water = sea.prepared().sea().water();
  const double elevation = sea.max_elevation();
  if (quick_immersion(mesh, pose, with_level(water, water.level + elevation)) == Immersion::kDry) {
    return Immersion::kDry;
  }
  if (quick_immersion(mesh, pose, with_level(water, water.level - elevation)) == Immersion::kSubmerged) {
    return Immersion::kSubmerged;
  }
  return Immersion::kPiercing;
}

// [m], sum of a k^n now.
double amplitude_sum(const SeaAtTime& sea, std::size_t n) {
  return sea.snapshot().amplitude_factor() * sea.prepared().expansion().amplitude_sums[n];
}

// [m], bound on what the rounding of positions changes in heights over the surface.
double position_rounding(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  const double distance =
      pose.p_WB.lpNorm<1>() + mesh.center_B.lpNorm<1>() + std::abs(sea.prepared().sea().water().level);
  return 8.0 * kEpsilon * distance * (1.0 + amplitude_sum(sea, 1));
}

// Are all boundary edges of an open mesh above the surface? The height over the surface is linear along an
// edge but for the surface's curvature, which is at most the sum of a k^2.
bool boundary_is_dry(const HydrostaticMesh& mesh, const WaveMesh& wave_mesh, const SeaAtTime& sea,
                     const Pose& pose, const Mat3& R_WB) {
  const Sea& of_sea = sea.prepared().sea();
  const Water& water = of_sea.water();
  const double edge = wave_mesh.longest_boundary_edge;
  const double margin = amplitude_sum(sea, 2) * edge * edge / 8.0 + position_rounding(mesh, sea, pose);
  const double crest = sea.max_elevation();
  return std::none_of(mesh.boundary_vertices.begin(), mesh.boundary_vertices.end(), [&](std::int32_t i) {
    const Vec3 p_W = pose.p_WB + R_WB * (mesh.center_B + mesh.vertex(i));
    const double zeta = water.up_W.dot(p_W) - water.level;
    if (zeta > crest + margin) return false;
    const double eta = sea.snapshot().elevation(of_sea.axes().e1_W.dot(p_W), of_sea.axes().e2_W.dot(p_W));
    return zeta - eta <= margin;
  });
}

bool is_finite(const WaveBuoyancyResult& outcome) {
  const BuoyancyResult& result = outcome.result;
  return result.force_W.allFinite() && result.torque_W.allFinite() &&
         result.center_of_buoyancy_W.allFinite() && std::isfinite(result.volume) &&
         !std::isnan(result.force_error_bound) && !std::isnan(result.torque_error_bound) &&
         !std::isnan(outcome.volume_error_bound);
}

BuoyancyResult failed_result(BuoyancyStatus status, Immersion where) {
  BuoyancyResult result;
  result.status = status;
  result.immersion = where;
  return result;
}

WaveLoad load_of(const Solver& solver, const WaveMesh& wave_mesh, const SeaAtTime& sea, const Pose& pose,
                 const Vec3& reference_B) {
  switch (solver.method()) {
    case Method::kFastSurface:
      return fast_surface_in_waves(solver.mesh(), sea.snapshot(), pose, reference_B);
    case Method::kExactSurface:
      return exact_surface_in_waves(solver.mesh(), sea.snapshot(), pose, reference_B);
    default:
      assert(solver.method() == Method::kHierarchical);
      return wave_load({&solver.mesh(), &wave_mesh.patches, solver.tolerance()}, sea.prepared().expansion(),
                       sea.snapshot(), pose, reference_B);
  }
}

// Bound on the force of waves over rho g V on a body that is wet everywhere (docs/wave_mathematics.md, "Deep,
// calm, high"). highest, lowest: [m], heights over the level of the body's bounds.
double max_wave_force_per_volume(const SeaAtTime& sea, double highest, double lowest) {
  const PreparedSea& prepared = sea.prepared();
  const double slope = amplitude_sum(sea, 1);
  if (prepared.sea().pressure() == WavePressure::kHydrostatic) return slope;
  const double h = prepared.sea().depth();
  const double elevation = sea.max_elevation();
  const double depth = -(highest + elevation);  // under the lowest trough
  if (!(depth > 0.0)) return std::numeric_limits<double>::infinity();
  double least_stretch = 1.0;  // bounds on q
  double largest_stretch = 1.0;
  double shear = slope;  // bound on w q^2 |grad eta|
  if (!std::isinf(h)) {
    if (!(elevation < h) || lowest < -h) return std::numeric_limits<double>::infinity();
    least_stretch = h / (h + elevation);
    largest_stretch = h / (h - elevation);
    shear = (1.0 + highest / h) * largest_stretch * largest_stretch * slope;
  }
  // The norm of the derivative of x -> (X, z'), a shear with a stretch.
  const double trace = 1.0 + largest_stretch * largest_stretch + shear * shear;
  const double root = std::sqrt(std::max(trace * trace - 4.0 * largest_stretch * largest_stretch, 0.0));
  const double norm = std::sqrt(0.5 * (trace + root));
  return sea.snapshot().amplitude_factor() * prepared.max_gradient(-least_stretch * depth) *
         std::max(norm, 1.0);
}

}  // namespace

WaveMesh make_wave_mesh(const HydrostaticMesh& mesh) {
  WaveMesh wave_mesh{build_patch_tree(mesh.surface)};
  if (!mesh.is_open()) return wave_mesh;
  std::vector<bool> on_boundary(mesh.surface.x.size());
  for (const std::int32_t i : mesh.boundary_vertices) on_boundary[static_cast<std::size_t>(i)] = true;
  for (const auto& triangle : mesh.surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t from = triangle[i];
      const std::int32_t to = triangle[(i + 1) % 3];
      if (!on_boundary[static_cast<std::size_t>(from)] || !on_boundary[static_cast<std::size_t>(to)])
        continue;
      wave_mesh.longest_boundary_edge =
          std::max(wave_mesh.longest_boundary_edge, (mesh.vertex(to) - mesh.vertex(from)).norm());
    }
  }
  return wave_mesh;
}

WaveBuoyancyResult buoyancy_in_waves(const Solver& solver, const WaveMesh& wave_mesh, const SeaAtTime& sea,
                                     const Pose& pose, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  const Water& water = sea.prepared().sea().water();
  WaveBuoyancyResult outcome;
  BuoyancyResult& result = outcome.result;
  result.immersion = immersion_in_waves(mesh, sea, pose);
  if (result.immersion == Immersion::kDry) return outcome;
  if (!(pose.p_WB.lpNorm<1>() + mesh.center_B.lpNorm<1>() <= kFarthest)) {
    result = failed_result(BuoyancyStatus::kOutOfRange, result.immersion);
    return outcome;
  }
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  if (mesh.is_open() && !boundary_is_dry(mesh, wave_mesh, sea, pose, R_WB)) {
    result = failed_result(BuoyancyStatus::kOpenEdgeWet, result.immersion);
    return outcome;
  }
  const WaveLoad load = load_of(solver, wave_mesh, sea, pose, reference_B);
  outcome.work_capped = load.capped;
  outcome.sea_too_steep = load.too_steep;
  outcome.patches = load.patches;
  const double specific_weight = water.density * water.gravity;  // [N/m^3]
  const double rounding = mesh.rounding_bound();
  const double force_bound = load.force_bound + rounding;
  result.force_W = specific_weight * (R_WB * load.force);
  result.torque_W = specific_weight * (R_WB * load.torque);
  result.force_error_bound = specific_weight * force_bound;
  result.torque_error_bound =
      specific_weight * (load.torque_bound + rounding * mesh.max_lever_arm(reference_B));
  result.volume = load.volume;
  outcome.volume_error_bound = load.volume_bound + rounding;
  const double min_volume =
      solver.method() == Method::kHierarchical ? 2.0 * force_bound : mesh.volume_tolerance();
  if (load.volume > min_volume) {
    result.center_of_buoyancy_W = R_WB * (mesh.center_B + load.moment / load.volume);
  }
  if (!is_finite(outcome)) {
    outcome = {};
    result = failed_result(BuoyancyStatus::kOutOfRange, Immersion::kPiercing);
  }
  return outcome;
}

bool try_buoyancy_in_waves_from_bounds(const Solver& solver, const FullySubmerged& submerged,
                                       const SeaAtTime& sea, const Pose& pose, const Vec3& reference_B,
                                       WaveBuoyancyResult& outcome) {
  const HydrostaticMesh& mesh = solver.mesh();
  const Immersion where = immersion_in_waves(mesh, sea, pose);
  if (where == Immersion::kPiercing) return false;
  if (where == Immersion::kDry) {
    outcome = {};
    outcome.result.immersion = where;
    return true;
  }
  if (solver.method() != Method::kHierarchical) return false;
  const Water& water = sea.prepared().sea().water();
  // The box of the mesh lies between these heights over the level.
  const RoughWaterPlane plane = rough_water_plane_in_body(pose, water, mesh.center_B, mesh.diagonal);
  const Vec3 up_B = plane.up_B.vec3();
  const double middle = up_B.dot(0.5 * (mesh.box_min + mesh.box_max)) - plane.h_c;
  const double reach = up_B.cwiseAbs().dot(0.5 * (mesh.box_max - mesh.box_min)) + plane.error;
  const double per_volume = max_wave_force_per_volume(sea, (middle + reach) / plane.norm_squared,
                                                      (middle - reach) / plane.norm_squared);
  if (!(per_volume <= solver.tolerance())) return false;
  WaveBuoyancyResult calm;
  BuoyancyResult& still = calm.result;
  if (!try_buoyancy_from_bounds(solver, submerged, pose, water, still) ||
      still.status != BuoyancyStatus::kOk) {
    return false;
  }
  calm.volume_error_bound = mesh.rounding_bound();
  const double wave_force = per_volume * submerged.buoyant_force;
  still.force_error_bound += wave_force;
  still.torque_error_bound += wave_force * mesh.max_lever_arm(reference_B);
  if (!is_finite(calm)) return false;
  outcome = calm;
  return true;
}

}  // namespace buoyancy
