#include "scene/body_flotation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "base/angles.h"
#include "base/format.h"
#include "flotation/submerged.h"
#include "scene/body_key.h"
#include "scene/body_warning_list.h"
#include "scene/floating_bodies.h"
#include "scene/floating_pose.h"
#include "scene/start_pose.h"

namespace buoyancy {
namespace {

constexpr double kStays = 1e-3;     // [rad]: a smaller turn counts as none
constexpr double kSameTurn = 1e-4;  // [rad], between an attitude and the same one found from another start
constexpr std::size_t kMinVertices = 2'000;  // a smaller mesh counts as this many: a search has a fixed cost

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 up_B_of(const Equilibrium& equilibrium, const Water& water) {
  return equilibrium.pose.q_WB.conjugate() * water.up_W;
}

// Is the body in balance at this attitude, at the draft at which it displaces its mass?
bool is_balanced(const FloatingBody& body, const Eigen::Quaterniond& q_WB, const Water& water) {
  if (body.is_open()) return false;
  const std::optional<FloatingPose> afloat = find_floating_pose(body, q_WB, water);
  const double weight = body.total_mass() * water.gravity;
  return afloat && afloat->state.torque_W.norm() <= kNoLever * weight * body.reach();
}

// Inserts the equilibrium that the body reaches into its attitudes, by energy, and returns its index. It
// replaces the same attitude found from another start, or the first member of the same family.
std::size_t merge_reached(const Equilibrium& reached, const Water& water,
                          std::vector<Equilibrium>& attitudes) {
  const Vec3 up_B = up_B_of(reached, water);
  const double energy = reached.state.energy;
  const auto is_same = [&](const Equilibrium& other) {
    if (angle_between(up_B_of(other, water), up_B) <= kSameTurn) return true;
    return other.family != AttitudeFamily::kNone && other.family == reached.family &&
           std::abs(other.state.energy - energy) <= kFlatSphere * std::abs(energy);
  };
  const auto same = std::ranges::find_if(attitudes, is_same);
  if (same != attitudes.end()) {
    *same = reached;
    return static_cast<std::size_t>(same - attitudes.begin());
  }
  const auto place = std::ranges::upper_bound(attitudes, energy, {},
                                              [](const Equilibrium& other) { return other.state.energy; });
  return static_cast<std::size_t>(attitudes.insert(place, reached) - attitudes.begin());
}

BodyFlotation flotation_of(const Body& body, const FloatingBody& floating, const ReachedEquilibrium& reached,
                           const Water& water) {
  BodyFlotation flotation;
  flotation.outcome = reached.outcome;
  flotation.mass = reached.mass;
  flotation.displaced = reached.displaced;
  if (reached.outcome == FlotationOutcome::kSinks || reached.outcome == FlotationOutcome::kNeutral) {
    return flotation;
  }
  Equilibria all = find_equilibria(floating, water, {.axes = body.axes});
  flotation.outcome = all.outcome;
  flotation.attitudes = std::move(all.attitudes);
  flotation.is_truncated = all.is_truncated;
  if (!reached.equilibrium) return flotation;
  flotation.outcome = FlotationOutcome::kFloats;
  flotation.reached = merge_reached(*reached.equilibrium, water, flotation.attitudes);
  if (reached.equilibrium->family == AttitudeFamily::kSphere) return flotation;  // it keeps any attitude
  const Eigen::Quaterniond q_WB = body.dynamics.orientation.normalized();
  flotation.turn = angle_between(q_WB.conjugate() * water.up_W, up_B_of(*reached.equilibrium, water));
  flotation.starts_unstable = flotation.turn > kStays && is_balanced(floating, q_WB, water);
  return flotation;
}

void add_warnings(const Body& body, const BodyFlotation& flotation, BodyWarningList& list) {
  const FlotationOutcome outcome = flotation.outcome;
  if (outcome != FlotationOutcome::kFloats) {
    const bool is_lost = outcome == FlotationOutcome::kSinks || outcome == FlotationOutcome::kTakesInWater;
    if (is_lost || body.dynamics.start == StartKind::kEquilibrium)
      list.add(body, not_afloat(body, outcome, flotation.mass, flotation.displaced));
    return;
  }
  if (!flotation.reached && body.prepared_mesh->mesh.is_open() && !flotation.attitudes.empty()) {
    list.add(body,
             {"", "takes in water on the way from its orientation to where it floats",
              "an open mesh whose boundary stays dry", "an orientation far from those at which it floats",
              "Start near one of the attitudes that --check lists"});
  }
  const std::string degrees = format_number(flotation.turn * kDegreesPerRadian, 4) + " degrees";
  if (flotation.turn > 0.5 * std::numbers::pi) {
    list.add(
        body,
        {"", "turns by " + degrees + " from its orientation until it floats at rest", "at most 90 degrees",
         "the body capsizes: its centre of mass is too high, or its axes are not those of the mesh",
         "Lower center_of_mass, or set orientation to that of an attitude that --check lists"});
  } else if (flotation.starts_unstable && body.dynamics.start == StartKind::kPose) {
    list.add(body, {"", "at its orientation it is in balance but not stable, and turns by " + degrees,
                    "an orientation that it keeps or leaves at once",
                    "a negative metacentric height: it may stay there until something disturbs it",
                    "Lower center_of_mass, or set start = \"equilibrium\""});
  }
}

}  // namespace

std::vector<FlotationOfBody> scene_flotation(const Scene& scene, std::size_t max_vertices) {
  const BodyKeys keys(scene);
  StartFinder starts(scene);
  MeshesWithTrees meshes;
  std::map<BodyKey, std::shared_ptr<const BodyFlotation>> known;
  std::vector<FlotationOfBody> bodies;
  std::size_t vertices = 0;
  for (const Body& body : scene.bodies()) {
    FlotationOfBody& entry = bodies.emplace_back();
    const Expected<RigidBodyMass> own = mass_of_body(body, scene.water());
    if (!body.dynamics.given || !own) continue;
    BodyKey key = keys.floating(body, *own);
    append_direction(body.dynamics.orientation.normalized().conjugate() * scene.water().up_W, key);
    append_direction(body.axes.up_B, key);
    auto found = known.find(key);
    if (found == known.end()) {
      const std::size_t more = std::max(body.prepared_mesh->mesh.surface.x.size(), kMinVertices);
      entry.left_out = vertices + more > max_vertices && !known.empty();
      if (entry.left_out) continue;
      vertices += more;
      const Expected<FloatingBody> floating = floating_body_of(body, meshes.of(*body.prepared_mesh), *own);
      std::shared_ptr<const BodyFlotation> computed;
      if (floating) {
        computed = std::make_shared<const BodyFlotation>(
            flotation_of(body, *floating, *starts.reached_from_orientation(body), scene.water()));
      }
      found = known.emplace(std::move(key), std::move(computed)).first;
    }
    entry.flotation = found->second;
  }
  return bodies;
}

std::vector<Warning> flotation_warnings(const Scene& scene, const std::vector<FlotationOfBody>& flotation) {
  BodyWarningList list;
  for (std::size_t i = 0; i < flotation.size(); ++i) {
    const Body& body = scene.bodies()[i];
    if (flotation[i].flotation) add_warnings(body, *flotation[i].flotation, list);
    if (flotation[i].flotation || flotation[i].left_out || !body.dynamics.given) continue;
    Expected<RigidBodyMass> mass = mass_of_body(body, scene.water());
    if (mass) continue;
    mass.error().subject.clear();
    list.add(body, std::move(mass.error()));
  }
  return list.with_subjects(scene.name());
}

}  // namespace buoyancy
