// Defines the fields of every message once, in the order of the .lcm files: visitors encode, decode or
// measure them, write and read CSV files, and so on.
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
#include <string_view>
#include <type_traits>

#include "messages/condition_change.h"
#include "messages/hydrostatics.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/sea_grid.h"
#include "messages/sea_state.h"
#include "messages/status.h"
#include "messages/water_samples.h"

namespace buoyancy {

template <typename T, typename Plain>
concept MaybeConst = std::same_as<std::remove_const_t<T>, Plain>;

// A field in the tables below. Its type and shape are those of the member.
struct Field {
  std::string_view name;       // in the message definition
  std::string_view unit = {};  // such as "N m"; empty: none
  std::string_view note = {};  // its frame (axes of W unless it says otherwise), or what the number is
  std::string_view csv = {};   // its columns in CSV files; empty: the name, of matrices with row and column
};

// The tables of the fields: each calls visitor(field, member) for all of them, in the order of the
// definition. They are inlined always, so that the names cost nothing where bodies are encoded and decoded.
template <MaybeConst<BodyState> State, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(State& state, Visitor&& visitor) {
  visitor({"body_id"}, state.body_id);
  visitor({"position", "m", "of B's origin", "px,py,pz"}, state.position);
  visitor({"quaternion_wxyz", "", "q_WB", "qw,qx,qy,qz"}, state.quaternion_wxyz);
  visitor({"linear_velocity", "m/s", "of B's origin", "vx,vy,vz"}, state.linear_velocity);
  visitor({"angular_velocity", "rad/s", "", "wx,wy,wz"}, state.angular_velocity);
}

template <MaybeConst<BodyWrench> Wrench, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(Wrench& wrench, Visitor&& visitor) {
  visitor({"body_id"}, wrench.body_id);
  visitor({"status"}, wrench.status);
  visitor({"force", "N", "", "fx,fy,fz"}, wrench.force);
  visitor({"torque", "N m", "about the body's reference point", "tx,ty,tz"}, wrench.torque);
  visitor({"submerged_volume", "m^3", "displaced", "volume"}, wrench.submerged_volume);
  visitor({"center_of_buoyancy", "m", "relative to the position", "bx,by,bz"}, wrench.center_of_buoyancy);
  visitor({"force_error_bound", "N"}, wrench.force_error_bound);
  visitor({"torque_error_bound", "N m"}, wrench.torque_error_bound);
}

template <MaybeConst<BodyHydrostatics> Body, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(Body& body, Visitor&& visitor) {
  visitor({"body_id"}, body.body_id);
  visitor({"status"}, body.status);
  visitor({"submerged_volume", "m^3", "displaced"}, body.submerged_volume);
  visitor({"center_of_buoyancy", "m", "relative to the position"}, body.center_of_buoyancy);
  visitor({"wetted_area", "m^2"}, body.wetted_area);
  visitor({"waterplane_area", "m^2"}, body.waterplane_area);
  visitor({"waterplane_centroid", "m", "relative to the position"}, body.waterplane_centroid);
  visitor({"waterplane_second_moments", "m^4",
           "about the principal axes through the centroid, the smaller first"},
          body.waterplane_second_moments);
  visitor({"waterplane_axes", "", "those axes, unit vectors"}, body.waterplane_axes);
  visitor({"metacentric_radii", "m", "BM of a heel about those axes"}, body.metacentric_radii);
  visitor({"metacenters", "m", "relative to the position"}, body.metacenters);
  visitor({"metacentric_heights", "m", "GM; NaN without a centre of mass"}, body.metacentric_heights);
  visitor({"stiffness", "N, N m", "rows N and N m, columns m and rad"}, body.stiffness);
}

template <MaybeConst<BodyLoads> Body, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(Body& body, Visitor&& visitor) {
  visitor({"body_id"}, body.body_id);
  visitor({"status"}, body.status);
  visitor({"immersion", "", "0 to 1"}, body.immersion);
  visitor({"buoyancy_force", "N", "", "buoyancy_fx,buoyancy_fy,buoyancy_fz"}, body.buoyancy_force);
  visitor({"buoyancy_torque", "N m", "", "buoyancy_tx,buoyancy_ty,buoyancy_tz"}, body.buoyancy_torque);
  visitor({"drag_force", "N", "", "drag_fx,drag_fy,drag_fz"}, body.drag_force);
  visitor({"drag_torque", "N m", "", "drag_tx,drag_ty,drag_tz"}, body.drag_torque);
  visitor({"added_mass_force", "N", "", "added_mass_fx,added_mass_fy,added_mass_fz"}, body.added_mass_force);
  visitor({"added_mass_torque", "N m", "", "added_mass_tx,added_mass_ty,added_mass_tz"},
          body.added_mass_torque);
  visitor({"added_mass", "kg, kg m, kg m^2", "for the mass matrix of a simulator"}, body.added_mass);
  visitor({"damping", "N, N m", "rows N and N m, columns m/s and rad/s"}, body.damping);
  visitor({"water_velocity", "m/s", "", "water_vx,water_vy,water_vz"}, body.water_velocity);
}

template <MaybeConst<WaterPoint> Point, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(Point& point, Visitor&& visitor) {
  visitor({"points", "m"}, point.position);
}

// A water_samples_t has an array for each of these fields.
template <MaybeConst<WaterSample> Sample, typename Visitor>
[[gnu::always_inline]] inline void visit_named_fields(Sample& sample, Visitor&& visitor) {
  visitor({"elevation", "m", "of the surface above or below the point, over the level"}, sample.elevation);
  visitor({"pressure", "Pa", "over that of the air"}, sample.pressure);
  visitor({"velocity", "m/s", "of current and waves"}, sample.velocity);
  visitor({"density", "kg/m^3"}, sample.density);
}

template <typename T>
concept BodyOfMessage = MaybeConst<T, BodyState> || MaybeConst<T, BodyWrench> ||
    MaybeConst<T, BodyHydrostatics> || MaybeConst<T, BodyLoads>;
template <typename T>
concept ElementOfMessage = BodyOfMessage<T> || MaybeConst<T, WaterPoint> || MaybeConst<T, WaterSample>;

template <ElementOfMessage Element, typename Visitor>
[[gnu::always_inline]] inline void visit_fields(Element& element, Visitor& visitor) {
  visit_named_fields(element, [&visitor](const Field& /*field*/, auto& member) { visitor(member); });
}

template <MaybeConst<RequestId> Id, typename Visitor>
void visit_fields(Id& id, Visitor& visitor) {
  visitor(id.utime, id.session_id, id.seq);
}

template <MaybeConst<ConditionChange> Change, typename Visitor>
void visit_fields(Change& change, Visitor& visitor) {
  visitor(change.utime, change.body_id, change.kind, change.index, change.flooded, change.liquid_volume);
}

// A header holds the fields before the number of bodies, points or samples.
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

template <MaybeConst<WaterPoints> Message, typename Visitor>
void visit_header(Message& points, Visitor& visitor) {
  visit_fields(points.id, visitor);
}

template <MaybeConst<WaterSamples> Message, typename Visitor>
void visit_header(Message& samples, Visitor& visitor) {
  visit_fields(samples.id, visitor);
  visitor(samples.status);
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

// A grid consists of a header and its elevations.
template <MaybeConst<SeaGridHeader> Header, typename Visitor>
void visit_header(Header& header, Visitor& visitor) {
  visitor(header.utime, header.instance_id, header.origin, header.spacing, header.level, header.periodic,
          header.rows, header.columns);
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
inline constexpr std::array<std::string_view, kBodyStatusCount> kBodyCounterNames{"bodies_ok",
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

// Visits each counter; with several ServiceCounters, the same counter of all of them in one call.
template <typename Visitor, MaybeConst<ServiceCounters>... C>
void visit_counters(Visitor&& visitor, C&... c) {
  visitor({"requests"}, c.requests...);
  visitor({"computed"}, c.computed...);
  visitor({"retries"}, c.retries...);
  visitor({"conflicting_retries"}, c.conflicting_retries...);
  visitor({"stale"}, c.stale...);
  visitor({"superseded"}, c.superseded...);
  visitor({"sessions"}, c.sessions...);
  visitor({"sessions_evicted"}, c.sessions_evicted...);
  visitor({"rejected_truncated"}, c.rejected_truncated...);
  visitor({"rejected_fingerprint"}, c.rejected_fingerprint...);
  visitor({"rejected_count"}, c.rejected_count...);
  visitor({"rejected_length"}, c.rejected_length...);
  visitor({"rejected_bodies"}, c.rejected_bodies...);
  visitor({"rejected_points"}, c.rejected_points...);
  visitor({"rejected_work"}, c.rejected_work...);
  visitor({"rejected_busy"}, c.rejected_busy...);
  visitor({"rejected_memory"}, c.rejected_memory...);
  visitor({"outputs_too_large"}, c.outputs_too_large...);
  visitor({"requests_sliced"}, c.requests_sliced...);
  visitor({"retained_bytes"}, c.retained_bytes...);
  visitor({"replies_evicted"}, c.replies_evicted...);
  visitor({"seas_received"}, c.seas_received...);
  visitor({"seas_rejected"}, c.seas_rejected...);
  visitor({"conditions_received"}, c.conditions_received...);
  visitor({"conditions_rejected"}, c.conditions_rejected...);
  visitor({"motions_contradicting"}, c.motions_contradicting...);
  visitor({"quaternions_xyzw"}, c.quaternions_xyzw...);
  for (std::size_t i = 0; i < kBodyCounterNames.size(); ++i) visitor({kBodyCounterNames[i]}, c.bodies[i]...);
  visitor({"quaternions_normalised"}, c.quaternions_normalised...);
  visitor({"bodies_dry"}, c.bodies_dry...);
  visitor({"bodies_wet"}, c.bodies_wet...);
  visitor({"bodies_crossing"}, c.bodies_crossing...);
  visitor({"bodies_unchanged"}, c.bodies_unchanged...);
  visitor({"bodies_work_capped"}, c.bodies_work_capped...);
  visitor({"bodies_sea_too_steep"}, c.bodies_sea_too_steep...);
  visitor({"bodies_below_bed"}, c.bodies_below_bed...);
  visitor({"wave_patches"}, c.wave_patches...);
  visitor({"hydrostatics"}, c.hydrostatics...);
  visitor({"water_points"}, c.water_points...);
  visitor({"water_points_failed"}, c.water_points_failed...);
  visitor({"largest_dropped_force"}, c.largest_dropped_force...);
  visitor({"largest_dropped_torque"}, c.largest_dropped_torque...);
}

// Visits each field after the strings.
template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_named_trailer(Status& status, Visitor&& visitor) {
  visitor({"uptime", "s"}, status.uptime);
  visitor({"mode"}, status.mode);
  visitor({"simd_target"}, status.simd_target);
  visitor({"threads"}, status.threads);
  visitor({"scene_bodies"}, status.scene_bodies);
  visitor({"scene_fingerprint"}, status.scene_fingerprint);
  visitor({"other_services"}, status.other_services);
  visitor({"reloads"}, status.reloads);
  visitor({"reloads_failed"}, status.reloads_failed);
  visitor({"send_failures"}, status.send_failures);
  visitor({"packets_dropped"}, status.packets_dropped);
  visitor({"fragments_dropped"}, status.fragments_dropped);
  visitor({"partial_messages_evicted"}, status.partial_messages_evicted);
  visitor({"faults_dropped"}, status.faults.dropped);
  visitor({"faults_delayed"}, status.faults.delayed);
  visitor({"faults_duplicated"}, status.faults.duplicated);
  visitor({"faults_reordered"}, status.faults.reordered);
  visitor({"faults_corrupted"}, status.faults.corrupted);
  visitor({"faults_stalls"}, status.faults.stalls);
  visit_counters(visitor, status.counters);
  visitor({"latency_p50", "s"}, status.latency.p50);
  visitor({"latency_p99", "s"}, status.latency.p99);
  visitor({"latency_p999", "s"}, status.latency.p999);
  visitor({"latency_max", "s"}, status.latency.max);
  visitor({"queue_wait", "s"}, status.queue_wait);
}

template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_trailer(Status& status, Visitor& visitor) {
  visit_named_trailer(status, [&visitor](const Field& /*field*/, auto& member) { visitor(member); });
}

template <MaybeConst<ServiceStatus> Status, typename Visitor>
void visit_named_fields(Status& status, Visitor&& visitor) {
  visitor({"utime", "us"}, status.utime);
  visitor({"instance_id"}, status.instance_id);
  visitor({"version"}, status.version);
  visitor({"scene"}, status.scene);
  visitor({"injected_faults"}, status.injected_faults);
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

// Encodes or decodes the visited fields of one element of a message that has an array for each field.
// Coder: BigEndianReader or BigEndianWriter; Byte: what it takes.
template <typename Coder, typename Byte>
class ArrayFields {
 public:
  // arrays: the first of them. Precondition: element < count, and bytes holds, or has room for, all arrays.
  ArrayFields(Byte* arrays, std::size_t count, std::size_t element)
      : arrays_(arrays), count_(count), element_(element) {}

  template <typename... Fields>
  void operator()(Fields&... fields) {
    (code(fields), ...);
  }

 private:
  template <typename T>
  void code(T& field) {
    Coder(arrays_ + element_ * sizeof(field))(field);
    arrays_ += count_ * sizeof(field);
  }

  Byte* arrays_;
  std::size_t count_, element_;
};

}  // namespace buoyancy
