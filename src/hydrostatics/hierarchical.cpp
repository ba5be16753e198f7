#include "hydrostatics/hierarchical.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/immersion.h"
#include "hydrostatics/tree_plane.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_tree_sum.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Integrals with n_a dA over the wetted surface.
struct AxisIntegrals {
  double volume = 0.0;         // [m^3] int z n_a dA
  Vec3 moment = Vec3::Zero();  // [m^4] int z y n_a dA
  double z_squared = 0.0;      // [m^4] int z^2 n_a dA
};

// Returns the integrals over a surface with these moments, with z = k . y + z_c.
AxisIntegrals integrals(const AxisMoments& moments, const Vec3& k, double z_c) {
  const Vec3 N(moments.N[0], moments.N[1], moments.N[2]);
  Vec3 k_P = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      k_P[static_cast<int>(j)] +=
          k[static_cast<int>(i)] * moments.P[static_cast<std::size_t>(kSymmetricPair[i][j])];
    }
  }
  const double k_N = k.dot(N);
  return {k_N + z_c * moments.S, k_P + z_c * N, k.dot(k_P) + z_c * (2.0 * k_N + z_c * moments.S)};
}

// Returns the errors of volume and of torque/(rho g L_r) per error d of the heights [m^2]. The volume changes
// by d times a section of at most half the surface, and k turns by d / L, and with it the lever of V_T. The
// other half of the surface covers overlapping parts, which turn more volume.
double sensitivity(const HydrostaticMesh& mesh) {
  return mesh.area + std::abs(mesh.volume) / mesh.diagonal;
}

// plane: in the coordinates of the tree (plane_of_tree()).
Displacement to_displacement(const WettedTreeSum& sum, const TreeQuery& query, const WaterPlane& plane,
                             const HydrostaticMesh& mesh) {
  const double scale = mesh.tree->scale;
  const double scale_cubed = scale * scale * scale;
  const Vec3& k = plane.up_B;
  const double z_c = -plane.h_c;
  const auto a = static_cast<int>(query.axes[0]);
  const auto b = static_cast<int>(query.axes[1]);
  const auto c = static_cast<int>(query.axes[2]);
  AxisIntegrals wet = integrals(sum.nodes, k, z_c);
  wet.volume += sum.volume6 / 6.0;
  wet.moment[b] += sum.moment_b24 / 24.0;
  wet.moment[c] += sum.moment_c24 / 24.0;
  wet.z_squared += sum.z_squared12 / 12.0;

  Displacement result;
  if (query.budget > 0.0) {
    const PrunedSum& rest = sum.pruned;
    const Vec3 offset_N(rest.offsets.N[0], rest.offsets.N[1], rest.offsets.N[2]);
    wet.volume += rest.offsets.S + rest.volume;
    wet.moment += offset_N + rest.moment;
    wet.z_squared += k.dot(offset_N + rest.moment) + z_c * (rest.offsets.S + rest.volume);
    result.truncation_bound = scale_cubed * rest.error;
  }
  if (!mesh.meets_volume_tolerance()) result.rounding = kEpsilon * scale_cubed * sum.rounding;

  // int z n_a dA = k_a V;  int z y_b n_a dA = k_a M_b, likewise c;  int z^2 n_a dA = 2 k_a H;
  // k . M = H - z_c V.
  result.volume = wet.volume / k[a];
  result.moment[b] = wet.moment[b] / k[a];
  result.moment[c] = wet.moment[c] / k[a];
  const double along_k = 0.5 * wet.z_squared / k[a] - z_c * result.volume;
  result.moment[a] = (along_k - k[b] * result.moment[b] - k[c] * result.moment[c]) / k[a];
  result.volume *= scale_cubed;
  result.moment = (scale_cubed * scale) * result.moment + result.volume * mesh.tree->offset;
  result.force = result.volume * k;
  result.torque = result.moment.cross(k);
  return result;
}

// Returns the largest error by pruning [m^3] that, with rounding, stays within the tolerance. Pruning bounds
// are held in float32; for sizes beyond its range the budget is 0, and the result is exact.
double budget(const HydrostaticMesh& mesh, double tolerance) {
  const bool in_range = mesh.diagonal > 1e-9 && mesh.diagonal < 1e9;
  return in_range ? std::max(tolerance * std::abs(mesh.volume) - mesh.max_rounding_bound(), 0.0) : 0.0;
}

}  // namespace

double allowed_plane_error(const HydrostaticMesh& mesh, double tolerance) {
  constexpr double kShare = 0.01;
  // The test for a wet open edge uses the plane itself, which must be exact.
  if (!(tolerance > 0.0) || mesh.is_open()) return 0.0;
  return kShare * budget(mesh, tolerance) / sensitivity(mesh);
}

Displacement hierarchical(const HydrostaticMesh& mesh, const WaterPlane& plane, double tolerance) {
  const MomentTree& tree = *mesh.tree;
  switch (immersion(mesh, plane)) {
    case Immersion::kDry:
      return {};
    case Immersion::kSubmerged:
      return displacement_of_volume(mesh.volume, mesh.volume * mesh.centroid, plane);
    case Immersion::kPiercing:
      break;
  }
  const WaterPlane tree_plane = plane_of_tree(tree, plane);
  TreeQuery query = make_tree_query(tree, tree_plane);
  const double from_plane = plane.error > 0.0 ? sensitivity(mesh) * plane.error : 0.0;  // [m^3]
  if (tolerance > 0.0) {
    query.budget =
        std::max(budget(mesh, tolerance) - from_plane, 0.0) / (tree.scale * tree.scale * tree.scale);
  }
  query.half_diagonal = 0.5 * mesh.diagonal / tree.scale;
  Displacement result = to_displacement(sum_wetted_tree(tree, query), query, tree_plane, mesh);
  result.truncation_bound += from_plane;
  return result;
}

}  // namespace buoyancy
