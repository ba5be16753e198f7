#include "wave_loads/wave_buoyancy.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "hydrostatics/lowest_vertex.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_surface_methods.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// [m], of positions: beyond it, their rounding alone is larger than waves.
constexpr double kFarthest = 1e15;

// Without layers, which decide nothing about the surface.
Water with_level(const Water& water, double level) {
  return {.up_W = water.up_W, .level = level, .density = water.density, .gravity = water.gravity};
}

// Returns whether there is no surface above or below a part of the mesh's box.
bool leaves_grid(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  return sea.surface().count > 0 && !sea.surface().holds(footprint_of(mesh, pose, sea.sea().axes()));
}

// Against the highest crest and the lowest trough: kDry and kSubmerged are certain.
Immersion immersion_in_waves(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  const Water& water = sea.sea().water();
  double crest = sea.max_elevation();
  double trough = -crest;
  if (sea.surface().count > 0) {
    const ElevationBounds near = sea.surface().bounds_over(footprint_of(mesh, pose, sea.sea().axes()));
    crest = static_cast<double>(near.high);
    trough = static_cast<double>(near.low);
  }
  if (quick_immersion(mesh, pose, with_level(water, water.level + crest)) == Immersion::kDry) {
    return Immersion::kDry;
  }
  if (quick_immersion(mesh, pose, with_level(water, water.level + trough)) == Immersion::kSubmerged) {
    return Immersion::kSubmerged;
  }
  return Immersion::kPiercing;
}

// Where the box reaches below the bed, the lowest vertex decides if it is known.
bool reaches_below_bed(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  const Sea& of_sea = sea.sea();
  if (std::isinf(of_sea.depth())) return false;
  const Vec3& up_W = of_sea.water().up_W;
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 up_B = R_WB.transpose() * up_W;
  const double over_bed = up_W.dot(pose.p_WB + R_WB * mesh.center_B) - of_sea.water().level + of_sea.depth();
  const Vec3 lowest_corner = (up_B.array() > 0.0).select(mesh.box_min, mesh.box_max);
  if (!(over_bed + up_B.dot(lowest_corner) < 0.0)) return false;
  return !mesh.tree || over_bed + lowest_vertex(*mesh.tree, up_B) < 0.0;
}

// [m], sum of a k^n now.
double amplitude_sum(const SeaAtTime& sea, std::size_t n) {
  return sea.amplitude_factor() * sea.sea().expansion().amplitude_sums[n];
}

// [m], bound on what the rounding of positions changes in heights over the surface.
double position_rounding(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose) {
  const double distance =
      pose.p_WB.lpNorm<1>() + mesh.center_B.lpNorm<1>() + std::abs(sea.sea().water().level);
  return 8.0 * kEpsilon * distance * (1.0 + amplitude_sum(sea, 1));
}

// Whether the boundary of an open mesh is above the surface. Along an edge the height over the surface is
// linear but for the curvature of the surface, which is at most the sum of a k^2; where that leaves it open,
// halves of the edge decide.
class Boundary {
 public:
  Boundary(const HydrostaticMesh& mesh, const SeaAtTime& sea, const Pose& pose, const Mat3& R_WB)
      : mesh_(mesh),
        sea_(sea),
        p_WC_(pose.p_WB + R_WB * mesh.center_B),
        R_WB_(R_WB),
        curvature_(amplitude_sum(sea, 2)),
        rounding_(position_rounding(mesh, sea, pose)) {}

  bool is_dry(const std::array<std::int32_t, 2>& edge) const {
    return is_dry(end_at(mesh_.vertex(edge[0])), end_at(mesh_.vertex(edge[1])), kMaxHalvings);
  }

 private:
  static constexpr int kMaxHalvings = 8;

  struct End {
    Vec3 y;         // [m], B axes, from the mesh's centre
    double zeta;    // [m], height over the level
    double height;  // [m], over the surface; above the highest crest, over that
  };

  End end_at(const Vec3& y) const {
    const Sea& sea = sea_.sea();
    const Vec3 p_W = p_WC_ + R_WB_ * y;
    const double zeta = sea.water().up_W.dot(p_W) - sea.water().level;
    const double crest = sea_.max_elevation();
    if (zeta > crest) return {y, zeta, zeta - crest};
    return {y, zeta, zeta - sea_.elevation(sea.axes().e1_W.dot(p_W), sea.axes().e2_W.dot(p_W))};
  }

  bool is_dry(const End& a, const End& b, int halvings) const {
    const double lowest = std::min(a.height, b.height);
    if (!(lowest > rounding_)) return false;
    if (std::min(a.zeta, b.zeta) > sea_.max_elevation() + rounding_) return true;
    if (lowest > curvature_ * (b.y - a.y).squaredNorm() / 8.0 + rounding_) return true;
    if (halvings == 0) return false;
    const End middle = end_at(0.5 * (a.y + b.y));
    return is_dry(a, middle, halvings - 1) && is_dry(middle, b, halvings - 1);
  }

  const HydrostaticMesh& mesh_;
  const SeaAtTime& sea_;
  Vec3 p_WC_;
  const Mat3& R_WB_;
  double curvature_, rounding_;
};

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
      return fast_surface_in_waves(solver.mesh(), sea, pose, reference_B);
    case Method::kExactSurface:
      return exact_surface_in_waves(solver.mesh(), sea, pose, reference_B);
    default:
      assert(solver.method() == Method::kHierarchical);
      return wave_load({&solver.mesh(), &wave_mesh.patches, solver.tolerance()}, sea.sea().expansion(), sea,
                       pose, reference_B);
  }
}

// Bound on the force of waves over rho g V on a body that is wet everywhere (docs/wave_mathematics.md, "Deep,
// calm, high"). highest: [m], height over the level of the body's bounds.
double max_wave_force_per_volume(const SeaAtTime& sea, double highest) {
  const PreparedSea& prepared = sea.sea();
  const double slope = amplitude_sum(sea, 1);
  if (prepared.pressure() == WavePressure::kHydrostatic) return slope;
  const double h = prepared.depth();
  if (highest < -h) return sea.amplitude_factor() * prepared.max_gradient(-h);
  const double elevation = sea.max_elevation();
  const double depth = -(highest + elevation);  // under the lowest trough
  if (!(depth > 0.0)) return std::numeric_limits<double>::infinity();
  double least_stretch = 1.0;  // bounds on q
  double largest_stretch = 1.0;
  double shear = slope;  // bound on w q^2 |grad eta|
  if (!std::isinf(h)) {
    if (!(elevation < h)) return std::numeric_limits<double>::infinity();
    least_stretch = h / (h + elevation);
    largest_stretch = h / (h - elevation);
    shear = (1.0 + highest / h) * largest_stretch * largest_stretch * slope;
  }
  // The norm of the derivative of x -> (X, z'), a shear with a stretch.
  const double trace = 1.0 + largest_stretch * largest_stretch + shear * shear;
  const double root = std::sqrt(std::max(trace * trace - 4.0 * largest_stretch * largest_stretch, 0.0));
  const double norm = std::sqrt(0.5 * (trace + root));
  return sea.amplitude_factor() * prepared.max_gradient(-least_stretch * depth) * std::max(norm, 1.0);
}

}  // namespace

WaveMesh make_wave_mesh(const HydrostaticMesh& mesh) {
  WaveMesh wave_mesh{build_patch_tree(mesh.surface), {}};
  if (!mesh.is_open()) return wave_mesh;
  std::vector<std::array<std::int32_t, 2>> edges;
  edges.reserve(3 * mesh.surface.triangles.size());
  for (const Triangle& triangle : mesh.surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.push_back({low, high});
    }
  }
  std::ranges::sort(edges);
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::upper_bound(edge, edges.end(), *edge);
    if (next - edge == 1) wave_mesh.boundary_edges.push_back(*edge);
    edge = next;
  }
  return wave_mesh;
}

WaveBuoyancyResult buoyancy_in_waves(const Solver& solver, const WaveMesh& wave_mesh, const SeaAtTime& sea,
                                     const Pose& pose, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  const Water& water = sea.sea().water();
  WaveBuoyancyResult outcome;
  BuoyancyResult& result = outcome.result;
  if (leaves_grid(mesh, sea, pose)) {
    result = failed_result(BuoyancyStatus::kOutOfRange, Immersion::kPiercing);
    return outcome;
  }
  result.immersion = immersion_in_waves(mesh, sea, pose);
  if (result.immersion == Immersion::kDry) return outcome;
  if (!(pose.p_WB.lpNorm<1>() + mesh.center_B.lpNorm<1>() <= kFarthest)) {
    result = failed_result(BuoyancyStatus::kOutOfRange, result.immersion);
    return outcome;
  }
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Boundary boundary(mesh, sea, pose, R_WB);
  const auto is_dry = [&](const auto& edge) { return boundary.is_dry(edge); };
  if (!std::ranges::all_of(wave_mesh.boundary_edges, is_dry)) {
    result = failed_result(BuoyancyStatus::kOpenEdgeWet, result.immersion);
    return outcome;
  }
  const WaveLoad load = load_of(solver, wave_mesh, sea, pose, reference_B);
  outcome.work_capped = load.capped;
  outcome.sea_too_steep = load.too_steep;
  outcome.below_bed = reaches_below_bed(mesh, sea, pose);
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
  const bool has_bound = solver.method() == Method::kHierarchical;
  const double min_volume = has_bound ? 2.0 * force_bound : mesh.volume_tolerance();
  if (load.volume > min_volume) {
    result.center_of_buoyancy_W = R_WB * (mesh.center_B + load.moment / load.volume);
  }
  if (has_bound && force_bound > std::abs(mesh.volume)) {
    outcome = {};
    result = failed_result(BuoyancyStatus::kNotCertified, Immersion::kPiercing);
  } else if (!is_finite(outcome)) {
    outcome = {};
    result = failed_result(BuoyancyStatus::kOutOfRange, Immersion::kPiercing);
  }
  if (!water.layers.empty()) {
    add_layers(solver, pose, water, reference_B, result);
    if (result.status != BuoyancyStatus::kOk) outcome = {.result = result};
  }
  return outcome;
}

bool try_buoyancy_in_waves_from_bounds(const Solver& solver, const FullySubmerged& submerged,
                                       const SeaAtTime& sea, const Pose& pose, const Vec3& reference_B,
                                       WaveBuoyancyResult& outcome) {
  const HydrostaticMesh& mesh = solver.mesh();
  if (leaves_grid(mesh, sea, pose)) return false;
  const Immersion where = immersion_in_waves(mesh, sea, pose);
  if (where == Immersion::kPiercing) return false;
  if (where == Immersion::kDry) {
    outcome = {};
    outcome.result.immersion = where;
    return true;
  }
  if (solver.method() != Method::kHierarchical) return false;
  const Water& water = sea.sea().water();
  // The box of the mesh lies between these heights over the level.
  const RoughWaterPlane plane = rough_water_plane_in_body(pose, water, mesh.center_B, mesh.diagonal);
  const Vec3 up_B = plane.up_B.vec3();
  const double middle = up_B.dot(0.5 * (mesh.box_min + mesh.box_max)) - plane.h_c;
  const double reach = up_B.cwiseAbs().dot(0.5 * (mesh.box_max - mesh.box_min)) + plane.error;
  const double per_volume = max_wave_force_per_volume(sea, (middle + reach) / plane.norm_squared);
  if (!(per_volume <= solver.tolerance())) return false;
  WaveBuoyancyResult calm;
  BuoyancyResult& still = calm.result;
  if (!try_buoyancy_from_bounds(solver, submerged, pose, water, reference_B, still) ||
      still.status != BuoyancyStatus::kOk) {
    return false;
  }
  calm.volume_error_bound = mesh.rounding_bound();
  calm.below_bed = reaches_below_bed(mesh, sea, pose);
  const double wave_force = per_volume * submerged.buoyant_force;
  still.force_error_bound += wave_force;
  still.torque_error_bound += wave_force * mesh.max_lever_arm(reference_B);
  if (!is_finite(calm)) return false;
  outcome = calm;
  return true;
}

}  // namespace buoyancy
