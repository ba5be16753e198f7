#include "scene/start_pose.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/format.h"
#include "scene/floating_bodies.h"

namespace buoyancy {
namespace {

constexpr double kNearVertical = 0.9;  // of |up . axis|

// Returns the body axis whose projection on the horizontal plane is the heading, before and after.
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
  reached.displaced = deepest_density(water) * floating.volume();
  reached.equilibrium = find_equilibrium_from(floating, water, body.dynamics.orientation, body.axes);
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

}  // namespace

Warning not_afloat(const Body& body, FlotationOutcome outcome, double mass, double displaced) {
  const bool has_liquids = body.subdivision != nullptr && !body.subdivision->tanks.empty();
  Warning warning;
  warning.actual = "a mass of " + format_number(mass, 6) + " kg";
  if (has_liquids) warning.actual += " with the liquids in its tanks";
  warning.expected = "less than the " + format_number(displaced, 6) + " kg of water that it can displace";
  switch (outcome) {
    case FlotationOutcome::kSinks:
      warning.cause = "the body sinks";
      warning.hint = "Reduce mass or density, or what is flooded and filled";
      break;
    case FlotationOutcome::kNeutral:
      warning.cause = "the body is neutrally buoyant: it rests at any depth";
      warning.hint = "Give it a position";
      break;
    case FlotationOutcome::kTakesInWater:
      warning.actual = "takes in water before it floats";
      warning.expected = "an open mesh whose boundary stays dry";
      warning.hint = "Reduce its mass, or close the mesh";
      break;
    case FlotationOutcome::kFloats:
    case FlotationOutcome::kOutOfRange:
      warning.actual = "no equilibrium found";
      warning.expected = "a body that floats";
      warning.cause = "masses or lengths beyond double's range";
      warning.hint = "Correct the mass, or the size of the mesh";
      break;
  }
  if (body.dynamics.start == StartKind::kEquilibrium) warning.hint += ", or start at a pose: remove start";
  return warning;
}

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
  if (reached == nullptr) return make_error(mass_of_body(body, scene_->water()).error());
  if (!reached->equilibrium) {
    Error error = not_afloat(body, reached->outcome, reached->mass, reached->displaced);
    error.subject = "body " + std::to_string(body.id) + " (" + body.name + "), start = \"equilibrium\"";
    return make_error(std::move(error));
  }
  const Pose pose = placed_pose(*reached->equilibrium, body.dynamics, scene_->water());
  start.position = pose.p_WB;
  start.orientation = pose.q_WB;
  return start;
}

const ReachedEquilibrium* StartFinder::reached_from_orientation(const Body& body) {
  const Expected<RigidBodyMass> own = mass_of_body(body, scene_->water());
  if (!own) return nullptr;
  BodyKey key = keys_.floating(body, *own);
  append_direction(body.dynamics.orientation.normalized().conjugate() * scene_->water().up_W, key);
  append_direction(body.axes.up_B, key);
  const auto [found, is_new] = known_.try_emplace(std::move(key));
  if (is_new) {
    const Expected<FloatingBody> floating = floating_body_of(body, meshes_.of(*body.prepared_mesh), *own);
    if (floating) found->second = reached_by(body, *floating, scene_->water());
  }
  return &found->second;
}

}  // namespace buoyancy
