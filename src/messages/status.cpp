#include "messages/status.h"

#include <algorithm>

#include <buoyancy/service_status_t.hpp>

#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

struct FixedSizes {
  std::size_t before_strings;  // including the fingerprint
  std::size_t strings;         // with every string empty
  std::size_t after_strings;
};

constexpr std::size_t kEmptyString = sizeof(std::int32_t) + 1;

FixedSizes fixed_sizes(const ServiceStatus& status) {
  LayoutSize before;
  before(std::int64_t{});
  visit_header(status, before);
  std::size_t strings = 0;
  visit_strings(status, [&strings](const std::string& /*text*/) { strings += kEmptyString; });
  LayoutSize after;
  visit_trailer(status, after);
  return {before.size(), strings, after.size()};
}

// Decodes the string at the front of bytes and removes it from bytes.
tl::expected<std::string_view, DecodeError> consume_string(Bytes& bytes) {
  std::int32_t size = 0;  // including the final NUL
  if (bytes.size() < kEmptyString) return tl::unexpected(DecodeError::kLength);
  BigEndianReader{bytes.data()}(size);
  bytes = bytes.subspan(sizeof(size));
  if (size < 1) return tl::unexpected(DecodeError::kCount);
  if (static_cast<std::size_t>(size) > bytes.size()) return tl::unexpected(DecodeError::kLength);
  const Bytes text = bytes.first(static_cast<std::size_t>(size));
  bytes = bytes.subspan(text.size());
  const auto first_nul = std::find(text.begin(), text.end(), std::uint8_t{0});
  if (first_nul != text.end() - 1) return tl::unexpected(DecodeError::kLength);
  return std::string_view(reinterpret_cast<const char*>(text.data()), text.size() - 1);
}

struct AddCounter {
  void operator()(const Field& /*field*/, std::int64_t& total, std::int64_t value) const { total += value; }
  void operator()(const Field& /*field*/, double& largest, double value) const {
    largest = std::max(largest, value);
  }
};

}  // namespace

ServiceCounters& ServiceCounters::operator+=(const ServiceCounters& other) {
  visit_counters(AddCounter{}, *this, other);
  return *this;
}

SimdTarget simd_target_from_name(std::string_view name) {
  if (name == "SCALAR") return SimdTarget::kScalar;
  if (name == "SSSE3") return SimdTarget::kSsse3;
  if (name == "SSE4") return SimdTarget::kSse4;
  if (name == "AVX2") return SimdTarget::kAvx2;
  if (name.starts_with("AVX3")) return SimdTarget::kAvx3;
  if (name == "NEON") return SimdTarget::kNeon;
  return SimdTarget::kOther;
}

void encode(const ServiceStatus& status, std::vector<std::uint8_t>& bytes) {
  const FixedSizes sizes = fixed_sizes(status);
  std::size_t characters = 0;
  visit_strings(status, [&characters](const std::string& text) { characters += text.size(); });
  bytes.resize(sizes.before_strings + sizes.strings + characters + sizes.after_strings);
  BigEndianWriter writer(bytes.data());
  writer(service_status_t::getHash());
  visit_header(status, writer);
  visit_strings(status, [&writer](const std::string& text) {
    const std::size_t size = text.size() + 1;
    writer(static_cast<std::int32_t>(size));
    std::memcpy(writer.position(), text.c_str(), size);
    writer.skip(size);
  });
  visit_trailer(status, writer);
}

std::optional<DecodeError> decode(Bytes bytes, ServiceStatus& status) {
  const FixedSizes sizes = fixed_sizes(status);
  if (bytes.size() < sizes.before_strings + sizes.strings + sizes.after_strings)
    return DecodeError::kTruncated;
  std::int64_t fingerprint = 0;
  BigEndianReader reader(bytes.data());
  reader(fingerprint);
  if (fingerprint != service_status_t::getHash()) return DecodeError::kFingerprint;
  const Bytes strings =
      bytes.subspan(sizes.before_strings, bytes.size() - sizes.before_strings - sizes.after_strings);
  Bytes remaining = strings;
  std::optional<DecodeError> error;
  visit_strings(status, [&](const std::string& /*text*/) {
    if (error) return;
    if (const auto text = consume_string(remaining); !text) error = text.error();
  });
  if (!error && !remaining.empty()) error = DecodeError::kLength;
  if (error) return error;

  visit_header(status, reader);
  remaining = strings;
  visit_strings(status, [&remaining](std::string& text) { text.assign(*consume_string(remaining)); });
  reader.skip(strings.size());
  visit_trailer(status, reader);
  return std::nullopt;
}

}  // namespace buoyancy
