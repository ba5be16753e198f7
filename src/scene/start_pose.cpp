#include "scene/start_pose.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/format.h"
#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

constexpr double kNearVertical = 0.9;  // of |up . axis|

// The horizontal direction by which a heading is compared before and after.
Vec3 heading_axis_B(const Vec3& up_before_B, const Vec3& up_after_B) {
  for (int i = 0; i < 2; ++i) {
    if (std::abs(up_before_B[i]) <= kNearVertical && std::abs(up_after_B[i]) <= kNearVertical) {
      return Vec3::Unit(i);
    }
  }
  return Vec3::UnitZ();
}

ReachedEquilibrium reached_by(const Body& body, const FloatingBody& floating, const Water& water) {
  ReachedEquilibrium reached;
  reached.mass = floating.total_mass();
  reached.displaced = water.density * floating.volume();
  reached.equilibrium = find_equilibrium_from(floating, water, body.dynamics.orientation);
  if (reached.equilibrium) {
    reached.outcome = FlotationOutcome::kFloats;
  } else if (floating.is_open()) {
    reached.outcome = FlotationOutcome::kTakesInWater;
  } else if (const FlotationOutcome by_mass = outcome_by_mass(floating, water);
             by_mass != FlotationOutcome::kFloats) {
    reached.outcome = by_mass;
  }
  return reached;
}

Error start_error(const Body& body, const ReachedEquilibrium* reached) {
  Error error;
  error.subject = "body " + std::to_string(body.id) + " (" + body.name + "), start = \"equilibrium\"";
  error.hint = "Start it at a pose: remove start";
  if (reached == nullptr) {
    error.actual = "no mass";
    error.expected = "a mass above 0 in [body.client]";
    error.cause = "an open mesh needs mass, center_of_mass and inertia";
    return error;
  }
  const bool has_liquids = body.subdivision != nullptr && !body.subdivision->tanks.empty();
  error.actual = "a mass of " + format_number(reached->mass) + " kg";
  if (has_liquids) error.actual += " with the liquids in its tanks";
  error.expected = "less than the " + format_number(reached->displaced) + " kg of water that it can displace";
  switch (reached->outcome) {
    case FlotationOutcome::kSinks:
      error.cause = "the body sinks";
      error.hint = "Reduce mass or density, or start at a pose: remove start";
      break;
    case FlotationOutcome::kNeutral:
      error.cause = "the body is neutrally buoyant: it rests at any depth";
      error.hint = "Give it a position, and remove start";
      break;
    case FlotationOutcome::kTakesInWater:
      error.actual = "no attitude at which it floats with a dry boundary";
      error.expected = "an open mesh whose boundary stays dry";
      error.cause = "the body takes in water, from its orientation on";
      error.hint = "Reduce its mass, or close the mesh";
      break;
    case FlotationOutcome::kFloats:
    case FlotationOutcome::kOutOfRange:
      error.actual = "no equilibrium found";
      error.expected = "a body that floats";
      error.cause = "masses or lengths beyond double's range";
      break;
  }
  return error;
}

}  // namespace

Pose placed_pose(const Equilibrium& equilibrium, const DynamicsSpec& dynamics, const Water& water) {
  const Vec3& up_W = water.up_W;
  const Eigen::Quaterniond before = dynamics.orientation.normalized();
  const Eigen::Quaterniond& after = equilibrium.pose.q_WB;
  const Vec3 axis_B = heading_axis_B(before.conjugate() * up_W, after.conjugate() * up_W);
  const Vec3 from_W = after * axis_B;
  const Vec3 to_W = before * axis_B;
  // The horizontal parts turn into one another about up.
  const double sine = up_W.dot(from_W.cross(to_W));
  const double cosine = from_W.dot(to_W) - up_W.dot(from_W) * up_W.dot(to_W);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(std::atan2(sine, cosine), up_W));
  const Vec3 horizontal_W = dynamics.position - up_W.dot(dynamics.position) * up_W;
  return {horizontal_W + equilibrium.pose.p_WB, (turn * after).normalized()};
}

Expected<DynamicsSpec> StartFinder::start_of(const Body& body) {
  DynamicsSpec start = body.dynamics;
  if (start.start != StartKind::kEquilibrium) return start;
  const ReachedEquilibrium* reached = reached_from_orientation(body);
  if (reached == nullptr || !reached->equilibrium) return make_error(start_error(body, reached));
  const Pose pose = placed_pose(*reached->equilibrium, body.dynamics, scene_->water());
  start.position = pose.p_WB;
  start.orientation = pose.q_WB;
  return start;
}

const ReachedEquilibrium* StartFinder::reached_from_orientation(const Body& body) {
  const std::optional<BodyMass> own = mass_of_body(body, scene_->water());
  if (!own) return nullptr;
  BodyKey key = keys_.floating(body, *own);
  append_direction(body.dynamics.orientation.normalized().conjugate() * scene_->water().up_W, key);
  const auto [found, is_new] = known_.try_emplace(std::move(key));
  if (is_new) {
    const Expected<FloatingBody> floating = floating_body_of(body, meshes_.of(*body.prepared_mesh), *own);
    if (floating) found->second = reached_by(body, *floating, scene_->water());
  }
  return &found->second;
}

}  // namespace buoyancy
