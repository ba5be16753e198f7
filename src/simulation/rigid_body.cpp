#include "simulation/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <Eigen/Eigenvalues>

#include "base/format.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hierarchical.h"
#include "messages/conversions.h"
#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

// Sets mass, centre of mass and inertia. Returns false where the inertia is not positive definite.
bool set_mass(const RigidBodyMass& mass, RigidBody& rigid) {
  rigid.mass = mass.mass;
  rigid.center_of_mass_B = mass.center_of_mass_B;
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(mass.inertia_B);
  rigid.principal_inertia = principal.eigenvalues();
  rigid.principal_axes_B = principal.eigenvectors();
  return rigid.principal_inertia.minCoeff() > 0.0 && rigid.principal_inertia.allFinite();
}

Vec3 angular_momentum_of(const RigidBody& body, const Eigen::Quaterniond& q_WB, const Vec3& w_W) {
  const Vec3 w_P = body.principal_axes_B.transpose() * (q_WB.conjugate() * w_W);
  return q_WB * Vec3(body.principal_axes_B * body.principal_inertia.cwiseProduct(w_P));
}

// Returns the weights about C, with the liquids as they lie at the attitude.
Weights weights_at(const RigidBody& body, const BodyContents& contents, const Vec3& up_B) {
  const LiquidSum liquids = liquid_sum(contents.tanks, up_B, body.center_of_mass_B, FreeSurfaces::kNo);
  return weights_of(contents.own, liquids, body.center_of_mass_B);
}

// Returns the potential energy of the body's weight, liquids included [J].
double weight_potential(const RigidBody& body, const RigidBodyState& state, const Water& water) {
  const double center_height = water.up_W.dot(state.center_W) - water.level;
  if (!body.contents) return body.mass * water.gravity * center_height;
  const Vec3 up_B = state.q_WB.conjugate() * water.up_W;
  const Weights weights = weights_at(body, *body.contents, up_B);
  return water.gravity * (weights.mass * center_height + up_B.dot(weights.moment));
}

// Calls add(volume, centroid_B) for the volume [m^3] that each open compartment takes from the displacement,
// and its centroid in B [m].
template <typename Add>
void for_each_flooded(const RigidBody& body, const Pose& pose, const Water& water, const Add& add) {
  if (!body.contents) return;
  for (const PlacedMesh& compartment : body.contents->compartments) {
    const HydrostaticMesh& mesh = *compartment.mesh;
    const Displacement displaced = hierarchical(mesh, water_plane_in_body(pose, water, mesh.center_B));
    if (!(displaced.volume > 0.0)) continue;
    add(-compartment.signed_permeability * displaced.volume,
        Vec3(mesh.center_B + displaced.moment / displaced.volume));
  }
}

}  // namespace

Expected<RigidBody> make_rigid_body(const Body& body, const Water& water, const BodyCondition* condition) {
  const DynamicsSpec& spec = body.dynamics;
  const Expected<RigidBodyMass> own = mass_of_body(body, water);
  if (!own) return make_error(own.error());
  RigidBody rigid;
  rigid.reference_B = body.reference_B;
  rigid.linear_damping = {spec.linear_damping, spec.linear_damping_quadratic};
  rigid.angular_damping = {spec.angular_damping, spec.angular_damping_quadratic};
  RigidBodyMass total = *own;
  if (body.subdivision != nullptr) {
    const Vec3 up_B = spec.orientation.normalized().conjugate() * water.up_W;
    total = mass_with_liquids(body, *own, condition, up_B);
    rigid.contents = {*own, tanks_of(body, condition), open_compartments(body, condition)};
  }
  if (!set_mass(total, rigid)) {
    return make_error({"body " + std::to_string(body.id) + " (" + body.name + ")",
                       "smallest principal inertia = " + format_number(rigid.principal_inertia.minCoeff(), 6),
                       "a positive definite inertia matrix (kg m^2)", "",
                       "Set or correct inertia in [body.client]"});
  }
  return rigid;
}

void set_condition(const Body& body, const BodyCondition& condition, const Water& water, RigidBody& rigid,
                   RigidBodyState& state) {
  BodyContents& contents = rigid.contents.value();
  contents.tanks = tanks_of(body, &condition);
  contents.compartments = open_compartments(body, &condition);
  const Vec3 w_W = angular_velocity_W(rigid, state);
  const Vec3 before_B = rigid.center_of_mass_B;
  set_mass(mass_with_liquids(body, contents.own, &condition, state.q_WB.conjugate() * water.up_W), rigid);
  const Vec3 moved_W = state.q_WB * Vec3(rigid.center_of_mass_B - before_B);
  state.center_W += moved_W;
  state.velocity_W += w_W.cross(moved_W);
  state.angular_momentum_W = angular_momentum_of(rigid, state.q_WB, w_W);
}

RigidBodyState initial_state(const RigidBody& body, const DynamicsSpec& spec) {
  RigidBodyState state;
  state.q_WB = spec.orientation.normalized();
  const Vec3 center_from_origin_W = state.q_WB * body.center_of_mass_B;
  state.center_W = spec.position + center_from_origin_W;
  state.velocity_W = spec.linear_velocity + spec.angular_velocity.cross(center_from_origin_W);
  state.angular_momentum_W = angular_momentum_of(body, state.q_WB, spec.angular_velocity);
  return state;
}

Vec3 angular_velocity_W(const RigidBody& body, const RigidBodyState& state) {
  const Vec3 momentum_P =
      body.principal_axes_B.transpose() * (state.q_WB.conjugate() * state.angular_momentum_W);
  return state.q_WB * Vec3(body.principal_axes_B * momentum_P.cwiseQuotient(body.principal_inertia));
}

Pose pose_of(const RigidBody& body, const RigidBodyState& state) {
  return {state.center_W - state.q_WB * body.center_of_mass_B, state.q_WB};
}

double lowest_height(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : mesh.surface.triangles) {
    for (const std::int32_t i : triangle) lowest = std::min(lowest, plane.height(mesh.vertex(i)));
  }
  return lowest;
}

BodyState to_body_state(std::int32_t body_id, const RigidBody& body, const RigidBodyState& state) {
  const Pose pose = pose_of(body, state);
  const Vec3 w_W = angular_velocity_W(body, state);
  BodyState message;
  message.body_id = body_id;
  message.position = to_array(pose.p_WB);
  message.quaternion_wxyz = {pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()};
  message.linear_velocity = to_array(state.velocity_W - w_W.cross(state.q_WB * body.center_of_mass_B));
  message.angular_velocity = to_array(w_W);
  return message;
}

Load total_load(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                const Water& water) {
  const Vec3 buoyancy_W = to_vec3(wrench.force);
  const Vec3 reference_from_center_W = state.q_WB * Vec3(body.reference_B - body.center_of_mass_B);
  const double weighed_mass = body.contents ? body.contents->own.mass : body.mass;
  Load load{buoyancy_W - weighed_mass * water.gravity * water.up_W,
            to_vec3(wrench.torque) + reference_from_center_W.cross(buoyancy_W)};
  if (body.contents) {
    const RigidBodyMass& own = body.contents->own;
    const Vec3 lever_W = state.q_WB * Vec3(own.center_of_mass_B - body.center_of_mass_B);
    load.torque_W -= own.mass * water.gravity * lever_W.cross(water.up_W);
  }
  return load;
}

double kinetic_energy(const RigidBody& body, const RigidBodyState& state) {
  return 0.5 * body.mass * state.velocity_W.squaredNorm() +
         0.5 * state.angular_momentum_W.dot(angular_velocity_W(body, state));
}

double flooded_volume(const RigidBody& body, const Pose& pose, const Water& water) {
  double sum = 0.0;
  for_each_flooded(body, pose, water, [&](double volume, const Vec3& /*centroid_B*/) { sum += volume; });
  return sum;
}

double mechanical_energy(const RigidBody& body, const RigidBodyState& state, const BodyWrench& wrench,
                         const Water& water) {
  const Vec3 center_of_buoyancy_W = pose_of(body, state).p_WB + to_vec3(wrench.center_of_buoyancy);
  const double buoyancy_height = water.up_W.dot(center_of_buoyancy_W) - water.level;
  return kinetic_energy(body, state) + weight_potential(body, state, water) -
         water.density * water.gravity * wrench.submerged_volume * buoyancy_height;
}

std::optional<double> mechanical_energy(const RigidBody& body, const RigidBodyState& state,
                                        const Solver& solver, const Water& water) {
  const Pose pose = pose_of(body, state);
  const Water surface{
      .up_W = water.up_W, .level = water.level, .density = water.density, .gravity = water.gravity};
  const BuoyancyResult result = buoyancy(solver, pose, surface, body.reference_B);
  if (result.status != BuoyancyStatus::kOk) return std::nullopt;
  BodyWrench wrench;
  wrench.submerged_volume = result.volume;
  wrench.center_of_buoyancy = to_array(result.center_of_buoyancy_W);
  double energy = mechanical_energy(body, state, wrench, surface);
  const auto add_flooded = [&](const Water& term) {
    for_each_flooded(body, pose, term, [&](double volume, const Vec3& centroid_B) {
      const double height = term.up_W.dot(pose.p_WB + pose.q_WB * centroid_B) - term.level;
      energy += term.density * term.gravity * volume * height;
    });
  };
  add_flooded(surface);
  for (std::size_t i = 0; i < water.layers.size(); ++i) {
    const Water term = water_of_step(water, i);
    const BuoyancyResult below = buoyancy(solver, pose, term, body.reference_B);
    if (below.status != BuoyancyStatus::kOk) return std::nullopt;
    const double height = term.up_W.dot(pose.p_WB + below.center_of_buoyancy_W) - term.level;
    energy -= term.density * term.gravity * below.volume * height;
    add_flooded(term);
  }
  return energy;
}

}  // namespace buoyancy
