#include "service/replay/replay_comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "service/replay/field_differences.h"

namespace buoyancy::service {
namespace {

bool same_id(const RequestId& a, const RequestId& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

// [m]. The centre is M/V with |dM| <= lever dV, and no farther from the reference point than the lever, which
// is torque bound / force bound; so its error is at most 2 lever dV / V. kAnyCenter if V does not exceed its
// error bound.
constexpr double kAnyCenter = 1e300;
double center_bound(const BodyWrench& wrench) {
  const double force = std::hypot(wrench.force[0], wrench.force[1], wrench.force[2]);
  if (!(force > wrench.force_error_bound)) return kAnyCenter;
  return 2.0 * wrench.torque_error_bound / force;
}

void compare(const BodyWrench& now, const BodyWrench& baseline, std::int64_t utime,
             BodyDifferences& differences) {
  ++differences.responses;
  if (now.status != baseline.status) ++differences.status_changes;
  const double force = distance(now.force, baseline.force);
  const double torque = distance(now.torque, baseline.torque);
  const double force_in_bounds = in_bounds(force, now.force_error_bound + baseline.force_error_bound);
  const double torque_in_bounds = in_bounds(torque, now.torque_error_bound + baseline.torque_error_bound);
  const double center = distance(now.center_of_buoyancy, baseline.center_of_buoyancy);
  const double center_in_bounds = in_bounds(center, center_bound(now) + center_bound(baseline));
  if (std::max({force_in_bounds, torque_in_bounds, center_in_bounds}) >
      std::max({differences.force_in_bounds, differences.torque_in_bounds, differences.center_in_bounds})) {
    differences.worst_utime = utime;
  }
  differences.center = std::max(differences.center, center);
  differences.center_in_bounds = std::max(differences.center_in_bounds, center_in_bounds);
  differences.force = std::max(differences.force, force);
  differences.torque = std::max(differences.torque, torque);
  differences.volume =
      std::max(differences.volume, distance(now.submerged_volume, baseline.submerged_volume));
  differences.force_in_bounds = std::max(differences.force_in_bounds, force_in_bounds);
  differences.torque_in_bounds = std::max(differences.torque_in_bounds, torque_in_bounds);
}

// Each result carries the rounding error of sums over the body's surface: proportional to the area, times one
// length per dimension of the field beyond an area. docs/replay.md lists the tolerances.
void compare(const BodyHydrostatics& now, const BodyHydrostatics& baseline, const Body& body,
             const Water& water, MessageDifferences& differences) {
  const HydrostaticMesh& mesh = body.solver.mesh();
  const double length = mesh.diagonal;
  const double area = kRounding * mesh.area;
  const double second_moment = 4.0 * area * length * length;
  const double volume = 2.0 * mesh.volume_tolerance() + area * length;
  const double point = kRounding * mesh.max_lever_arm(Vec3::Zero());
  const double smaller_volume = std::min(now.submerged_volume, baseline.submerged_volume);
  const double smaller_plane = std::min(now.waterplane_area, baseline.waterplane_area);
  const double center = 2.0 * volume * length / smaller_volume + point;

  FieldDifferences fields;
  fields.add("submerged_volume", now.submerged_volume, baseline.submerged_volume, volume);
  fields.add_if_defined("center_of_buoyancy", now.center_of_buoyancy, baseline.center_of_buoyancy, center);
  fields.add("wetted_area", now.wetted_area, baseline.wetted_area, area);
  fields.add("waterplane_area", now.waterplane_area, baseline.waterplane_area, area);
  fields.add_if_defined("waterplane_centroid", now.waterplane_centroid, baseline.waterplane_centroid,
                        2.0 * area * length / smaller_plane + point);
  const double gap = std::min(now.waterplane_second_moments[1] - now.waterplane_second_moments[0],
                              baseline.waterplane_second_moments[1] - baseline.waterplane_second_moments[0]);
  for (std::size_t i = 0; i < 2; ++i) {
    fields.add("waterplane_second_moments", now.waterplane_second_moments[i],
               baseline.waterplane_second_moments[i], second_moment);
    // The axes are arbitrary if both second moments are equal within their error.
    if (!(2.0 * second_moment >= gap)) {
      fields.add_axis("waterplane_axes", now.waterplane_axes[i], baseline.waterplane_axes[i],
                      2.0 * second_moment / gap + kRounding);
    } else if (!std::ranges::equal(now.waterplane_axes[i], baseline.waterplane_axes[i],
                                   [](double a, double b) { return std::isnan(a) == std::isnan(b); })) {
      fields.add("waterplane_axes", now.waterplane_axes[i], baseline.waterplane_axes[i], 0.0);
    }
    const double radius =
        (second_moment + std::max(now.metacentric_radii[i], baseline.metacentric_radii[i]) * volume) /
        smaller_volume;
    fields.add_if_defined("metacentric_radii", now.metacentric_radii[i], baseline.metacentric_radii[i],
                          radius);
    fields.add_if_defined("metacenters", now.metacenters[i], baseline.metacenters[i], center + radius);
    fields.add_if_defined("metacentric_heights", now.metacentric_heights[i], baseline.metacentric_heights[i],
                          center + radius);
  }
  const double lever = mesh.max_lever_arm(body.reference_B) + length;
  const double weight = water.density * water.gravity;  // N/m^3
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      double tolerance = weight * area;
      if ((row < 3) != (column < 3)) tolerance *= 2.0 * lever;
      if (row >= 3 && column >= 3) tolerance = weight * (4.0 * area * lever + 2.0 * volume) * lever;
      fields.add("stiffness", now.stiffness[row][column], baseline.stiffness[row][column], tolerance);
    }
  }
  fields.add_to(differences);
}

bool has_loads(const Scene& scene, std::int32_t id) {
  const Body* const body = scene.find(id);
  return body != nullptr && body->loads;
}

}  // namespace

Expected<ReplayComparison> ReplayComparison::open(const std::filesystem::path& baseline,
                                                  const OutputLayout& layout, const Scene& scene) {
  Expected<EventLogReader> responses = EventLogReader::open(baseline, only_channel(layout.wrenches_channel));
  if (!responses) return tl::unexpected(responses.error());
  Expected<EventLogReader> hydrostatics =
      EventLogReader::open(baseline, only_channel(layout.hydrostatics_channel));
  if (!hydrostatics) return tl::unexpected(hydrostatics.error());
  Expected<EventLogReader> loads = EventLogReader::open(baseline, only_channel(layout.loads_channel));
  if (!loads) return tl::unexpected(loads.error());
  return ReplayComparison(std::move(*responses), std::move(*hydrostatics), std::move(*loads), scene);
}

template <typename Message>
bool ReplayComparison::Channel<Message>::read_one() {
  while (true) {
    const LogItem item = baseline.next();
    if (std::holds_alternative<EndOfLog>(item)) return false;
    const auto* event = std::get_if<RecordedEvent>(&item);
    if (event == nullptr) {
      ++corrupt_sections;
      continue;
    }
    if (!decode(event->bytes, ahead.emplace_back())) return true;
    ahead.pop_back();
    ++invalid_messages;
  }
}

template <typename Message>
std::optional<Message> ReplayComparison::Channel<Message>::pop_counterpart() {
  for (std::size_t i = 0; i < kMatchWindow; ++i) {
    if (i == ahead.size() && !read_one()) break;
    if (!same_id(ahead[i].id, now.id)) continue;
    std::optional<Message> found = std::move(ahead[i]);
    unmatched_baseline += static_cast<std::int64_t>(i);
    ahead.erase(ahead.begin(), ahead.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return found;
  }
  ++unmatched_new;
  return std::nullopt;
}

template <typename Message>
void ReplayComparison::Channel<Message>::finish() {
  unmatched_baseline += static_cast<std::int64_t>(ahead.size());
  for (ahead.clear(); read_one(); ahead.clear()) ++unmatched_baseline;
}

// Calls compare_body for each body at the same index in both messages.
template <typename Message, typename CompareBody>
void ReplayComparison::add(Channel<Message>& channel, Bytes bytes, const CompareBody& compare_body) {
  [[maybe_unused]] const auto rejected = decode(bytes, channel.now);
  assert(!rejected);  // the handler encoded it
  const std::optional<Message> baseline = channel.pop_counterpart();
  if (!baseline) return;
  const auto& now = channel.now.bodies;
  const std::size_t both = std::min(now.size(), baseline->bodies.size());
  bool same_bodies = now.size() == baseline->bodies.size();
  for (std::size_t i = 0; i < both; ++i) {
    if (now[i].body_id == baseline->bodies[i].body_id) {
      compare_body(now[i], baseline->bodies[i], bodies_[now[i].body_id]);
    } else {
      same_bodies = false;
    }
  }
  if (same_bodies) return;
  ++channel.unmatched_new;
  ++channel.unmatched_baseline;
}

void ReplayComparison::add(Bytes response) {
  std::vector<BodyLimits> limits;
  add(responses_, response,
      [this, &limits](const BodyWrench& now, const BodyWrench& baseline, BodyDifferences& differences) {
        compare(now, baseline, responses_.now.id.utime, differences);
        if (has_loads(*scene_, now.body_id)) limits.push_back({now.body_id, limits_of(now, baseline)});
      });
  const auto& bodies = responses_.now.bodies;
  if (std::ranges::any_of(bodies, [this](const auto& body) { return has_loads(*scene_, body.body_id); })) {
    limits_.push_back(std::move(limits));
  }
}

void ReplayComparison::add_hydrostatics(Bytes hydrostatics) {
  add(hydrostatics_, hydrostatics,
      [this](const BodyHydrostatics& now, const BodyHydrostatics& baseline, BodyDifferences& differences) {
        const Body* const body = scene_->find(now.body_id);
        if (now.status != baseline.status) {
          ++differences.status_changes;
        } else if (now.status == BodyStatus::kOk && body != nullptr) {
          compare(now, baseline, *body, scene_->water(), differences.hydrostatics);
        }
      });
}

void ReplayComparison::add_loads(Bytes loads) {
  assert(!limits_.empty());  // of the message's response
  const std::vector<BodyLimits> limits = std::move(limits_.front());
  limits_.pop_front();
  auto next = limits.begin();
  add(loads_, loads,
      [this, &limits, &next](const BodyLoads& now, const BodyLoads& baseline, BodyDifferences& differences) {
        const Body* const body = scene_->find(now.body_id);
        next = std::find_if(next, limits.end(),
                            [&now](const BodyLimits& one) { return one.body_id == now.body_id; });
        if (next == limits.end()) return;  // the response has no counterpart, which counts already
        const WrenchLimits of_both = (next++)->limits;
        if (now.status != baseline.status) {
          ++differences.status_changes;
        } else if (now.status == BodyStatus::kOk && body != nullptr) {
          compare_loads(now, baseline, of_both, *body, *scene_, differences.loads);
        }
      });
}

void ReplayComparison::finish() {
  responses_.finish();
  hydrostatics_.finish();
  loads_.finish();
}

bool ReplayComparison::agrees() const {
  return unmatched_new() == 0 && unmatched_baseline() == 0 && decode_errors() == 0 &&
         std::ranges::all_of(bodies_, [](const auto& body) { return body.second.within_bounds(); });
}

}  // namespace buoyancy::service
