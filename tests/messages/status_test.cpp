#include "messages/status.h"

#include <climits>
#include <type_traits>

#include <buoyancy/service_status_t.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "messages/wire_layout.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

constexpr std::size_t kVersionLength = 8 + 8 + 8;  // offset [bytes] of the version's length
constexpr std::size_t kEmptyString = 4 + 1;
constexpr std::size_t kTrailer = 8 + 4 * 4 + 8 * std::size_t{8 + 6 + 27 + 11 + 1 + 11 + 2 + 4 + 1};

std::string random_text() {
  return *rc::gen::container<std::string>(rc::gen::inRange<char>(1, CHAR_MAX));
}

ServiceStatus random_status() {
  ServiceStatus status;
  Randomiser randomiser;
  visit_header(status, randomiser);
  visit_strings(status, [](std::string& text) { text = random_text(); });
  visit_trailer(status, randomiser);
  return status;
}

std::int64_t count(const ServiceStatus& status, BodyStatus body) {
  return status.counters.bodies[static_cast<std::size_t>(body)];
}

ByteVector encoded_by_lcm(const ServiceStatus& status) {
  const ServiceCounters& c = status.counters;
  service_status_t message{};
  message.utime = status.utime;
  message.instance_id = status.instance_id;
  message.version = status.version;
  message.scene = status.scene;
  message.injected_faults = status.injected_faults;
  message.uptime = status.uptime;
  message.mode = static_cast<std::int32_t>(status.mode);
  message.simd_target = static_cast<std::int32_t>(status.simd_target);
  message.threads = status.threads;
  message.scene_bodies = status.scene_bodies;
  message.scene_fingerprint = status.scene_fingerprint;
  message.other_services = status.other_services;
  message.reloads = status.reloads;
  message.reloads_failed = status.reloads_failed;
  message.send_failures = status.send_failures;
  message.packets_dropped = status.packets_dropped;
  message.fragments_dropped = status.fragments_dropped;
  message.partial_messages_evicted = status.partial_messages_evicted;
  message.faults_dropped = status.faults.dropped;
  message.faults_delayed = status.faults.delayed;
  message.faults_duplicated = status.faults.duplicated;
  message.faults_reordered = status.faults.reordered;
  message.faults_corrupted = status.faults.corrupted;
  message.faults_stalls = status.faults.stalls;
  message.requests = c.requests;
  message.computed = c.computed;
  message.retries = c.retries;
  message.conflicting_retries = c.conflicting_retries;
  message.stale = c.stale;
  message.superseded = c.superseded;
  message.sessions = c.sessions;
  message.sessions_evicted = c.sessions_evicted;
  message.rejected_truncated = c.rejected_truncated;
  message.rejected_fingerprint = c.rejected_fingerprint;
  message.rejected_count = c.rejected_count;
  message.rejected_length = c.rejected_length;
  message.rejected_bodies = c.rejected_bodies;
  message.rejected_points = c.rejected_points;
  message.rejected_work = c.rejected_work;
  message.rejected_busy = c.rejected_busy;
  message.rejected_memory = c.rejected_memory;
  message.outputs_too_large = c.outputs_too_large;
  message.requests_sliced = c.requests_sliced;
  message.retained_bytes = c.retained_bytes;
  message.replies_evicted = c.replies_evicted;
  message.seas_received = c.seas_received;
  message.seas_rejected = c.seas_rejected;
  message.conditions_received = c.conditions_received;
  message.conditions_rejected = c.conditions_rejected;
  message.motions_contradicting = c.motions_contradicting;
  message.quaternions_xyzw = c.quaternions_xyzw;
  message.bodies_ok = count(status, BodyStatus::kOk);
  message.bodies_unknown = count(status, BodyStatus::kUnknownBody);
  message.bodies_non_finite_pose = count(status, BodyStatus::kNonFinitePose);
  message.bodies_bad_quaternion = count(status, BodyStatus::kBadQuaternion);
  message.bodies_non_finite_twist = count(status, BodyStatus::kNonFiniteTwist);
  message.bodies_bad_lead_time = count(status, BodyStatus::kBadLeadTime);
  message.bodies_open_edge_wet = count(status, BodyStatus::kOpenEdgeWet);
  message.bodies_out_of_range = count(status, BodyStatus::kOutOfRange);
  message.bodies_no_sea = count(status, BodyStatus::kNoSea);
  message.bodies_bad_condition = count(status, BodyStatus::kBadCondition);
  message.bodies_not_certified = count(status, BodyStatus::kNotCertified);
  message.quaternions_normalised = c.quaternions_normalised;
  message.bodies_dry = c.bodies_dry;
  message.bodies_wet = c.bodies_wet;
  message.bodies_crossing = c.bodies_crossing;
  message.bodies_unchanged = c.bodies_unchanged;
  message.bodies_work_capped = c.bodies_work_capped;
  message.bodies_sea_too_steep = c.bodies_sea_too_steep;
  message.bodies_below_bed = c.bodies_below_bed;
  message.wave_patches = c.wave_patches;
  message.hydrostatics = c.hydrostatics;
  message.water_points = c.water_points;
  message.water_points_failed = c.water_points_failed;
  message.largest_dropped_force = c.largest_dropped_force;
  message.largest_dropped_torque = c.largest_dropped_torque;
  message.latency_p50 = status.latency.p50;
  message.latency_p99 = status.latency.p99;
  message.latency_p999 = status.latency.p999;
  message.latency_max = status.latency.max;
  message.queue_wait = status.queue_wait;
  return encoded_by_lcm(message);
}

ByteVector with_version(const std::string& version, const std::string& scene = "",
                        const std::string& injected_faults = "") {
  ServiceStatus status;
  status.version = version;
  status.scene = scene;
  status.injected_faults = injected_faults;
  return encoded(status);
}

RC_GTEST_PROP(ServiceStatus, EncodesAndDecodesLikeGeneratedCode, ()) {
  const ServiceStatus status = random_status();
  const ByteVector bytes = encoded_by_lcm(status);
  RC_ASSERT(encoded(status) == bytes);
  ServiceStatus decoded = random_status();
  RC_ASSERT(!decode(bytes, decoded).has_value());
  RC_ASSERT(encoded_by_lcm(decoded) == bytes);
}

TEST(ServiceStatus, MapsSimdTargetsToWireConstants) {
  const auto value = [](const char* name) { return static_cast<std::int32_t>(simd_target_from_name(name)); };
  EXPECT_EQ(value("SCALAR"), service_status_t::SIMD_SCALAR);
  EXPECT_EQ(value("SSSE3"), service_status_t::SIMD_SSSE3);
  EXPECT_EQ(value("SSE4"), service_status_t::SIMD_SSE4);
  EXPECT_EQ(value("AVX2"), service_status_t::SIMD_AVX2);
  EXPECT_EQ(value("AVX3"), service_status_t::SIMD_AVX3);
  EXPECT_EQ(value("AVX3_DL"), service_status_t::SIMD_AVX3);
  EXPECT_EQ(value("AVX3_ZEN4"), service_status_t::SIMD_AVX3);
  EXPECT_EQ(value("NEON"), service_status_t::SIMD_NEON);
  EXPECT_EQ(value("Z80"), service_status_t::SIMD_OTHER);
}

TEST(ServiceStatus, MapsModesToWireConstants) {
  EXPECT_EQ(static_cast<std::int32_t>(ServiceMode::kLockstep), service_status_t::MODE_LOCKSTEP);
  EXPECT_EQ(static_cast<std::int32_t>(ServiceMode::kLatest), service_status_t::MODE_LATEST);
}

TEST(ServiceStatus, RejectsEveryTruncation) {
  const ByteVector whole = with_version("1.2.3");
  const std::size_t shortest = kVersionLength + 3 * kEmptyString + kTrailer;
  ServiceStatus status;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), status),
              size < shortest ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
}

TEST(ServiceStatus, RejectsInvalidStringLengths) {
  struct Case {
    std::int32_t length;
    DecodeError expected;
  };
  constexpr std::size_t kSceneLength = kVersionLength + 4 + 6;
  constexpr std::size_t kFaultsLength = kSceneLength + 4 + 6;
  for (const std::size_t offset : {kVersionLength, kSceneLength, kFaultsLength}) {
    for (const Case& c :
         {Case{0, DecodeError::kCount}, Case{-1, DecodeError::kCount}, Case{INT_MIN, DecodeError::kCount},
          Case{1, DecodeError::kLength}, Case{5, DecodeError::kLength}, Case{7, DecodeError::kLength},
          Case{INT_MAX, DecodeError::kLength}}) {
      ByteVector bytes = with_version("1.2.3", "scene", "seeds");
      BigEndianWriter{bytes.data() + offset}(c.length);
      ServiceStatus status;
      EXPECT_EQ(decode(bytes, status), c.expected) << c.length;
    }
  }
}

TEST(ServiceStatus, RejectsMisplacedStringTerminator) {
  ServiceStatus status;
  for (const std::size_t text : {kVersionLength + 4, kVersionLength + 4 + 6 + 4}) {
    ByteVector no_nul = with_version("1.2.3", "scene");
    no_nul[text + 5] = 'x';
    EXPECT_EQ(decode(no_nul, status), DecodeError::kLength);
    ByteVector early_nul = with_version("1.2.3", "scene");
    early_nul[text + 2] = 0;
    EXPECT_EQ(decode(early_nul, status), DecodeError::kLength);
  }
}

TEST(ServiceStatus, StaysUnchangedByTrailingBytesAndOtherFingerprints) {
  ServiceStatus status;
  ASSERT_FALSE(decode(with_version("kept"), status).has_value());
  ByteVector longer = with_version("1.2.3");
  longer.push_back(0);
  EXPECT_EQ(decode(longer, status), DecodeError::kLength);
  ByteVector foreign = with_version("1.2.3");
  foreign[3] ^= 1U;
  EXPECT_EQ(decode(foreign, status), DecodeError::kFingerprint);
  EXPECT_EQ(encoded(status), with_version("kept"));
}

TEST(ServiceStatus, DoesNotAllocateAfterWarmUp) {
  const ByteVector whole = with_version("a version that is too long for the small-string optimisation",
                                        "a scene that is too long for the small-string optimisation",
                                        "faults that are too long for the small-string optimisation");
  ServiceStatus status;
  ByteVector bytes;
  ASSERT_FALSE(decode(whole, status).has_value());
  encode(status, bytes);
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(decode(whole, status).has_value());
    encode(status, bytes);
    ASSERT_EQ(bytes, whole);
  }
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ServiceCounters, SumsRejectionsOverCauses) {
  ServiceCounters counters;
  std::int64_t place = 1;
  for (std::int64_t* cause :
       {&counters.rejected_truncated, &counters.rejected_fingerprint, &counters.rejected_count,
        &counters.rejected_length, &counters.rejected_bodies, &counters.rejected_points,
        &counters.rejected_work, &counters.rejected_busy, &counters.rejected_memory}) {
    *cause = place;
    place *= 10;
  }
  EXPECT_EQ(counters.rejected(), 111'111'111);
}

TEST(ServiceCounters, AddsTotalsAndTakesTheLargest) {
  ServiceCounters one;
  LayoutSize visited;
  visit_counters([&visited](const Field& /*field*/, auto& counter) { visited(counter); }, one);
  EXPECT_EQ(visited.size(), sizeof(ServiceCounters));
  ServiceCounters sum;
  std::int64_t number = 0;
  const auto number_them = [&number](const Field& /*field*/, auto& first, auto& second) {
    first = static_cast<std::decay_t<decltype(first)>>(++number);
    second = 100 * first;
  };
  visit_counters(number_them, one, sum);
  sum.largest_dropped_torque = 0.5 * one.largest_dropped_torque;
  const double force = sum.largest_dropped_force;
  sum += one;
  EXPECT_EQ(sum.largest_dropped_force, force);
  EXPECT_EQ(sum.largest_dropped_torque, one.largest_dropped_torque);
  number = 0;
  const auto expect_added = [&number](const Field& field, const auto& added) {
    ++number;
    if constexpr (std::is_same_v<std::decay_t<decltype(added)>, std::int64_t>) {
      EXPECT_EQ(added, 101 * number) << field.name;
    }
  };
  visit_counters(expect_added, sum);
}

}  // namespace
}  // namespace buoyancy
