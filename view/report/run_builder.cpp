#include "view/report/run_builder.h"

#include <algorithm>
#include <cmath>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxRowsOfBody = 12'000;
constexpr std::size_t kWarningsKept = 20;
constexpr std::size_t kSessionsCounted = 10'000;
constexpr std::size_t kClocksKept = 8;
constexpr std::int64_t kClockBeganAgain = 1'000'000;          // us: what is back by less came late
constexpr std::int64_t kAnotherClock = 86'400 * 1'000'000LL;  // us

// A file may say any utime.
std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

// offset where it puts utime at least least_ahead, and less than a day, behind latest; else the one that puts
// it at `otherwise`.
std::int64_t fitting_offset(std::int64_t utime, std::int64_t offset, std::int64_t latest,
                            std::int64_t least_ahead, std::int64_t otherwise) {
  const std::int64_t ahead = wrapped_difference(wrapped_sum(utime, offset), latest);
  const bool fits = ahead >= least_ahead && ahead <= kAnotherClock;
  return fits ? offset : wrapped_difference(otherwise, utime);
}

MeshUp mesh_up_of(const Body& body) {
  const std::string& axis = body.prepared_mesh->report.source.up_axis;
  return axis == "y" ? MeshUp::kY : axis == "x" ? MeshUp::kX : MeshUp::kZ;
}

// A pose that nobody could answer is still a row: it is shown where its numbers are.
Pose raw_pose(const BodyState& state) {
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  const Eigen::Quaterniond q(w, x, y, z);
  return {to_vec3(state.position), q.norm() > 0.0 ? q : Eigen::Quaterniond::Identity()};
}

double energy_of(const RigidBody& rigid, const RecordedState& recorded, const BodyWrench& wrench,
                 const Water& water) {
  const Pose pose = raw_pose(recorded.state);
  DynamicsSpec spec;
  spec.position = pose.p_WB;
  spec.orientation = pose.q_WB.normalized();
  spec.linear_velocity = to_vec3(recorded.state.linear_velocity);
  spec.angular_velocity = to_vec3(recorded.state.angular_velocity);
  const RigidBodyState state = initial_state(rigid, spec);
  return mechanical_energy(rigid, state, wrench, water);
}

template <std::size_t kSize>
void put(Row& row, Column first, const std::array<double, kSize>& values) {
  std::ranges::copy(values, row.begin() + static_cast<std::ptrdiff_t>(first));
}

BodyWrench computed_wrench(const Body& body, const Water& water, const ValidatedPose& asked) {
  BodyOutcome outcome;
  outcome.status = asked.status;
  if (asked.status == BodyStatus::kOk) evaluate(body, water, asked, outcome);
  return to_wrench(body.id, outcome);
}

void count_row(BodyRun& body, BodyStatus status, double force) {
  ++body.recorded;
  const auto value = static_cast<std::size_t>(static_cast<std::uint32_t>(status));
  ++body.statuses[std::min<std::size_t>(value, kBodyStatusCount)];
  if (status == BodyStatus::kOk && !(force <= body.largest_force) && std::isfinite(force))
    body.largest_force = force;
}

// Of a body that is not shown: what the file and the pose say, nothing computed.
void summarize(BodyRun& body, const RecordedState& recorded, const ValidatedPose& asked) {
  if (recorded.wrench) {
    count_row(body, recorded.wrench->status, to_vec3(recorded.wrench->force).norm());
  } else if (asked.status != BodyStatus::kOk) {
    count_row(body, asked.status, 0.0);
  } else if (recorded.force_torque) {
    count_row(body, BodyStatus::kOk, to_vec3(recorded.force_torque->force).norm());
  } else {
    ++body.recorded;
  }
}

}  // namespace

RunBuilder::RunBuilder(const Scene& scene, std::size_t max_rows, const std::vector<std::size_t>& selected)
    : scene_(scene) {
  const std::size_t most = selected.empty() ? std::min(scene.bodies().size(), kMaxBodies) : selected.size();
  max_rows_of_body_ = std::min(max_rows / most, kMaxRowsOfBody);
  run_.bodies.resize(scene.bodies().size());
  bodies_.resize(scene.bodies().size());
  room_ = most;
  for (const std::size_t index : selected) show(index);
}

RunBuilder::Collected* RunBuilder::show(std::size_t index) {
  if (bodies_[index] != nullptr || room_ == 0) return bodies_[index].get();
  --room_;
  const Body& body = scene_.bodies()[index];
  bodies_[index] = std::make_unique<Collected>(max_rows_of_body_);
  bodies_[index]->mesh_up = mesh_up_of(body);
  run_.bodies[index].shown = true;
  if (body.client.given) {
    if (Expected<RigidBody> rigid = make_rigid_body(body, scene_.water()))
      bodies_[index]->rigid = *std::move(rigid);
  }
  return bodies_[index].get();
}

std::int64_t RunBuilder::time_of(std::int32_t body_id, std::int64_t session_id, std::int64_t utime) {
  const std::optional<std::size_t> index = scene_.index_of(body_id);
  if (!index) return 0;
  if (sessions_.size() < kSessionsCounted) sessions_.insert(session_id);
  Collected* const collected = show(*index);
  if (collected == nullptr) return 0;
  Collected& body = *collected;
  if (!first_utime_) first_utime_ = utime;

  const std::int64_t behind = wrapped_sum(body.last_time, body.last_step);
  auto clock = std::ranges::find(body.clocks, session_id, &Clock::session_id);
  if (clock != body.clocks.end()) {
    clock->offset = fitting_offset(utime, clock->offset, clock->latest, -kClockBeganAgain, behind);
  } else {
    // Another body's states may be older than those that came before.
    const std::int64_t offset =
        body.clocks.empty()
            ? fitting_offset(utime, wrapped_difference(0, *first_utime_), latest_, -kAnotherClock, latest_)
            : fitting_offset(utime, body.clocks.front().offset, body.last_time, 1, behind);
    body.clocks.push_front({session_id, offset, wrapped_sum(utime, offset)});
    if (body.clocks.size() > kClocksKept) body.clocks.pop_back();
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

void RunBuilder::classify(Collected& collected, const Body& body, const ValidatedPose& asked) const {
  if (asked.status != BodyStatus::kOk) {
    ++collected.skipped.refused;
    collected.last_pose.reset();
    return;
  }
  const PoseBits bits = pose_bits(asked.pose);
  if (collected.last_pose && equal_branch_free(*collected.last_pose, bits)) {
    ++collected.skipped.unchanged;
    return;
  }
  collected.last_pose = bits;
  switch (quick_immersion(body.solver.mesh(), asked.pose, scene_.water())) {
    case Immersion::kDry:
      ++collected.skipped.dry;
      break;
    case Immersion::kSubmerged:
      ++(body.solver.method() == Method::kHierarchical ? collected.skipped.wet : collected.skipped.crossing);
      break;
    case Immersion::kPiercing:
      ++collected.skipped.crossing;
      break;
  }
}

void RunBuilder::add(const RecordedState& recorded) {
  const std::optional<std::size_t> index = scene_.index_of(recorded.state.body_id);
  if (!index) {
    ++run_.unknown_bodies;
    return;
  }
  const Body& body = scene_.bodies()[*index];
  const ValidatedPose asked = validate_pose(recorded.state, recorded.lead_time);
  Collected* const shown = show(*index);
  if (shown == nullptr) {
    summarize(run_.bodies[*index], recorded, asked);
    return;
  }
  Collected& collected = *shown;
  classify(collected, body, asked);
  if (!recorded.wrench && !recorded.force_torque) ++run_.computed;
  BodyWrench wrench = recorded.wrench ? *recorded.wrench : computed_wrench(body, scene_.water(), asked);
  if (recorded.force_torque) {
    wrench.force = recorded.force_torque->force;
    wrench.torque = recorded.force_torque->torque;
  }

  count_row(run_.bodies[*index], wrench.status, to_vec3(wrench.force).norm());

  Row row;
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
  } else if (recorded.velocities && collected.rigid && wrench.status == BodyStatus::kOk) {
    row[kEnergy] = energy_of(*collected.rigid, recorded, wrench, scene_.water());
  }
  row[kRoundTrip] = recorded.round_trip;
  const Attitude lies = attitude(raw_pose(recorded.state), scene_.water(), collected.mesh_up);
  row[kHeave] = lies.heave;
  row[kRoll] = lies.roll;
  row[kPitch] = lies.pitch;
  row[kForce] = to_vec3(wrench.force).norm();
  row[kTorque] = to_vec3(wrench.torque).norm();
  collected.rows.add(number_++, row);
}

void RunBuilder::add_warning(std::string warning) {
  if (run_.warnings.size() < kWarningsKept) {
    run_.warnings.push_back(std::move(warning));
  } else {
    ++run_.suppressed_warnings;
  }
}

RecordedRun RunBuilder::finish() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i] == nullptr) continue;
    BodyRun& body = run_.bodies[i];
    body.rows = bodies_[i]->rows.rows();
    body.skipped = bodies_[i]->skipped;
    // A request that waited in vain comes late.
    std::ranges::stable_sort(body.rows, {}, [](const Row& row) { return row[kTime]; });
  }
  run_.sessions = static_cast<std::int64_t>(sessions_.size());
  return std::move(run_);
}

}  // namespace buoyancy
