#include "view/report/run_builder.h"

#include <algorithm>
#include <cmath>

#include "engine/state_evaluation.h"
#include "messages/conversions.h"
#include "view/common/scene_model.h"
#include "view/common/sea_json.h"
#include "view/report/row_evaluation.h"

namespace buoyancy::view {
namespace {

constexpr std::size_t kMaxRowsOfBody = 12'000;
constexpr std::size_t kMaxWarnings = 20;
constexpr std::size_t kMaxSessionsCounted = 10'000;
constexpr std::size_t kMaxClocks = 8;
constexpr std::int64_t kMaxReordering = 1'000'000;      // [us]; a larger step back is a clock restart
constexpr std::int64_t kMaxGap = 86'400 * 1'000'000LL;  // [us]; a larger step forward is another clock

// A file may contain any utime, so sums and differences wrap.
std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

// Returns offset if min_ahead <= utime + offset - latest <= kMaxGap; else the offset that maps utime to
// fallback.
std::int64_t choose_offset(std::int64_t utime, std::int64_t offset, std::int64_t latest,
                           std::int64_t min_ahead, std::int64_t fallback) {
  const std::int64_t ahead = wrapped_difference(wrapped_sum(utime, offset), latest);
  const bool fits = ahead >= min_ahead && ahead <= kMaxGap;
  return fits ? offset : wrapped_difference(fallback, utime);
}

MeshUp mesh_up_of(const Body& body) {
  const std::string& axis = body.prepared_mesh->report.source.up_axis;
  return axis == "y" ? MeshUp::kY : axis == "x" ? MeshUp::kX : MeshUp::kZ;
}

// The pose as recorded: an invalid one is a row too, shown with the values it has.
Pose raw_pose(const BodyState& state) {
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  const Eigen::Quaterniond q(w, x, y, z);
  return {to_vec3(state.position), q.norm() > 0.0 ? q : Eigen::Quaterniond::Identity()};
}

std::size_t bytes_of(const DrawnSurface& drawn) {
  std::size_t bytes = 0;
  for (const Json& part : drawn.sea.at("surface").at("parts"))
    bytes += part.at("coefficients").get_ref<const std::string&>().size();
  return bytes;
}

// motion: nullopt for a body without drag and added mass. solver: of the body.
double energy_of(const RigidBody& rigid, const std::optional<HydrodynamicMotion>& motion,
                 const RecordedState& recorded, const BodyWrench& wrench, const Solver& solver,
                 const Water& water) {
  const Pose pose = raw_pose(recorded.state);
  DynamicsSpec spec;
  spec.position = pose.p_WB;
  spec.orientation = pose.q_WB.normalized();
  spec.linear_velocity = to_vec3(recorded.state.linear_velocity);
  spec.angular_velocity = to_vec3(recorded.state.angular_velocity);
  const RigidBodyState state = initial_state(rigid, spec);
  const double added = motion ? motion->added_kinetic_energy_at_pose(state).value_or(kUnknown) : 0.0;
  if (!water.layers.empty()) {
    return mechanical_energy(rigid, state, solver, water).value_or(kUnknown) + added;
  }
  return mechanical_energy(rigid, state, wrench, water) + added;
}

template <std::size_t kSize>
void put(RunRow& row, RunColumn first, const std::array<double, kSize>& values) {
  std::ranges::copy(values, row.begin() + static_cast<std::ptrdiff_t>(first));
}

void count_row(BodyRun& body, BodyStatus status, double force) {
  ++body.recorded;
  const auto value = static_cast<std::size_t>(static_cast<std::uint32_t>(status));
  ++body.statuses[std::min<std::size_t>(value, kBodyStatusCount)];
  if (status == BodyStatus::kOk && !(force <= body.max_force) && std::isfinite(force)) body.max_force = force;
}

// Counts a row of a body that is not shown, without computing anything.
void summarize(BodyRun& body, const RecordedState& recorded, const ValidatedPose& pose) {
  if (recorded.wrench) {
    count_row(body, recorded.wrench->status, to_vec3(recorded.wrench->force).norm());
  } else if (pose.status != BodyStatus::kOk) {
    count_row(body, pose.status, 0.0);
  } else if (recorded.force_torque) {
    count_row(body, BodyStatus::kOk, to_vec3(recorded.force_torque->force).norm());
  } else {
    ++body.recorded;
  }
}

}  // namespace

RunBuilder::RunBuilder(const Scene& scene, std::size_t max_rows, const std::vector<std::size_t>& selected)
    : scene_(scene), water_(scene), conditions_(scene) {
  const std::size_t max_shown =
      selected.empty() ? std::min(scene.bodies().size(), kMaxBodies) : selected.size();
  max_rows_of_body_ = std::min(max_rows / max_shown, kMaxRowsOfBody);
  run_.bodies.resize(scene.bodies().size());
  bodies_.resize(scene.bodies().size());
  free_places_ = max_shown;
  for (const std::size_t index : selected) show(index);
}

RunBuilder::ShownBody* RunBuilder::show(std::size_t index) {
  if (bodies_[index] != nullptr || free_places_ == 0) return bodies_[index].get();
  --free_places_;
  const Body& body = scene_.bodies()[index];
  bodies_[index] = std::make_unique<ShownBody>(max_rows_of_body_);
  bodies_[index]->mesh_up = mesh_up_of(body);
  run_.bodies[index].shown = true;
  if (body.dynamics.given) make_rigid(body, nullptr, *bodies_[index]);
  return bodies_[index].get();
}

void RunBuilder::make_rigid(const Body& body, const std::shared_ptr<const BodyCondition>& condition,
                            ShownBody& shown) {
  shown.condition = condition;
  Expected<RigidBody> rigid = make_rigid_body(body, scene_.water(), condition.get());
  if (!rigid) return;
  shown.rigid = *std::move(rigid);
  if (body.hydrodynamics != nullptr) {
    shown.motion.emplace(body, *shown.rigid, scene_.water(), scene_.current());
  }
}

std::int64_t RunBuilder::time_of(std::int32_t body_id, std::int64_t session_id, std::int64_t utime) {
  const std::optional<std::size_t> index = scene_.index_of(body_id);
  if (!index) return 0;
  if (sessions_.size() < kMaxSessionsCounted) sessions_.insert(session_id);
  ShownBody* const shown = show(*index);
  if (shown == nullptr) return 0;
  ShownBody& body = *shown;
  if (!first_utime_) first_utime_ = utime;

  const std::int64_t next_time = wrapped_sum(body.last_time, body.last_step);
  auto clock = std::ranges::find(body.clocks, session_id, &SessionClock::session_id);
  if (clock != body.clocks.end()) {
    clock->offset = choose_offset(utime, clock->offset, clock->latest, -kMaxReordering, next_time);
  } else {
    // The first state of another body may be older than the latest of all.
    const std::int64_t offset =
        body.clocks.empty()
            ? choose_offset(utime, wrapped_difference(0, *first_utime_), latest_, -kMaxGap, latest_)
            : choose_offset(utime, body.clocks.front().offset, body.last_time, 1, next_time);
    body.clocks.push_front({session_id, offset, wrapped_sum(utime, offset)});
    if (body.clocks.size() > kMaxClocks) body.clocks.pop_back();
    clock = body.clocks.begin();
  }
  const std::int64_t time = wrapped_sum(utime, clock->offset);
  clock->latest = std::max(clock->latest, time);
  latest_ = std::max(latest_, time);
  if (time > body.last_time) {
    body.last_step = time - body.last_time;
    body.last_time = time;
  }
  return time;
}

void RunBuilder::count_evaluation(ShownBody& shown, const Body& body, const ValidatedPose& pose) const {
  if (pose.status != BodyStatus::kOk) {
    ++shown.evaluations.rejected;
    shown.last_pose.reset();
    return;
  }
  const PoseBits bits = pose_bits(pose.pose);
  if (shown.last_pose && equal_branch_free(*shown.last_pose, bits)) {
    ++shown.evaluations.unchanged;
    return;
  }
  shown.last_pose = bits;
  if (body.subdivision != nullptr) {  // bounds do not suffice to evaluate it
    ++shown.evaluations.crossing;
    return;
  }
  switch (quick_immersion(body.solver.mesh(), pose.pose, scene_.water())) {
    case Immersion::kDry:
      ++shown.evaluations.dry;
      break;
    case Immersion::kSubmerged:
      ++(body.solver.method() == Method::kHierarchical ? shown.evaluations.wet : shown.evaluations.crossing);
      break;
    case Immersion::kPiercing:
      ++shown.evaluations.crossing;
      break;
  }
}

std::shared_ptr<const SeaPeriod> RunBuilder::sea_of(const RecordedState& recorded) const {
  return has_waves(scene_) && !scene_.receives_grids() ? water_.sea_at(recorded.utime, recorded.lead_time)
                                                       : nullptr;
}

std::shared_ptr<RowLoads> RunBuilder::make_loads(BodyRun& run, const Body& body,
                                                 const RecordedState& recorded) const {
  if (!has_loads(body)) return nullptr;
  if (!recorded.velocities && body.hydrodynamics != nullptr) run.loads_without_velocities = true;
  return std::make_shared<RowLoads>(RowLoads{.utime = recorded.utime,
                                             .lead_time = recorded.lead_time,
                                             .state = recorded.state,
                                             .sea = sea_of(recorded),
                                             .recorded = std::nullopt});
}

std::shared_ptr<RowLoads> RunBuilder::add(const RecordedState& recorded) {
  const std::optional<std::size_t> index = scene_.index_of(recorded.state.body_id);
  if (!index) {
    ++run_.unknown_bodies;
    return nullptr;
  }
  const Body& body = scene_.bodies()[*index];
  const ValidatedPose pose = validate_pose(recorded.state, recorded.lead_time);
  ShownBody* const shown = show(*index);
  if (shown == nullptr) {
    summarize(run_.bodies[*index], recorded, pose);
    return nullptr;
  }
  if (!has_waves(scene_)) count_evaluation(*shown, body, pose);
  if (!recorded.wrench && !recorded.force_torque) ++run_.computed;
  const std::shared_ptr<const BodyCondition> condition = conditions_.at(*index, recorded.utime);
  BodyWrench wrench =
      recorded.wrench ? *recorded.wrench
                      : evaluate_state(body, water_.move_to(recorded.utime, recorded.lead_time).water,
                                       scene_.current(), recorded.state, recorded.lead_time, condition.get())
                            .wrench;
  if (recorded.force_torque) {
    wrench.force = recorded.force_torque->force;
    wrench.torque = recorded.force_torque->torque;
  }

  count_row(run_.bodies[*index], wrench.status, to_vec3(wrench.force).norm());

  RunRow row;
  row[kTime] = 1e-6 * static_cast<double>(recorded.time);
  put(row, kPx, recorded.state.position);
  put(row, kQw, recorded.state.quaternion_wxyz);
  row[kStatus] = static_cast<double>(wrench.status);
  put(row, kFx, wrench.force);
  put(row, kTx, wrench.torque);
  row[kVolume] = wrench.submerged_volume;
  put(row, kBx, wrench.center_of_buoyancy);
  row[kEnergy] = kUnknown;
  if (recorded.energy) {
    row[kEnergy] = *recorded.energy;
  } else if (recorded.velocities && shown->rigid && wrench.status == BodyStatus::kOk) {
    if (condition != nullptr && condition != shown->condition) make_rigid(body, condition, *shown);
    row[kEnergy] = energy_of(*shown->rigid, shown->motion, recorded, wrench, body.solver, scene_.water());
  }
  row[kRoundTrip] = recorded.round_trip;
  const Attitude body_attitude = attitude(raw_pose(recorded.state), scene_.water(), shown->mesh_up);
  row[kHeave] = body_attitude.heave;
  row[kRoll] = body_attitude.roll;
  row[kPitch] = body_attitude.pitch;
  row[kForce] = to_vec3(wrench.force).norm();
  row[kTorque] = to_vec3(wrench.torque).norm();
  const std::shared_ptr<const SeaPeriod> sea = sea_of(recorded);
  row[kSeaTime] = sea ? sea_time(*sea, recorded.utime, recorded.lead_time) : kUnknown;
  row[kSea] = sea ? place_of(sea) : kUnknown;
  if (scene_.receives_grids()) keep_surface(recorded);
  std::shared_ptr<RowLoads> loads = make_loads(run_.bodies[*index], body, recorded);
  shown->rows.add({.number = rows_added_++, .values = row, .loads = loads, .condition = condition});
  return loads;
}

void RunBuilder::keep_surface(const RecordedState& recorded) {
  std::vector<DrawnSurface>& surfaces = run_.surfaces;
  const double time = 1e-6 * static_cast<double>(recorded.time);
  if (!surfaces.empty() && (time <= surfaces.back().time || time < surfaces.back().time + surface_interval_))
    return;
  const std::shared_ptr<const SeaPeriod> sea = water_.sea_at(recorded.utime, recorded.lead_time);
  if (sea == nullptr) return;
  surfaces.push_back({time, surface_json(*sea, recorded.utime, recorded.lead_time)});
  surface_bytes_ += bytes_of(surfaces.back());
  if (surface_bytes_ <= kMaxSurfaceBytes || surfaces.size() < 3) return;
  for (std::size_t i = 2; i < surfaces.size(); i += 2) surfaces[i / 2] = std::move(surfaces[i]);
  surfaces.resize((surfaces.size() + 1) / 2);
  surface_bytes_ = 0;
  for (const DrawnSurface& kept : surfaces) surface_bytes_ += bytes_of(kept);
  surface_interval_ =
      (surfaces.back().time - surfaces.front().time) / static_cast<double>(surfaces.size() - 1);
}

double RunBuilder::place_of(const std::shared_ptr<const SeaPeriod>& sea) {
  std::vector<std::shared_ptr<const SeaPeriod>>& seas = run_.seas;
  // Most rows have the sea of the row before.
  const auto found = std::find(seas.rbegin(), seas.rend(), sea);
  if (found != seas.rend()) return static_cast<double>(seas.rend() - found - 1);
  if (seas.size() == kMaxSeasShown) {
    if (!std::exchange(warned_of_seas_, true)) {
      add_warning("the file holds more than " + std::to_string(kMaxSeasShown) +
                  " different seas; the surface of the others is not drawn");
    }
    return kUnknown;
  }
  seas.push_back(sea);
  return static_cast<double>(seas.size() - 1);
}

void RunBuilder::receive_sea(std::int64_t timestamp, Bytes message) {
  if (!scene_.receives_sea()) return;
  if (const Expected<void> received = water_.receive_sea(message); !received) {
    add_warning("event at " + std::to_string(timestamp) + " us skipped: " + received.error().message());
  }
}

void RunBuilder::receive_condition(std::int64_t timestamp, Bytes message) {
  if (scene_.bodies_with_subdivision() == 0) return;
  if (const Expected<void> received = conditions_.receive(message); !received) {
    add_warning("event at " + std::to_string(timestamp) + " us: " + received.error().message());
  }
}

void RunBuilder::add_warning(std::string warning) {
  if (run_.warnings.size() < kMaxWarnings) {
    run_.warnings.push_back(std::move(warning));
  } else {
    ++run_.suppressed_warnings;
  }
}

RecordedRun RunBuilder::finish() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i] == nullptr) continue;
    BodyRun& body = run_.bodies[i];
    std::vector<KeptRow> rows = bodies_[i]->rows.rows();
    body.evaluations = bodies_[i]->evaluations;
    // Requests without a response were added out of order.
    std::ranges::stable_sort(rows, {}, [](const KeptRow& row) { return row.values[kTime]; });
    for (const KeptRow& row : rows) body.rows.push_back(row.values);
    if (has_loads(scene_.bodies()[i])) add_loads(scene_, scene_.bodies()[i], rows, body);
    const Subdivision* const subdivision = scene_.bodies()[i].subdivision;
    if (subdivision != nullptr) add_conditions(*subdivision, rows, body);
  }
  run_.sessions = static_cast<std::int64_t>(sessions_.size());
  return std::move(run_);
}

}  // namespace buoyancy::view
