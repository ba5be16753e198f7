// The service's status: its core type, and its encoding as service_status_t.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

// Totals since the start. Each field is a counter of service_status_t.lcm, which documents it.
struct ServiceCounters {
  std::int64_t requests = 0;
  std::int64_t computed = 0;
  std::int64_t retries = 0;
  std::int64_t conflicting_retries = 0;
  std::int64_t stale = 0;
  std::int64_t superseded = 0;
  std::int64_t sessions = 0;
  std::int64_t sessions_evicted = 0;
  std::int64_t rejected_truncated = 0;
  std::int64_t rejected_fingerprint = 0;
  std::int64_t rejected_count = 0;
  std::int64_t rejected_length = 0;
  std::int64_t rejected_bodies = 0;
  std::int64_t rejected_points = 0;
  std::int64_t rejected_work = 0;
  std::int64_t rejected_busy = 0;
  std::int64_t rejected_memory = 0;
  std::int64_t outputs_too_large = 0;
  std::int64_t requests_sliced = 0;
  std::int64_t retained_bytes = 0;
  std::int64_t replies_evicted = 0;
  std::int64_t seas_received = 0;
  std::int64_t seas_rejected = 0;
  std::int64_t conditions_received = 0;
  std::int64_t conditions_rejected = 0;
  std::int64_t motions_contradicting = 0;
  std::int64_t quaternions_xyzw = 0;
  std::array<std::int64_t, kBodyStatusCount> bodies{};  // indexed by BodyStatus
  std::int64_t quaternions_normalised = 0;
  std::int64_t bodies_dry = 0;
  std::int64_t bodies_wet = 0;
  std::int64_t bodies_crossing = 0;
  std::int64_t bodies_unchanged = 0;
  std::int64_t bodies_work_capped = 0;
  std::int64_t bodies_sea_too_steep = 0;
  std::int64_t bodies_below_bed = 0;
  std::int64_t wave_patches = 0;
  std::int64_t hydrostatics = 0;
  std::int64_t water_points = 0;
  std::int64_t water_points_failed = 0;
  double largest_dropped_force = 0.0;
  double largest_dropped_torque = 0.0;

  std::int64_t rejected() const {
    return rejected_truncated + rejected_fingerprint + rejected_count + rejected_length + rejected_bodies +
           rejected_points + rejected_work + rejected_busy + rejected_memory;
  }
  // Adds the totals and takes the maximum of the largest_* fields.
  ServiceCounters& operator+=(const ServiceCounters& other);
};

// Faults that the service injected on purpose, by kind; the fields faults_* of service_status_t.lcm.
struct FaultCounters {
  std::int64_t dropped = 0;
  std::int64_t delayed = 0;
  std::int64_t duplicated = 0;
  std::int64_t reordered = 0;
  std::int64_t corrupted = 0;
  std::int64_t stalls = 0;
};

struct LatencyPercentiles {  // [s]
  double p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
};

// The values equal the constants of service_status_t.lcm.
enum class SimdTarget : std::int32_t {
  kOther = 0,
  kScalar = 1,
  kSsse3 = 2,
  kSse4 = 3,
  kAvx2 = 4,
  kAvx3 = 5,
  kNeon = 6,
};
// Maps the target names of wetted_tree_sum.h, such as "AVX2"; returns kOther for any other name.
SimdTarget simd_target_from_name(std::string_view name);

// kLockstep: handle every request in order of arrival. kLatest: handle only the newest pending request of
// each session. The values equal the constants of service_status_t.lcm.
enum class ServiceMode : std::int32_t { kLockstep = 0, kLatest = 1 };

// The fields are those of service_status_t.lcm, which documents them.
struct ServiceStatus {
  std::int64_t utime = 0;  // [us]
  std::int64_t instance_id = 0;
  std::string version;
  std::string scene;
  std::string injected_faults;
  double uptime = 0.0;  // [s]
  ServiceMode mode = ServiceMode::kLockstep;
  SimdTarget simd_target = SimdTarget::kOther;
  std::int32_t threads = 1;
  std::int32_t scene_bodies = 0;
  std::int64_t scene_fingerprint = 0;
  std::int64_t other_services = 0;
  std::int64_t reloads = 0;
  std::int64_t reloads_failed = 0;
  std::int64_t send_failures = 0;
  std::int64_t packets_dropped = 0;
  std::int64_t fragments_dropped = 0;
  std::int64_t partial_messages_evicted = 0;
  FaultCounters faults;
  ServiceCounters counters;
  LatencyPercentiles latency;
  double queue_wait = 0.0;  // [s]
};

// Replaces bytes by the encoded status. Precondition: the strings contain no NUL.
void encode(const ServiceStatus& status, std::vector<std::uint8_t>& bytes);
// Makes the checks of wire.h's decode(), and checks each string's length and final NUL. On an error, status
// is unchanged.
std::optional<DecodeError> decode(Bytes bytes, ServiceStatus& status);

}  // namespace buoyancy
