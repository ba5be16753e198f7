#include "hydrostatics/buoyancy.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "hydrostatics/volume_elements.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {
namespace {

bool boundary_is_dry(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  return std::none_of(mesh.boundary_vertices.begin(), mesh.boundary_vertices.end(),
                      [&](std::int32_t i) { return plane.height(mesh.vertex(i)) < 0.0; });
}

// Branch-free finiteness test: x - x is 0 for finite x, and NaN for infinities and NaN.
bool finite(const BuoyancyResult& result) {
  const auto zero = [](double value) { return value - value; };
  const auto zero3 = [zero](const Vec3& v) { return zero(v.x()) + zero(v.y()) + zero(v.z()); };
  return zero3(result.force_W) + zero3(result.torque_W) + zero3(result.center_of_buoyancy_W) +
             zero(result.volume) + zero(result.force_error_bound) + zero(result.torque_error_bound) ==
         0.0;
}

// Bounds on the norms of the errors of force/(rho g) and torque/(rho g).
struct ErrorBounds {
  double force, torque;
};

// [m], "reach" in docs/mathematics.md: the distance from c, beyond the body's size, that a method's
// intermediate values reach, and that cancels in the result. The paper's methods lose digits where the
// pressure is much larger than its variation over the body or the apex is far from the body: at depth; where
// overlapping parts put the centroid far outside; for `fast`, where B's origin is.
double cancellation_distance(const Solver& solver, const WaterPlane& plane) {
  const HydrostaticMesh& mesh = solver.mesh();
  switch (solver.method()) {
    case Method::kHierarchical:
      return 0.0;
    case Method::kFast:
      return mesh.center_B.norm();
    case Method::kFastSurface:
    case Method::kExactSurface:
      return std::abs(plane.h_c);
    case Method::kImproved:
    case Method::kExact:
      return std::max(std::abs(plane.h_c), apex_on_water(mesh, plane).norm());
  }
  return 0.0;
}

ErrorBounds error_bounds(const Solver& solver, const WaterPlane& plane, const Displacement& displaced,
                         const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  constexpr double kGrowth = 3.0;  // measured: plates of many faces need 2
  const double near = mesh.rounding_bound();
  // The diagonal of bodies smaller than 1e-162 m underflows, and so does everything else.
  const double per_metre = mesh.diagonal > 0.0 ? near / mesh.diagonal : 0.0;
  const double rounding =
      near + kGrowth * cancellation_distance(solver, plane) * per_metre + displaced.rounding;
  double lever = mesh.max_lever_arm(reference_B);
  if (displaced.truncation_lever > 0.0) {
    lever = std::max(lever, displaced.truncation_lever + (reference_B - mesh.center_B).norm());
  }
  const double force = rounding + displaced.truncation_bound;
  return {force, force * lever};
}

// Returns q v q* / |q|^2, for which q may have any norm and no square root is needed. Named scalars stay in
// registers; Eigen's arrays are stored and read again, which costs time in scenes of many bodies.
Point<double> rotate(const Eigen::Quaterniond& q, double two_by_norm_squared, const Vec3& v) {
  const Point<double> u{q.x(), q.y(), q.z()};
  const Point<double> p = Point<double>::from(v);
  const Point<double> across = cross(u, p);
  return p + two_by_norm_squared * (q.w() * across + cross(u, across));
}

// The centre of buoyancy is the volume's centroid, and the torque follows from its lever: neither depends on
// the depth.
void set_submerged_result(const FullySubmerged& submerged, const Pose& pose, const Water& water,
                          BuoyancyResult& result) {
  const Eigen::Quaterniond& q = pose.q_WB;
  const double two_by_norm_squared = 2.0 / (q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z());
  const auto up = Point<double>::from(water.up_W);
  const Point<double> lever_W = rotate(q, two_by_norm_squared, submerged.lever_B);
  const Point<double> center_W = submerged.lever_B == submerged.centroid_B
                                     ? lever_W
                                     : rotate(q, two_by_norm_squared, submerged.centroid_B);
  const Point<double> torque_W = submerged.buoyant_force * cross(lever_W, up);
  // Every field is set, so that no old value remains.
  result = {.status = BuoyancyStatus::kOk,
            .immersion = Immersion::kSubmerged,
            .force_W = submerged.force_W,
            .torque_W = (torque_W - dot(up, torque_W) * up).vec3(),
            .volume = submerged.volume,
            .center_of_buoyancy_W = center_W.vec3(),
            .force_error_bound = submerged.force_error_bound,
            .torque_error_bound = submerged.torque_error_bound,
            .dropped_force = 0.0,
            .dropped_torque = 0.0};
}

// Converts the displacement in the body frame to force, torque and centre of buoyancy in the world.
void set_result_from_displacement(const Solver& solver, const WaterPlane& plane, const Pose& pose,
                                  const Water& water, const Vec3& reference_B, BuoyancyResult& result) {
  const HydrostaticMesh& mesh = solver.mesh();
  const Displacement displaced = solver.displacement(plane);
  const double specific_weight = water.density * water.gravity;  // [N/m^3]
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3& k = plane.up_B;
  const Vec3 lever = mesh.center_B - reference_B;  // [m], B

  result.volume = displaced.volume;
  if (is_exact(solver.method())) {
    const double twist = k.dot(displaced.torque);
    if (mesh.volume > 0.0) {
      result.dropped_force = (displaced.force - k.dot(displaced.force) * k).norm() / mesh.volume;
      result.dropped_torque = std::abs(twist) / mesh.volume / mesh.diagonal;
    }
    result.force_W = (specific_weight * displaced.volume) * water.up_W;
    const Vec3 torque_W = R_WB * (displaced.torque - twist * k + lever.cross(displaced.volume * k));
    result.torque_W = specific_weight * (torque_W - water.up_W.dot(torque_W) * water.up_W);
  } else {
    result.force_W = specific_weight * (R_WB * displaced.force);
    result.torque_W = specific_weight * (R_WB * (displaced.torque + lever.cross(displaced.force)));
  }

  const ErrorBounds bounds = error_bounds(solver, plane, displaced, reference_B);
  result.force_error_bound = specific_weight * bounds.force;
  result.torque_error_bound = specific_weight * bounds.torque;
  const double min_volume = is_exact(solver.method()) ? bounds.force : mesh.volume_tolerance();
  if (std::abs(displaced.volume) > min_volume) {
    result.center_of_buoyancy_W = R_WB * (mesh.center_B + displaced.moment / displaced.volume);
  }
}

BuoyancyResult failed_result(BuoyancyStatus status, Immersion where) {
  BuoyancyResult result;
  result.status = status;
  result.immersion = where;
  return result;
}

// True if the immersion suffices for a result: for a dry body, and for a fully submerged one with
// `hierarchical`.
bool is_decided_by_bounds(const Solver& solver, Immersion immersion) {
  return immersion == Immersion::kDry ||
         (immersion == Immersion::kSubmerged && solver.method() == Method::kHierarchical);
}

// Requires is_decided_by_bounds().
void set_result_from_bounds(const FullySubmerged& submerged, Immersion immersion, const Pose& pose,
                            const Water& water, BuoyancyResult& result) {
  if (immersion == Immersion::kDry) {  // every method gives exactly zero
    result = {};
    result.immersion = immersion;
    return;
  }
  set_submerged_result(submerged, pose, water, result);
  if (!finite(result)) result = failed_result(BuoyancyStatus::kOutOfRange, immersion);
}

// Computes buoyancy() without trying the quick bounds first. plane: solver.plane_in_body(pose, water).
BuoyancyResult buoyancy_at_plane(const Solver& solver, const WaterPlane& plane, const Pose& pose,
                                 const Water& water, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = solver.mesh();
  if (!std::isfinite(plane.h_c) || !plane.up_B.allFinite()) {
    return failed_result(BuoyancyStatus::kOutOfRange, Immersion::kPiercing);
  }
  const Immersion where = immersion(mesh, plane);
  if (where != Immersion::kDry && mesh.is_open() && !boundary_is_dry(mesh, plane)) {
    return failed_result(BuoyancyStatus::kOpenEdgeWet, where);
  }
  BuoyancyResult result;
  if (is_decided_by_bounds(solver, where)) {
    set_result_from_bounds(submerged_constants(mesh, water, reference_B), where, pose, water, result);
    return result;
  }
  result.immersion = where;
  set_result_from_displacement(solver, plane, pose, water, reference_B, result);
  if (!finite(result)) return failed_result(BuoyancyStatus::kOutOfRange, where);
  return result;
}

// Computes buoyancy() of the water above the layers, as if it had none.
BuoyancyResult buoyancy_above_layers(const Solver& solver, const Pose& pose, const Water& water,
                                     const Vec3& reference_B) {
  const Immersion quick = quick_immersion(solver.mesh(), pose, water);
  if (is_decided_by_bounds(solver, quick)) {
    BuoyancyResult result;
    set_result_from_bounds(submerged_constants(solver.mesh(), water, reference_B), quick, pose, water,
                           result);
    return result;
  }
  return buoyancy_at_plane(solver, solver.plane_in_body(pose, water), pose, water, reference_B);
}

// Returns whether the body crosses no layer's top, which quick bounds decide.
bool bounds_decide_layers(const Solver& solver, const Pose& pose, const Water& water) {
  for (std::size_t i = 0; i < water.layers.size(); ++i) {
    const Immersion quick = quick_immersion(solver.mesh(), pose, water_of_step(water, i));
    if (quick == Immersion::kDry) return true;
    if (!is_decided_by_bounds(solver, quick)) return false;
  }
  return true;
}

}  // namespace

FullySubmerged submerged_constants(const HydrostaticMesh& mesh, const Water& water, const Vec3& reference_B) {
  const double specific_weight = water.density * water.gravity;  // [N/m^3]
  const double force_error_bound = specific_weight * mesh.rounding_bound();
  const double buoyant_force = specific_weight * mesh.volume;
  return {.volume = mesh.volume,
          .buoyant_force = buoyant_force,
          .force_W = buoyant_force * water.up_W,
          // This order loses no digits for a reference point near the body, both far from B's origin.
          .lever_B = (mesh.center_B - reference_B) + mesh.centroid,
          .centroid_B = mesh.center_B + mesh.centroid,
          .force_error_bound = force_error_bound,
          .torque_error_bound = force_error_bound * mesh.max_lever_arm(reference_B)};
}

void add_layers(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B,
                BuoyancyResult& result) {
  if (result.status != BuoyancyStatus::kOk || result.immersion == Immersion::kDry) return;
  const Vec3& up_W = water.up_W;
  double lift = up_W.dot(result.force_W);              // [N]
  Vec3 moment_W = lift * result.center_of_buoyancy_W;  // [N m]
  for (std::size_t i = 0; i < water.layers.size(); ++i) {
    const BuoyancyResult term = buoyancy_above_layers(solver, pose, water_of_step(water, i), reference_B);
    if (term.status != BuoyancyStatus::kOk) {
      result = failed_result(term.status, result.immersion);
      return;
    }
    if (term.immersion == Immersion::kDry) break;  // and the lower layers are, too
    result.force_W += term.force_W;
    result.torque_W += term.torque_W;
    result.force_error_bound += term.force_error_bound;
    result.torque_error_bound += term.torque_error_bound;
    result.dropped_force = std::max(result.dropped_force, term.dropped_force);
    result.dropped_torque = std::max(result.dropped_torque, term.dropped_torque);
    const double of_term = up_W.dot(term.force_W);
    lift += of_term;
    moment_W += of_term * term.center_of_buoyancy_W;
    if (lift > 0.0) result.center_of_buoyancy_W = moment_W / lift;
  }
  // In waves, bounds may be infinite.
  if (!result.force_W.allFinite() || !result.torque_W.allFinite() ||
      !result.center_of_buoyancy_W.allFinite()) {
    result = failed_result(BuoyancyStatus::kOutOfRange, result.immersion);
  }
}

bool try_buoyancy_from_bounds(const Solver& solver, const FullySubmerged& submerged, const Pose& pose,
                              const Water& water, const Vec3& reference_B, BuoyancyResult& result) {
  const Immersion quick = quick_immersion(solver.mesh(), pose, water);
  if (!is_decided_by_bounds(solver, quick)) return false;
  if (!water.layers.empty() && quick != Immersion::kDry && !bounds_decide_layers(solver, pose, water)) {
    return false;
  }
  set_result_from_bounds(submerged, quick, pose, water, result);
  if (!water.layers.empty()) add_layers(solver, pose, water, reference_B, result);
  return true;
}

BuoyancyResult buoyancy(const Solver& solver, const Pose& pose, const Water& water, const Vec3& reference_B) {
  BuoyancyResult result = buoyancy_above_layers(solver, pose, water, reference_B);
  if (!water.layers.empty()) add_layers(solver, pose, water, reference_B, result);
  return result;
}

void buoyancy(std::span<const BuoyancyQuery> queries, const Water& water, std::span<BuoyancyResult> results) {
  constexpr std::size_t kGroup = 8;
  assert(queries.size() == results.size());
  std::array<Pose, kGroup> poses;
  std::array<Vec3, kGroup> centers_B;
  std::array<WaterPlane, kGroup> planes;
  for (std::size_t first = 0; first < queries.size(); first += kGroup) {
    const std::size_t count = std::min(kGroup, queries.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      poses[i] = queries[first + i].pose;
      centers_B[i] = queries[first + i].solver->mesh().center_B;
    }
    water_planes_in_body(std::span(poses).first(count), water, std::span(centers_B).first(count),
                         std::span(planes).first(count));
    for (std::size_t i = 0; i < count; ++i) {
      const BuoyancyQuery& query = queries[first + i];
      if (!query.solver->has_exact_planes()) planes[i] = query.solver->plane_in_body(query.pose, water);
      results[first + i] = buoyancy_at_plane(*query.solver, planes[i], query.pose, water, query.reference_B);
    }
  }
  if (water.layers.empty()) return;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    add_layers(*queries[i].solver, queries[i].pose, water, queries[i].reference_B, results[i]);
  }
}

}  // namespace buoyancy
