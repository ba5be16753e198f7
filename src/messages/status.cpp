#include "messages/status.h"

#include <algorithm>

#include <buoyancy/service_status_t.hpp>

#include "messages/layout.h"

namespace buoyancy {
namespace {

struct FixedSizes {
  std::size_t before_version;  // with the fingerprint and the version's length
  std::size_t after_version;
};

FixedSizes fixed_sizes(const ServiceStatus& status) {
  LayoutSize before;
  before(std::int64_t{}, std::int32_t{});
  visit_head(status, before);
  LayoutSize after;
  visit_tail(status, after);
  return {before.size(), after.size()};
}

}  // namespace

Counters& Counters::operator+=(const Counters& other) {
  questions += other.questions;
  answered += other.answered;
  repeated += other.repeated;
  changed_repeats += other.changed_repeats;
  stale += other.stale;
  overtaken += other.overtaken;
  sessions += other.sessions;
  sessions_forgotten += other.sessions_forgotten;
  rejected_truncated += other.rejected_truncated;
  rejected_fingerprint += other.rejected_fingerprint;
  rejected_count += other.rejected_count;
  rejected_length += other.rejected_length;
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i] += other.bodies[i];
  quaternions_normalised += other.quaternions_normalised;
  bodies_dry += other.bodies_dry;
  bodies_wet += other.bodies_wet;
  bodies_crossing += other.bodies_crossing;
  bodies_unchanged += other.bodies_unchanged;
  hydrostatics += other.hydrostatics;
  largest_dropped_force = std::max(largest_dropped_force, other.largest_dropped_force);
  largest_dropped_torque = std::max(largest_dropped_torque, other.largest_dropped_torque);
  return *this;
}

SimdTarget simd_target_from_name(std::string_view name) {
  if (name == "SCALAR") return SimdTarget::kScalar;
  if (name == "SSSE3") return SimdTarget::kSsse3;
  if (name == "SSE4") return SimdTarget::kSse4;
  if (name == "AVX2") return SimdTarget::kAvx2;
  if (name == "AVX3" || name == "AVX3_DL") return SimdTarget::kAvx3;
  if (name == "NEON") return SimdTarget::kNeon;
  return SimdTarget::kOther;
}

void encode(const ServiceStatus& status, std::vector<std::uint8_t>& bytes) {
  const FixedSizes sizes = fixed_sizes(status);
  const std::size_t version_size = status.version.size() + 1;
  bytes.resize(sizes.before_version + version_size + sizes.after_version);
  BigEndianWriter writer(bytes.data());
  writer(service_status_t::getHash());
  visit_head(status, writer);
  writer(static_cast<std::int32_t>(version_size));
  std::memcpy(writer.position(), status.version.c_str(), version_size);
  writer.skip(version_size);
  visit_tail(status, writer);
}

std::optional<Rejection> decode(Bytes bytes, ServiceStatus& status) {
  const FixedSizes sizes = fixed_sizes(status);
  const std::size_t shortest_version = 1;
  if (bytes.size() < sizes.before_version + shortest_version + sizes.after_version) {
    return Rejection::kTruncated;
  }
  std::int64_t fingerprint = 0;
  BigEndianReader reader(bytes.data());
  reader(fingerprint);
  if (fingerprint != service_status_t::getHash()) return Rejection::kFingerprint;
  std::int32_t version_size = 0;
  BigEndianReader{bytes.data() + sizes.before_version - sizeof(version_size)}(version_size);
  if (version_size < static_cast<std::int32_t>(shortest_version)) return Rejection::kCount;
  const auto length = static_cast<std::size_t>(version_size) - 1;
  if (bytes.size() != sizes.before_version + length + 1 + sizes.after_version) return Rejection::kLength;
  const Bytes version = bytes.subspan(sizes.before_version, length + 1);
  const auto first_nul = std::find(version.begin(), version.end(), std::uint8_t{0});
  if (first_nul != version.end() - 1) return Rejection::kLength;

  visit_head(status, reader);
  reader.skip(sizeof(version_size));
  status.version.assign(reinterpret_cast<const char*>(version.data()), length);
  reader.skip(version.size());
  visit_tail(status, reader);
  return std::nullopt;
}

}  // namespace buoyancy
