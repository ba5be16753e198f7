#include "messages/condition_change.h"

#include <buoyancy/body_condition_t.hpp>

#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

static_assert(static_cast<std::int32_t>(ConditionKind::kCompartment) == body_condition_t::COMPARTMENT);
static_assert(static_cast<std::int32_t>(ConditionKind::kTank) == body_condition_t::TANK);

std::size_t encoded_size() {
  const ConditionChange change;
  LayoutSize layout;
  layout(std::int64_t{});
  visit_fields(change, layout);
  return layout.size();
}

}  // namespace

void encode(const ConditionChange& change, std::vector<std::uint8_t>& bytes) {
  bytes.resize(encoded_size());
  BigEndianWriter writer(bytes.data());
  writer(body_condition_t::getHash());
  visit_fields(change, writer);
}

std::optional<DecodeError> decode(Bytes bytes, ConditionChange& change) {
  if (bytes.size() < encoded_size()) return DecodeError::kTruncated;
  std::int64_t fingerprint = 0;
  BigEndianReader reader(bytes.data());
  reader(fingerprint);
  if (fingerprint != body_condition_t::getHash()) return DecodeError::kFingerprint;
  if (bytes.size() != encoded_size()) return DecodeError::kLength;
  visit_fields(change, reader);
  return std::nullopt;
}

}  // namespace buoyancy
