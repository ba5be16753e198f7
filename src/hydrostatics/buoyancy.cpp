#include "hydrostatics/buoyancy.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace buoyancy {
namespace {

// Lowest and highest signed height of the mesh's bounding box.
struct HeightRange {
  double lowest, highest;  // m
};

HeightRange height_range(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 at_min = plane.up_B.cwiseProduct(mesh.box_min);
  const Vec3 at_max = plane.up_B.cwiseProduct(mesh.box_max);
  return {at_min.cwiseMin(at_max).sum() - plane.h_c, at_min.cwiseMax(at_max).sum() - plane.h_c};
}

// Decided by bounds with a margin for rounding: kDry and kWet are certain, for the solvers' own heights too.
Immersion immersion(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const HeightRange range = height_range(mesh, plane);
  const double margin = 8.0 * kEpsilon * (mesh.diagonal + std::abs(plane.h_c));
  if (range.lowest > margin) return Immersion::kDry;
  if (range.highest < -margin) return Immersion::kWet;
  return Immersion::kCrossing;
}

bool boundary_is_dry(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  return std::none_of(mesh.boundary_vertices.begin(), mesh.boundary_vertices.end(),
                      [&](std::int32_t i) { return plane.height(mesh.vertex(i)) < 0.0; });
}

bool finite(const BuoyancyAnswer& answer) {
  return answer.force_W.allFinite() && answer.torque_W.allFinite() && std::isfinite(answer.volume) &&
         answer.center_of_buoyancy_W.allFinite();
}

// Bounds on the norms of the errors of force/(rho g) and torque/(rho g); NaN for methods that have none.
struct ErrorBounds {
  double force, torque;
};

ErrorBounds error_bounds(const Solver& solver, const WaterPlane& plane, const Vec3& reference_B) {
  if (!is_exact(solver.method())) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  const HydrostaticMesh& mesh = solver.mesh();
  const double depth = std::abs(plane.h_c);
  const double deep = depth > mesh.diagonal ? 1.0 + depth / mesh.diagonal : 1.0;
  const double force = deep * mesh.volume_gate();
  return {force, force * mesh.largest_lever(reference_B)};
}

}  // namespace

BuoyancyAnswer buoyancy(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  BuoyancyAnswer answer;
  if (!std::isfinite(plane.h_c) || !plane.up_B.allFinite()) {
    answer.status = BuoyancyStatus::kOutOfRange;
    return answer;
  }
  answer.immersion = immersion(mesh, plane);
  if (answer.immersion == Immersion::kDry) return answer;  // nothing to sum: every method says zero, exactly
  if (mesh.open() && !boundary_is_dry(mesh, plane)) {
    answer.status = BuoyancyStatus::kOpenEdgeWet;
    return answer;
  }

  const Displacement displaced = solver.displacement(plane);
  const double weight = water.density * water.gravity;  // N/m^3
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3& k = plane.up_B;
  const Vec3 lever = mesh.center_B - reference_B;  // m, B

  answer.volume = displaced.volume;
  if (is_exact(solver.method())) {
    const double twist = k.dot(displaced.torque);
    if (mesh.volume > 0.0) {
      answer.dropped_force = (displaced.force - k.dot(displaced.force) * k).norm() / mesh.volume;
      answer.dropped_torque = std::abs(twist) / mesh.volume / mesh.diagonal;
    }
    answer.force_W = (weight * displaced.volume) * water.up_W;
    const Vec3 torque_W = R_WB * (displaced.torque - twist * k + lever.cross(displaced.volume * k));
    answer.torque_W = weight * (torque_W - water.up_W.dot(torque_W) * water.up_W);
  } else {
    answer.force_W = weight * (R_WB * displaced.force);
    answer.torque_W = weight * (R_WB * (displaced.torque + lever.cross(displaced.force)));
  }

  const ErrorBounds bounds = error_bounds(solver, plane, reference_B);
  answer.force_error_bound = weight * bounds.force;
  answer.torque_error_bound = weight * bounds.torque;
  const double smallest_volume = std::isnan(bounds.force) ? mesh.volume_gate() : bounds.force;
  if (std::abs(displaced.volume) > smallest_volume) {
    answer.center_of_buoyancy_W = R_WB * (mesh.center_B + displaced.moment / displaced.volume);
  }
  if (!finite(answer)) {
    const Immersion where = answer.immersion;
    answer = {};
    answer.status = BuoyancyStatus::kOutOfRange;
    answer.immersion = where;
  }
  return answer;
}

}  // namespace buoyancy
