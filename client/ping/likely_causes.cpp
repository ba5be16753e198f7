#include "client/ping/likely_causes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/format.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/level_search.h"
#include "messages/conversions.h"

namespace buoyancy::ping {
namespace {

// Relative difference up to which values inferred from two samples count as equal: too small for values that
// agree by chance within a scene's tolerance, too large to be exceeded by rounding.
constexpr double kSame = 1e-6;

using Samples = std::vector<const DifferingWrench*>;

double volume_of(const DifferingWrench& sample) {
  return sample.body->solver.mesh().volume;
}

// Is the body fully submerged according to the expected wrench?
bool is_submerged(const DifferingWrench& sample) {
  return std::abs(sample.expected.submerged_volume - volume_of(sample)) <= kSame * volume_of(sample);
}

// Returns the value that all samples share within kSame * scale; nullopt: they disagree, or none has a value.
// Samples for which `value` returns nullopt are left out.
template <typename Value>
std::optional<double> common_value(const Samples& samples, double scale, const Value& value) {
  std::optional<double> common;
  for (const DifferingWrench* sample : samples) {
    const std::optional<double> now = value(*sample);
    if (!now) continue;
    if (common && !(std::abs(*now - *common) <= kSame * scale)) return std::nullopt;
    if (!common) common = now;
  }
  return common;
}

template <typename Predicate>
Samples select(const Samples& samples, const Predicate& predicate) {
  Samples selected;
  std::ranges::copy_if(samples, std::back_inserter(selected),
                       [&](const DifferingWrench* sample) { return predicate(*sample); });
  return selected;
}

std::string list_bodies(const Samples& samples) {
  constexpr std::size_t kMaxShown = 5;
  std::set<std::int32_t> ids;
  for (const DifferingWrench* sample : samples) ids.insert(sample->body->id);
  std::string text = ids.size() == 1 ? "body" : "bodies";
  std::size_t shown = 0;
  for (const std::int32_t id : ids) {
    if (shown++ == kMaxShown) {
      text += " and others";
      break;
    }
    text += shown == 1 ? " " : ", ";
    text += std::to_string(id);
  }
  return text;
}

void add_status_causes(const Samples& samples, std::vector<std::string>& causes) {
  const auto with = [&samples](BodyStatus status) {
    return select(samples, [status](const DifferingWrench& sample) {
      return sample.received.status == status && sample.expected.status != status;
    });
  };
  if (const Samples unknown = with(BodyStatus::kUnknownBody); !unknown.empty()) {
    causes.push_back("the service has another scene file: its scene has no " + list_bodies(unknown));
  }
  if (!with(BodyStatus::kNoSea).empty()) {
    causes.emplace_back(
        "the service's scene says waves = \"received\", and it has received no sea for the time of the "
        "requests");
  }
  if (const Samples bad = with(BodyStatus::kBadCondition); !bad.empty()) {
    causes.push_back("the service has received a condition of a compartment or tank that it cannot use, of " +
                     list_bodies(bad));
  }
  const Samples open = select(samples, [](const DifferingWrench& sample) {
    return (sample.expected.status == BodyStatus::kOpenEdgeWet) !=
           (sample.received.status == BodyStatus::kOpenEdgeWet);
  });
  if (!open.empty()) {
    causes.push_back("the service has another mesh or level for " + list_bodies(open) +
                     ": an open edge is wet on one side only");
  }
}

// In water at rest a wrench differs by a multiple of up that is proportional to the displaced volume. Returns
// the service's density times gravity over the scene's.
std::optional<double> weight_ratio(const Scene& scene, const Samples& samples) {
  const Water& water = scene.water();
  const double weight = water.density * water.gravity;
  // In layered water the force is not proportional to the volume.
  if (!(weight > 0.0) || !water.layers.empty()) return std::nullopt;
  bool along_up = true;
  const std::optional<double> ratio =
      common_value(samples, 1.0, [&](const DifferingWrench& sample) -> std::optional<double> {
        const double force = weight * sample.expected.submerged_volume;
        if (!(force > kSame * weight * volume_of(sample))) return std::nullopt;
        const Vec3 more_W = to_vec3(sample.received.force) - to_vec3(sample.expected.force);
        const double along = water.up_W.dot(more_W);
        along_up = along_up && (more_W - along * water.up_W).norm() <= kSame * force;
        return 1.0 + along / force;
      });
  return along_up ? ratio : std::nullopt;
}

// In waves the load is proportional to density times gravity. Returns the service's product over the scene's.
std::optional<double> force_ratio(const Samples& samples) {
  return common_value(samples, 1.0, [](const DifferingWrench& sample) -> std::optional<double> {
    const Vec3 expected_W = to_vec3(sample.expected.force);
    if (!(expected_W.norm() > 0.0)) return std::nullopt;
    return to_vec3(sample.received.force).dot(expected_W) / expected_W.squaredNorm();
  });
}

std::string describe_weight(const Water& water, double ratio) {
  return format_text(
      "the service has another density or gravity: their product is {:6} times that of this scene, as with a "
      "density of {:6} instead of {:6} kg/m^3, or a gravity of {:6} instead of {:6} m/s^2",
      ratio, ratio * water.density, water.density, ratio * water.gravity, water.gravity);
}

// Returns the common direction of all forces that are buoyancy alone; nullopt: they differ in direction, or
// it is the scene's up.
std::optional<Vec3> other_up(const Scene& scene, const Samples& samples) {
  std::optional<Vec3> up_W;
  for (const DifferingWrench* sample : samples) {
    const Vec3 force_W = to_vec3(sample->received.force);
    if (!(sample->received.submerged_volume > kSame * volume_of(*sample)) || !(force_W.norm() > 0.0))
      continue;
    const Vec3 direction_W = force_W.normalized();
    if (up_W && (direction_W - *up_W).norm() > kSame) return std::nullopt;
    if (!up_W) up_W = direction_W;
  }
  if (up_W && (*up_W - scene.water().up_W).norm() <= kSame) return std::nullopt;
  return up_W;
}

// Does the force on a body without drag and added mass have a horizontal part?
bool is_inclined(const Scene& scene, const DifferingWrench& sample) {
  if (sample.body->hydrodynamics != nullptr) return false;
  const Vec3 force_W = to_vec3(sample.received.force);
  const Vec3& up_W = scene.water().up_W;
  const Vec3 horizontal_W = force_W - up_W.dot(force_W) * up_W;
  return horizontal_W.norm() > kSame * force_W.norm() + sample.received.force_error_bound;
}

// Returns the level [m] at which the body displaces the volume that was received.
double level_of(const Scene& scene, const DifferingWrench& sample) {
  constexpr int kMaxRounds = 60;
  const ValidatedPose validated = validate_pose(sample.state, 0.0);
  Water water = scene.water();
  const HydrostaticMesh& mesh = sample.body->solver.mesh();
  const double reach = 2.0 * mesh.diagonal;
  // The surface cuts the body, which has a vertex within its diagonal of its box's centre.
  const Vec3 center_W = to_vec3(sample.received.center_of_buoyancy) + to_vec3(sample.state.position);
  water.level = water.up_W.dot(center_W);
  LevelSearch search(water.level - reach, water.level + reach, 0.0);
  for (int round = 0; round < kMaxRounds && !search.is_narrow(); ++round) {
    const BuoyancyResult now = buoyancy(sample.body->solver, validated.pose, water, sample.body->reference_B);
    const double excess = now.volume - sample.received.submerged_volume;
    search.add(water.level, excess, excess);
    if (std::abs(excess) <= mesh.volume_tolerance()) break;
    water.level = search.next(search.is_slow(2));
  }
  return water.level;
}

// Returns the level [m] that explains the volumes of all surface-piercing samples; nullopt: there is none.
std::optional<double> other_level(const Scene& scene, const Samples& samples) {
  constexpr double kLeast = 1e-3;  // of the volume, above and below the water, so that the level is accurate
  constexpr std::size_t kEnough = 8;
  std::optional<double> level;
  std::size_t used = 0;
  for (const DifferingWrench* sample : samples) {
    const double fraction = sample->received.submerged_volume / volume_of(*sample);
    if (!(fraction > kLeast && fraction < 1.0 - kLeast)) continue;
    const double now = level_of(scene, *sample);
    const double error = (kSame + sample->body->solver.tolerance()) * sample->body->solver.mesh().diagonal;
    if (level && !(std::abs(now - *level) <= 10.0 * error)) return std::nullopt;
    if (!level) level = now;
    if (++used == kEnough) break;
  }
  constexpr std::size_t kFewest = 2;
  return used >= kFewest ? level : std::nullopt;
}

void add_mesh_causes(const Samples& submerged, std::vector<std::string>& causes) {
  constexpr std::size_t kMaxShown = 3;
  std::set<const Body*> bodies;
  for (const DifferingWrench* sample : submerged) bodies.insert(sample->body);
  std::vector<const Body*> by_id(bodies.begin(), bodies.end());
  std::ranges::sort(by_id, {}, &Body::id);
  for (std::size_t i = 0; i < std::min(kMaxShown, by_id.size()); ++i) {
    const Body& body = *by_id[i];
    const double volume = body.solver.mesh().volume;
    const std::optional<double> other =
        common_value(submerged, volume, [&](const DifferingWrench& sample) -> std::optional<double> {
          if (sample.body != &body) return std::nullopt;
          return sample.received.submerged_volume;
        });
    std::string cause = format_text("the service has another mesh, shape or scale for body {}", body.id);
    if (other && *other > 0.0) {
      cause += format_text(": fully submerged it displaces {:6} m^3 instead of {:6} m^3", *other, volume);
    } else {
      cause += ", or another level or up: where it is fully submerged here, it is not there";
    }
    causes.push_back(std::move(cause));
  }
}

void add_volume_causes(const Scene& scene, const Samples& samples, std::vector<std::string>& causes) {
  const Samples differing =
      select(samples, [](const DifferingWrench& sample) { return sample.volume_differs; });
  if (differing.empty()) return;
  const bool at_rest = scene.sea() == nullptr && !scene.receives_sea();
  if (at_rest && std::ranges::any_of(
                     differing, [&](const DifferingWrench* sample) { return is_inclined(scene, *sample); })) {
    causes.push_back("the service has waves, and this scene has none: volumes differ, and forces on " +
                     list_bodies(differing) + " have horizontal parts");
    return;
  }
  if (at_rest) {
    if (const std::optional<double> level = other_level(scene, differing)) {
      causes.push_back(format_text(
          "the service has another water level: {:6} m instead of {:6} m would give the volumes that it "
          "computes",
          *level, scene.water().level));
      return;
    }
  }
  const Samples submerged = select(differing, is_submerged);
  if (!submerged.empty()) return add_mesh_causes(submerged, causes);
  causes.push_back(
      at_rest ? "the surface of the service's water is elsewhere, or its meshes differ: another level, up, "
                "waves, or a mesh of the same volume (" +
                    list_bodies(differing) + ")"
              : "the surface of the service's water is elsewhere: other waves, another time_origin, depth, "
                "level or no waves (" +
                    list_bodies(differing) + ")");
}

void add_force_causes(const Scene& scene, const ResponseChecks& checks, const Samples& samples,
                      std::vector<std::string>& causes) {
  const bool any_volume =
      std::ranges::any_of(samples, [](const DifferingWrench* sample) { return sample->volume_differs; });
  const Samples forces = select(
      samples, [](const DifferingWrench& sample) { return sample.force_differs && !sample.volume_differs; });
  if (forces.empty()) return;
  const bool at_rest = scene.sea() == nullptr && !scene.receives_sea();
  if (checks.only_motion_loads_differ()) {
    causes.push_back("the service has other drag, added mass or current: its buoyancy agrees (" +
                     list_bodies(forces) + ")");
    return;
  }
  // Forces on bodies with drag or added mass may differ for other reasons as well.
  const auto moves_matter = [](const DifferingWrench& sample) {
    return sample.body->hydrodynamics != nullptr;
  };
  const Samples moving = select(forces, moves_matter);
  const Samples buoyancy_alone =
      select(forces, [&](const DifferingWrench& sample) { return !moves_matter(sample); });
  for (const Samples* const alike : {&forces, &buoyancy_alone}) {
    const std::optional<double> ratio = at_rest ? weight_ratio(scene, *alike) : force_ratio(*alike);
    if (!ratio || std::abs(*ratio - 1.0) <= kSame) continue;
    causes.push_back(describe_weight(scene.water(), *ratio));
    if (alike == &forces || moving.empty()) return;
    causes.push_back("and, unless that is all, other drag, added mass or current for " + list_bodies(moving));
    return;
  }
  if (any_volume) return;  // what moves the surface changes the forces as well
  causes.push_back(!moving.empty()
                       ? "the service has other drag, added mass or current for " + list_bodies(moving) +
                             ": volumes agree, and forces differ with the motion"
                       : "the service has drag, added mass, a current or waves that this scene lacks for " +
                             list_bodies(forces) + ": volumes agree and forces do not");
}

}  // namespace

std::vector<std::string> causes_of_differences(const Scene& scene, const ResponseChecks& checks) {
  std::vector<std::string> causes;
  Samples all;
  for (const DifferingWrench& sample : checks.differing()) all.push_back(&sample);
  add_status_causes(all, causes);
  const Samples both_ok = select(all, [](const DifferingWrench& sample) {
    return sample.expected.status == BodyStatus::kOk && sample.received.status == BodyStatus::kOk;
  });
  const bool at_rest = scene.sea() == nullptr && !scene.receives_sea();
  if (at_rest && scene.bodies_with_hydrodynamics() == 0) {
    if (const std::optional<Vec3> up_W = other_up(scene, both_ok)) {
      causes.push_back("the service has another up: its forces point along (" + format_vector(*up_W, 6) +
                       ") instead of (" + format_vector(scene.water().up_W, 6) + ")");
      return causes;
    }
  }
  add_volume_causes(scene, both_ok, causes);
  add_force_causes(scene, checks, both_ok, causes);
  const Samples torques = select(both_ok, [](const DifferingWrench& sample) {
    return sample.torque_differs && !sample.force_differs && !sample.volume_differs;
  });
  const Samples centers =
      select(torques, [](const DifferingWrench& sample) { return sample.center_differs; });
  if (!centers.empty()) {
    causes.push_back("the service has another mesh for " + list_bodies(centers) +
                     ", of the same volume: its centre of buoyancy is elsewhere");
  } else if (!torques.empty()) {
    causes.push_back("the service has another reference_point for " + list_bodies(torques) +
                     ": forces, volumes and centres agree, and torques do not");
  }
  return causes;
}

}  // namespace buoyancy::ping
