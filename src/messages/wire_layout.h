// Defines the byte layout of every message once: visitors that encode, decode or measure visit the fields in
// the order of the .lcm files.
//
// LCM's encoding: a fingerprint of 8 bytes, then the fields, big-endian and without padding. A string is its
// length including the final NUL (int32), then its characters and the NUL.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "messages/condition_change.h"
#include "messages/hydrostatics.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/sea_state.h"
#include "messages/status.h"

namespace buoyancy {

template <typename T, typename Plain>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Plain>;

template <MaybeConst<RequestId> Id, typename Visitor>
void visit_fields(Id& id, Visitor& visitor) {
  visitor(id.utime, id.session_id, id.seq);
}

template <MaybeConst<BodyState> State, typename Visitor>
void visit_fields(State& state, Visitor& visitor) {
  visitor(state.body_id, state.position, state.quaternion_wxyz, state.linear_velocity,
          state.angular_velocity);
}

template <MaybeConst<BodyWrench> Wrench, typename Visitor>
void visit_fields(Wrench& wrench, Visitor& visitor) {
  visitor(wrench.body_id, wrench.status, wrench.force, wrench.torque, wrench.submerged_volume,
          wrench.center_of_buoyancy, wrench.force_error_bound, wrench.torque_error_bound);
}

template <MaybeConst<BodyHydrostatics> Body, typename Visitor>
void visit_fields(Body& body, Visitor& visitor) {
  visitor(body.body_id, body.status, body.submerged_volume, body.center_of_buoyancy, body.wetted_area,
          body.waterplane_area, body.waterplane_centroid, body.waterplane_second_moments,
          body.waterplane_axes, body.metacentric_radii, body.metacenters, body.metacentric_heights,
          body.stiffness);
}

template <MaybeConst<BodyLoads> Body, typename Visitor>
void visit_fields(Body& body, Visitor& visitor) {
  visitor(body.body_id, body.status, body.immersion, body.buoyancy_force, body.buoyancy_torque,
          body.drag_force, body.drag_torque, body.added_mass_force, body.added_mass_torque, body.added_mass,
          body.damping, body.water_velocity);
}

template <MaybeConst<ConditionChange> Change, typename Visitor>
void visit_fields(Change& change, Visitor& visitor) {
  visitor(change.utime, change.body_id, change.kind, change.index, change.flooded, change.liquid_volume);
}

// A header holds the fields before the number of bodies.
template <MaybeConst<WrenchRequest> Message, typename Visitor>
void visit_header(Message& request, Visitor& visitor) {
  visit_fields(request.id, visitor);
  visitor(request.lead_time);
}

template <MaybeConst<WrenchResponse> Message, typename Visitor>
void visit_header(Message& response, Visitor& visitor) {
  visit_fields(response.id, visitor);
}

template <MaybeConst<BodiesHydrostatics> Message, typename Visitor>
void visit_header(Message& hydrostatics, Visitor& visitor) {
  visit_fields(hydrostatics.id, visitor);
}

template <MaybeConst<BodiesLoads> Message, typename Visitor>
void visit_header(Message& loads, Visitor& visitor) {
  visit_fields(loads.id, visitor);
}

// A sea consists of a header, the number of components, and an array for each of a component's numbers.
template <MaybeConst<SeaState> State, typename Visitor>
void visit_header(State& state, Visitor& visitor) {
  visitor(state.utime, state.instance_id, state.e1, state.e2, state.up);
  visitor(state.level, state.depth, state.gravity, state.time_origin, state.ramp, state.current,
          state.wave_pressure);
}

template <MaybeConst<SeaState> State, typename Visitor>
void visit_components(State& state, Visitor&& visitor) {
  visitor(state.amplitude);
  visitor(state.angular_frequency);
  visitor(state.direction);
  visitor(state.phase);
}

// A status consists of a header, its strings and a trailer.
template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_header(Status& status, Visitor& visitor) {
  visitor(status.utime, status.instance_id);
}

template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_strings(Status& status, Visitor&& visitor) {
  visitor(status.version);
  visitor(status.scene);
  visitor(status.injected_faults);
}

// The names of ServiceCounters::bodies in service_status_t, by BodyStatus.
inline constexpr std::array<const char*, kBodyStatusCount> kBodyCounterNames{"bodies_ok",
                                                                             "bodies_unknown",
                                                                             "bodies_non_finite_pose",
                                                                             "bodies_bad_quaternion",
                                                                             "bodies_non_finite_twist",
                                                                             "bodies_bad_lead_time",
                                                                             "bodies_open_edge_wet",
                                                                             "bodies_out_of_range",
                                                                             "bodies_no_sea",
                                                                             "bodies_bad_condition",
                                                                             "bodies_not_certified"};

// Visits each counter with its name in service_status_t; with several ServiceCounters, the same counter of
// all of them in one call.
template <typename Visitor, MaybeConst<ServiceCounters>... C>
void visit_counters(Visitor&& visitor, C&... c) {
  visitor("requests", c.requests...);
  visitor("computed", c.computed...);
  visitor("retries", c.retries...);
  visitor("conflicting_retries", c.conflicting_retries...);
  visitor("stale", c.stale...);
  visitor("superseded", c.superseded...);
  visitor("sessions", c.sessions...);
  visitor("sessions_evicted", c.sessions_evicted...);
  visitor("rejected_truncated", c.rejected_truncated...);
  visitor("rejected_fingerprint", c.rejected_fingerprint...);
  visitor("rejected_count", c.rejected_count...);
  visitor("rejected_length", c.rejected_length...);
  visitor("rejected_bodies", c.rejected_bodies...);
  visitor("rejected_work", c.rejected_work...);
  visitor("rejected_busy", c.rejected_busy...);
  visitor("rejected_memory", c.rejected_memory...);
  visitor("outputs_too_large", c.outputs_too_large...);
  visitor("requests_sliced", c.requests_sliced...);
  visitor("retained_bytes", c.retained_bytes...);
  visitor("replies_evicted", c.replies_evicted...);
  visitor("seas_received", c.seas_received...);
  visitor("seas_rejected", c.seas_rejected...);
  visitor("conditions_received", c.conditions_received...);
  visitor("conditions_rejected", c.conditions_rejected...);
  visitor("motions_contradicting", c.motions_contradicting...);
  visitor("quaternions_xyzw", c.quaternions_xyzw...);
  for (std::size_t i = 0; i < kBodyCounterNames.size(); ++i) visitor(kBodyCounterNames[i], c.bodies[i]...);
  visitor("quaternions_normalised", c.quaternions_normalised...);
  visitor("bodies_dry", c.bodies_dry...);
  visitor("bodies_wet", c.bodies_wet...);
  visitor("bodies_crossing", c.bodies_crossing...);
  visitor("bodies_unchanged", c.bodies_unchanged...);
  visitor("bodies_work_capped", c.bodies_work_capped...);
  visitor("bodies_sea_too_steep", c.bodies_sea_too_steep...);
  visitor("bodies_below_bed", c.bodies_below_bed...);
  visitor("wave_patches", c.wave_patches...);
  visitor("hydrostatics", c.hydrostatics...);
  visitor("largest_dropped_force", c.largest_dropped_force...);
  visitor("largest_dropped_torque", c.largest_dropped_torque...);
}

// Visits each field after the strings with its name in service_status_t.
template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_named_trailer(Status& status, Visitor&& visitor) {
  visitor("uptime", status.uptime);
  visitor("mode", status.mode);
  visitor("simd_target", status.simd_target);
  visitor("threads", status.threads);
  visitor("scene_bodies", status.scene_bodies);
  visitor("scene_fingerprint", status.scene_fingerprint);
  visitor("other_services", status.other_services);
  visitor("reloads", status.reloads);
  visitor("reloads_failed", status.reloads_failed);
  visitor("send_failures", status.send_failures);
  visitor("packets_dropped", status.packets_dropped);
  visitor("fragments_dropped", status.fragments_dropped);
  visitor("partial_messages_evicted", status.partial_messages_evicted);
  visitor("faults_dropped", status.faults.dropped);
  visitor("faults_delayed", status.faults.delayed);
  visitor("faults_duplicated", status.faults.duplicated);
  visitor("faults_reordered", status.faults.reordered);
  visitor("faults_corrupted", status.faults.corrupted);
  visitor("faults_stalls", status.faults.stalls);
  visit_counters(visitor, status.counters);
  visitor("latency_p50", status.latency.p50);
  visitor("latency_p99", status.latency.p99);
  visitor("latency_p999", status.latency.p999);
  visitor("latency_max", status.latency.max);
  visitor("queue_wait", status.queue_wait);
}

template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_trailer(Status& status, Visitor& visitor) {
  visit_named_trailer(status, [&visitor](const char* /*name*/, auto& field) { visitor(field); });
}

// Visits each field of a status with its name in service_status_t.
template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_named_fields(Status& status, Visitor&& visitor) {
  visitor("utime", status.utime);
  visitor("instance_id", status.instance_id);
  visitor("version", status.version);
  visitor("scene", status.scene);
  visitor("injected_faults", status.injected_faults);
  visit_named_trailer(status, visitor);
}

// Adds up the sizes [bytes] of the visited fields.
class LayoutSize {
 public:
  template <typename... Fields>
  void operator()(const Fields&... fields) {
    ((size_ += sizeof(fields)), ...);
  }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
};

template <typename T>
using UnsignedOf = std::conditional_t<sizeof(T) == 8, std::uint64_t, std::uint32_t>;

inline std::uint64_t big_endian(std::uint64_t value) {
  return std::endian::native == std::endian::big ? value : __builtin_bswap64(value);
}
inline std::uint32_t big_endian(std::uint32_t value) {
  return std::endian::native == std::endian::big ? value : __builtin_bswap32(value);
}

// Decodes the visited fields. Precondition: bytes holds all of them.
class BigEndianReader {
 public:
  explicit BigEndianReader(const std::uint8_t* bytes) : bytes_(bytes) {}

  template <typename... Fields>
  void operator()(Fields&... fields) {
    (read(fields), ...);
  }
  const std::uint8_t* position() const { return bytes_; }
  void skip(std::size_t size) { bytes_ += size; }

 private:
  template <typename T>
  void read(T& field) {
    UnsignedOf<T> value;
    static_assert(sizeof(T) == sizeof(value));
    std::memcpy(&value, bytes_, sizeof(value));
    field = std::bit_cast<T>(big_endian(value));
    bytes_ += sizeof(value);
  }
  template <typename T, std::size_t kSize>
  void read(std::array<T, kSize>& fields) {
    for (T& field : fields) read(field);
  }

  const std::uint8_t* bytes_;
};

// Encodes the visited fields. Precondition: bytes has room for all of them.
class BigEndianWriter {
 public:
  explicit BigEndianWriter(std::uint8_t* bytes) : bytes_(bytes) {}

  template <typename... Fields>
  void operator()(const Fields&... fields) {
    (write(fields), ...);
  }
  std::uint8_t* position() const { return bytes_; }
  void skip(std::size_t size) { bytes_ += size; }

 private:
  template <typename T>
  void write(const T& field) {
    const UnsignedOf<T> value = big_endian(std::bit_cast<UnsignedOf<T>>(field));
    std::memcpy(bytes_, &value, sizeof(value));
    bytes_ += sizeof(value);
  }
  template <typename T, std::size_t kSize>
  void write(const std::array<T, kSize>& fields) {
    for (const T& field : fields) write(field);
  }

  std::uint8_t* bytes_;
};

}  // namespace buoyancy
