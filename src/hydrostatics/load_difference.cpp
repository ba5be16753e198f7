#include "hydrostatics/load_difference.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation_between.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/lowest_vertex.h"

namespace buoyancy {
namespace {

// The i-th point of the R_3 sequence in the unit cube: multiples of the powers of 1/g modulo 1, where
// g^4 = g + 1. Any first n points cover the cube evenly.
Vec3 evenly_spread(int i) {
  constexpr double kG = 1.2207440846057596;
  constexpr double kPowers[3] = {1.0 / kG, 1.0 / (kG * kG), 1.0 / (kG * kG * kG)};
  const auto share = [i](double power) { return std::fmod(0.5 + (i + 1.0) * power, 1.0); };
  return {share(kPowers[0]), share(kPowers[1]), share(kPowers[2])};
}

// [m], along up_B from B's origin.
double lowest_height(const HydrostaticMesh& mesh, const Vec3& up_B) {
  return mesh.center_B.dot(up_B) + lowest_vertex(*mesh.tree, up_B);
}

Pose pose_at(const Vec3& shares, const HydrostaticMesh& a, const HydrostaticMesh& b) {
  const double z = 2.0 * shares.x() - 1.0;
  const double radius = std::sqrt(1.0 - z * z);
  const double angle = 2.0 * M_PI * shares.y();
  const Vec3 up_B(radius * std::cos(angle), radius * std::sin(angle), z);
  const double low = std::min(lowest_height(a, up_B), lowest_height(b, up_B));
  const double high = -std::min(lowest_height(a, -up_B), lowest_height(b, -up_B));
  return {(-low - shares.z() * (high - low)) * Vec3::UnitZ(), rotation_between(up_B, Vec3::UnitZ())};
}

}  // namespace

LoadDifference largest_load_difference(const HydrostaticMesh& a, const HydrostaticMesh& b, double density,
                                       double gravity, int poses) {
  const Water water{.density = density, .gravity = gravity};
  const Solver solver_a(a, Method::kHierarchical);
  const Solver solver_b(b, Method::kHierarchical);
  LoadDifference largest;
  for (int i = 0; i < poses; ++i) {
    const Pose pose = pose_at(evenly_spread(i), a, b);
    const BuoyancyResult of_a = buoyancy(solver_a, pose, water, Vec3::Zero());
    const BuoyancyResult of_b = buoyancy(solver_b, pose, water, Vec3::Zero());
    largest.force = std::max(largest.force, (of_a.force_W - of_b.force_W).norm());
    largest.torque = std::max(largest.torque, (of_a.torque_W - of_b.torque_W).norm());
    largest.force_error = std::max(largest.force_error, of_a.force_error_bound + of_b.force_error_bound);
    largest.torque_error = std::max(largest.torque_error, of_a.torque_error_bound + of_b.torque_error_bound);
  }
  return largest;
}

}  // namespace buoyancy
