#include "hydrostatics/hierarchical.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hydrostatics/immersion.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wet_tree_sum.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// The part of x that is a whole multiple of unit (a power of two).
double whole_multiples(double x, double unit) {
  return std::nearbyint(x / unit) * unit;
}

TreeQuery make_tree_query(const MomentTree& tree, const WaterPlane& plane) {
  constexpr double kUnit = 0x1p-26;
  const Vec3& k = plane.up_B;
  // A horizontal axis across the largest components of k, and the one that makes the frame right-handed.
  const Vec3 u =
      (std::abs(k.x()) > std::abs(k.z()) ? Vec3(-k.y(), k.x(), 0.0) : Vec3(0.0, -k.z(), k.y())).normalized();
  const Vec3 v = k.cross(u);
  TreeQuery query{};
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    query.k[n] = k[i];
    query.k_high[n] = whole_multiples(k[i], kUnit);
    query.k_low[n] = (k[i] - query.k_high[n]) + plane.up_B_rest[i];
    query.u[n] = u[i];
    query.v[n] = v[i];
  }
  query.h_high = whole_multiples(plane.h_c, tree.grid * kUnit);
  query.h_low = (plane.h_c - query.h_high) + plane.h_c_rest;
  return query;
}

Displacement read_out(const WetTreeSum& sum, const TreeQuery& query, const WaterPlane& plane,
                      const HydrostaticMesh& mesh) {
  const SurfaceMoments<double> wet = sum.wet_nodes.moments();
  const Vec3& k = plane.up_B;
  const double z_c = -plane.h_c;
  const double k_S = k.dot(wet.S);
  const Vec3 N_k = wet.N * k;
  const Eigen::Matrix<double, 6, 1> P_k = wet.P * k;  // P_ijk k_k by pairs (i, j)
  const double k_N_k = k.dot(N_k);
  const Vec3 k_P_k(k.x() * P_k(0) + k.y() * P_k(3) + k.z() * P_k(4),
                   k.x() * P_k(3) + k.y() * P_k(1) + k.z() * P_k(5),
                   k.x() * P_k(4) + k.y() * P_k(5) + k.z() * P_k(2));

  const double cut_volume = sum.volume6 / 6.0;
  const double cut_height = sum.height24 / 24.0;
  const Vec3 u(query.u[0], query.u[1], query.u[2]);
  const Vec3 v(query.v[0], query.v[1], query.v[2]);
  Displacement result;
  result.volume = k_N_k + z_c * k_S + cut_volume;
  double height = 0.5 * (k.dot(k_P_k) + z_c * (2.0 * k_N_k + z_c * k_S)) + cut_height;
  // Along k the cut triangles' part of U is int z (z - z_c) n_k dA = 2 H - z_c V.
  Vec3 U = k_P_k + z_c * N_k + (sum.moment_u24 / 24.0) * u + (sum.moment_v24 / 24.0) * v +
           (2.0 * cut_height - z_c * cut_volume) * k;
  if (query.budget > 0.0) {
    const UndecidedSum& rest = sum.undecided;
    const SurfaceMoments<double> offsets = rest.offsets.moments();
    const Vec3 offset_N_k = offsets.N * k;
    const double offset_k_S = k.dot(offsets.S);
    const Vec3 curved(rest.moment[0], rest.moment[1], rest.moment[2]);
    result.volume += offset_k_S + rest.volume;
    height += 0.5 * (k.dot(offset_N_k) + z_c * offset_k_S + k.dot(curved) + z_c * rest.volume);
    U += offset_N_k + curved;
    result.left_out = rest.error;
  }
  if (!mesh.holds_gate()) result.rounding = kEpsilon * mesh.diagonal * sum.rounding;
  result.moment = U - height * k;
  result.force = result.volume * k;
  result.torque = U.cross(k);
  return result;
}

// m^3: what may be left undecided so that with the rounding all stays within the tolerance. Bounds are
// held in float32: sizes beyond its range are answered exactly.
double budget(const HydrostaticMesh& mesh, double tolerance) {
  const bool in_range = mesh.diagonal > 1e-9 && mesh.diagonal < 1e9;
  double rounding = mesh.rounding_bound();
  if (!mesh.holds_gate()) rounding += kEpsilon * mesh.diagonal * mesh.tree->rounding;
  return in_range ? std::max(tolerance * std::abs(mesh.volume) - rounding, 0.0) : 0.0;
}

}  // namespace

Displacement hierarchical(const HydrostaticMesh& mesh, const WaterPlane& plane, double tolerance) {
  const MomentTree& tree = *mesh.tree;
  switch (immersion(mesh, plane)) {
    case Immersion::kDry:
      return {};
    case Immersion::kWet:
      return displacement_of_volume(mesh.volume, mesh.volume * mesh.centroid, plane);
    case Immersion::kCrossing:
      break;
  }
  TreeQuery query = make_tree_query(tree, plane);
  query.budget = tolerance > 0.0 ? budget(mesh, tolerance) : 0.0;
  query.half_diagonal = 0.5 * mesh.diagonal;
  return read_out(sum_wet_tree(tree, query), query, plane, mesh);
}

}  // namespace buoyancy
