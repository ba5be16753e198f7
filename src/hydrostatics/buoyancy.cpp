#include "hydrostatics/buoyancy.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

bool boundary_is_dry(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  return std::none_of(mesh.boundary_vertices.begin(), mesh.boundary_vertices.end(),
                      [&](std::int32_t i) { return plane.height(mesh.vertex(i)) < 0.0; });
}

bool finite(const BuoyancyAnswer& answer) {
  return answer.force_W.allFinite() && answer.torque_W.allFinite() && std::isfinite(answer.volume) &&
         answer.center_of_buoyancy_W.allFinite();
}

// Bounds on the norms of the errors of force/(rho g) and torque/(rho g).
struct ErrorBounds {
  double force, torque;
};

// How many times G_V rounding may reach. The paper's methods lose digits with depth: the apex, or the
// pressure, is then far from the body's size; `fast` with the distance of its apex, B's origin.
double rounding_in_gates(const Solver& solver, const WaterPlane& plane) {
  const HydrostaticMesh& mesh = solver.mesh();
  double far = 0.0;  // m
  if (solver.method() == Method::kFast) {
    far = mesh.center_B.norm();
  } else if (solver.method() != Method::kHierarchical) {
    far = std::abs(plane.h_c);
  }
  return far > mesh.diagonal ? 1.0 + far / mesh.diagonal : 1.0;
}

ErrorBounds error_bounds(const Solver& solver, const WaterPlane& plane, const Displacement& displaced,
                         const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  const double rounding = mesh.volume_gate() * rounding_in_gates(solver, plane);
  double lever = mesh.largest_lever(reference_B);
  if (displaced.left_out_reach > 0.0) {
    lever = std::max(lever, displaced.left_out_reach + (reference_B - mesh.center_B).norm());
  }
  const double force = rounding + displaced.left_out;
  return {force, force * lever};
}

// The centre of buoyancy is the volume's centroid and the torque its lever's: nothing depends on the depth.
void answer_wholly_wet(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                       const Vec3& reference_B, BuoyancyAnswer& answer) {
  const double weight = water.density * water.gravity;  // N/m^3
  const Eigen::Quaterniond q_WB = pose.q_WB.normalized();
  // In this order: a reference point near the body, both far from B's origin, loses nothing.
  const Vec3 lever_B = (mesh.center_B - reference_B) + mesh.centroid;
  answer.volume = mesh.volume;
  answer.force_W = (weight * mesh.volume) * water.up_W;
  const Vec3 torque_W = (weight * mesh.volume) * (q_WB * lever_B).cross(water.up_W);
  answer.torque_W = torque_W - water.up_W.dot(torque_W) * water.up_W;
  answer.center_of_buoyancy_W = q_WB * (mesh.center_B + mesh.centroid);
  answer.force_error_bound = weight * mesh.volume_gate();
  answer.torque_error_bound = answer.force_error_bound * mesh.largest_lever(reference_B);
}

// What the body displaces, as forces in the world.
void answer_from_displacement(const Solver& solver, const WaterPlane& plane, const Pose& pose,
                              const Water& water, const Vec3& reference_B, BuoyancyAnswer& answer) {
  const HydrostaticMesh& mesh = solver.mesh();
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

  const ErrorBounds bounds = error_bounds(solver, plane, displaced, reference_B);
  answer.force_error_bound = weight * bounds.force;
  answer.torque_error_bound = weight * bounds.torque;
  const double smallest_volume = is_exact(solver.method()) ? bounds.force : mesh.volume_gate();
  if (std::abs(displaced.volume) > smallest_volume) {
    answer.center_of_buoyancy_W = R_WB * (mesh.center_B + displaced.moment / displaced.volume);
  }
}

BuoyancyAnswer not_answered(BuoyancyStatus status, Immersion where) {
  BuoyancyAnswer answer;
  answer.status = status;
  answer.immersion = where;
  return answer;
}

}  // namespace

bool is_answered_by_bounds(const Solver& solver, Immersion immersion) {
  return immersion == Immersion::kDry ||
         (immersion == Immersion::kWet && solver.method() == Method::kHierarchical);
}

BuoyancyAnswer buoyancy(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  BuoyancyAnswer answer;
  answer.immersion = immersion_at_a_glance(mesh, pose, water);
  if (!is_answered_by_bounds(solver, answer.immersion)) {
    const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
    if (!std::isfinite(plane.h_c) || !plane.up_B.allFinite()) {
      return not_answered(BuoyancyStatus::kOutOfRange, Immersion::kCrossing);
    }
    answer.immersion = immersion(mesh, plane);
    if (answer.immersion != Immersion::kDry && mesh.open() && !boundary_is_dry(mesh, plane)) {
      return not_answered(BuoyancyStatus::kOpenEdgeWet, answer.immersion);
    }
    if (!is_answered_by_bounds(solver, answer.immersion)) {
      answer_from_displacement(solver, plane, pose, water, reference_B, answer);
      if (!finite(answer)) return not_answered(BuoyancyStatus::kOutOfRange, answer.immersion);
      return answer;
    }
  }
  if (answer.immersion == Immersion::kDry) return answer;  // nothing to sum: every method says zero, exactly
  answer_wholly_wet(mesh, pose, water, reference_B, answer);
  if (!finite(answer)) return not_answered(BuoyancyStatus::kOutOfRange, answer.immersion);
  return answer;
}

}  // namespace buoyancy
