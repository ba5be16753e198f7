#include "hydrostatics/immersion.h"

#include <limits>

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

Immersion immersion(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 at_min = plane.up_B.cwiseProduct(mesh.box_min);
  const Vec3 at_max = plane.up_B.cwiseProduct(mesh.box_max);
  const double lowest = at_min.cwiseMin(at_max).sum() - plane.h_c;
  const double highest = at_min.cwiseMax(at_max).sum() - plane.h_c;
  const double margin = 8.0 * kEpsilon * (mesh.diagonal + std::abs(plane.h_c));
  if (lowest > margin) return Immersion::kDry;
  if (highest < -margin && !mesh.open()) return Immersion::kWet;
  return Immersion::kCrossing;
}

Immersion immersion_at_a_glance(const HydrostaticMesh& mesh, const Pose& pose, const Water& water) {
  const Eigen::Quaterniond& q = pose.q_WB;
  const Vec3& up = water.up_W;
  const Vec3 u = q.vec();
  const double u_squared = u.squaredNorm();
  const double w_squared = q.w() * q.w();
  // All heights times |q|^2, which spares the divisions. Where the squares overflow no comparison holds;
  // where they underflow their margin would not be one.
  const double norm_squared = w_squared + u_squared;
  if (!(norm_squared > 1e-100)) return Immersion::kCrossing;
  const Vec3 k = (w_squared - u_squared) * up + 2.0 * (u.dot(up) * u - q.w() * u.cross(up));
  const Vec3 middle = mesh.center_B + 0.5 * (mesh.box_min + mesh.box_max);
  const Vec3 half = 0.5 * (mesh.box_max - mesh.box_min);
  const double height = norm_squared * (up.dot(pose.p_WB) - water.level) + k.dot(middle);
  const double reach = k.cwiseAbs().dot(half);
  // k is off by at most 16 epsilon, every product and sum by half of one of its terms' sum.
  const double margin = 32.0 * kEpsilon * norm_squared *
                        (pose.p_WB.lpNorm<1>() + std::abs(water.level) + middle.lpNorm<1>() + mesh.diagonal);
  if (height - reach > margin) return Immersion::kDry;
  if (height + reach < -margin && !mesh.open()) return Immersion::kWet;
  return Immersion::kCrossing;
}

}  // namespace buoyancy
