#include "messages/wire.h"

#include <cassert>
#include <limits>
#include <type_traits>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/bodies_loads_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>

#include "messages/wire_layout.h"
#include "messages/wire_views.h"

namespace buoyancy {
namespace {

// The generated types supply the fingerprint, so that it follows the .lcm files.
template <typename Message>
std::int64_t fingerprint() {
  if constexpr (std::is_same_v<Message, WrenchRequest>) return body_states_t::getHash();
  if constexpr (std::is_same_v<Message, WrenchResponse>) return body_wrenches_t::getHash();
  if constexpr (std::is_same_v<Message, BodiesHydrostatics>) return bodies_hydrostatics_t::getHash();
  if constexpr (std::is_same_v<Message, BodiesLoads>) return bodies_loads_t::getHash();
}

// Size [bytes] of everything before the first body: fingerprint, header, number of bodies.
template <typename Message>
std::size_t fixed_size() {
  const Message message;
  LayoutSize layout;
  layout(std::int64_t{}, std::int32_t{});
  visit_header(message, layout);
  return layout.size();
}

template <typename Message>
std::size_t body_size() {
  return encoded_body_size<typename decltype(Message::bodies)::value_type>();
}

template <typename Message>
std::size_t encoded_size(std::size_t bodies) {
  return fixed_size<Message>() + bodies * body_size<Message>();
}

// Returns the number of bodies.
template <typename Message>
tl::expected<std::size_t, DecodeError> validate(Bytes bytes) {
  const std::size_t fixed = fixed_size<Message>();
  if (bytes.size() < fixed) return tl::unexpected(DecodeError::kTruncated);
  std::int64_t actual_fingerprint = 0;
  BigEndianReader{bytes.data()}(actual_fingerprint);
  if (actual_fingerprint != fingerprint<Message>()) return tl::unexpected(DecodeError::kFingerprint);
  std::int32_t count = 0;
  BigEndianReader{bytes.data() + fixed - sizeof(count)}(count);
  if (count < 0) return tl::unexpected(DecodeError::kCount);
  const auto bodies = static_cast<std::size_t>(count);
  const std::size_t rest = bytes.size() - fixed;
  if (rest % body_size<Message>() != 0 || rest / body_size<Message>() != bodies) {
    return tl::unexpected(DecodeError::kLength);
  }
  return bodies;
}

template <typename Message>
std::optional<DecodeError> decode_message(Bytes bytes, Message& message) {
  const auto bodies = validate<Message>(bytes);
  if (!bodies) return bodies.error();
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_header(message, reader);
  reader.skip(sizeof(std::int32_t));
  message.bodies.resize(*bodies);
  for (auto& body : message.bodies) visit_fields(body, reader);
  return std::nullopt;
}

// Replaces bytes by the fixed fields of `message` and room for this number of bodies, whatever its own are.
// Returns the address of the first body.
template <typename Message>
std::uint8_t* encode_fixed(const Message& message, std::size_t bodies, std::vector<std::uint8_t>& bytes) {
  assert(bodies <= std::numeric_limits<std::int32_t>::max());
  const std::size_t size = encoded_size<Message>(bodies);
  if (size > bytes.capacity()) bytes.clear();  // a vector that is not empty would grow to twice its size
  bytes.resize(size);
  BigEndianWriter writer(bytes.data());
  writer(fingerprint<Message>());
  visit_header(message, writer);
  writer(static_cast<std::int32_t>(bodies));
  return bytes.data() + fixed_size<Message>();
}

// fixed: the message that holds the other fields; its own bodies are not used.
template <typename Message, typename Bodies>
void encode_message(const Message& fixed, const Bodies& bodies, std::vector<std::uint8_t>& bytes) {
  BigEndianWriter writer(encode_fixed(fixed, bodies.size(), bytes));
  for (const auto& body : bodies) visit_fields(body, writer);
}

}  // namespace

const char* to_string(DecodeError error) {
  switch (error) {
    case DecodeError::kTruncated:
      return "shorter than the fixed fields";
    case DecodeError::kFingerprint:
      return "fingerprint of another type or version";
    case DecodeError::kCount:
      return "count out of range";
    case DecodeError::kLength:
      return "length does not fit the count";
  }
  return "unknown reason";
}

std::optional<DecodeError> decode(Bytes bytes, WrenchRequest& request) {
  return decode_message(bytes, request);
}
std::optional<DecodeError> decode(Bytes bytes, WrenchResponse& response) {
  return decode_message(bytes, response);
}
std::optional<DecodeError> decode(Bytes bytes, BodiesHydrostatics& hydrostatics) {
  return decode_message(bytes, hydrostatics);
}
std::optional<DecodeError> decode(Bytes bytes, BodiesLoads& loads) {
  return decode_message(bytes, loads);
}

tl::expected<RequestId, DecodeError> peek_request_id(Bytes bytes) {
  const auto view = RequestView::of(bytes);
  if (!view) return tl::unexpected(view.error());
  return view->id();
}

tl::expected<RequestView, DecodeError> RequestView::of(Bytes bytes) {
  const auto bodies = validate<WrenchRequest>(bytes);
  if (!bodies) return tl::unexpected(bodies.error());
  WrenchRequest fixed;
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_header(fixed, reader);
  RequestView view;
  view.id_ = fixed.id;
  view.lead_time_ = fixed.lead_time;
  view.size_ = *bodies;
  view.bodies_ = bytes.data() + fixed_size<WrenchRequest>();
  return view;
}

template <typename Message>
BodiesWriter<Message>::BodiesWriter(const RequestId& id, std::size_t bodies, std::vector<std::uint8_t>& bytes)
    : size_(bodies), bodies_(encode_fixed(Message{.id = id, .bodies = {}}, bodies, bytes)) {}

template <typename Message>
BodiesWriter<Message>::BodiesWriter(std::vector<std::uint8_t>& begun)
    : size_((begun.size() - fixed_size<Message>()) / body_size<Message>()),
      bodies_(begun.data() + fixed_size<Message>()) {}

template class BodiesWriter<WrenchResponse>;
template class BodiesWriter<BodiesHydrostatics>;
template class BodiesWriter<BodiesLoads>;

std::size_t request_size(std::size_t bodies) {
  return encoded_size<WrenchRequest>(bodies);
}
std::size_t response_size(std::size_t bodies) {
  return encoded_size<WrenchResponse>(bodies);
}
std::size_t hydrostatics_size(std::size_t bodies) {
  return encoded_size<BodiesHydrostatics>(bodies);
}
std::size_t loads_size(std::size_t bodies) {
  return encoded_size<BodiesLoads>(bodies);
}

void encode(const BorrowedRequest& request, std::vector<std::uint8_t>& bytes) {
  encode_message(WrenchRequest{.id = request.id, .lead_time = request.lead_time, .bodies = {}},
                 request.bodies, bytes);
}
void encode(const WrenchResponse& response, std::vector<std::uint8_t>& bytes) {
  encode_message(response, response.bodies, bytes);
}
void encode(const BodiesHydrostatics& hydrostatics, std::vector<std::uint8_t>& bytes) {
  encode_message(hydrostatics, hydrostatics.bodies, bytes);
}
void encode(const BodiesLoads& loads, std::vector<std::uint8_t>& bytes) {
  encode_message(loads, loads.bodies, bytes);
}

RequestId response_id(Bytes bytes) {
  RequestId id;
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_fields(id, reader);
  return id;
}

void set_response_seq(std::int64_t seq, std::span<std::uint8_t> bytes) {
  BigEndianWriter{bytes.data() + kResponseHeaderSize - sizeof(seq)}(seq);
}

}  // namespace buoyancy
