#include "messages/wire.h"

#include <cassert>
#include <limits>
#include <type_traits>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>

#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

// Taken from the generated types, so that it follows the .lcm files.
template <typename Message>
std::int64_t fingerprint() {
  if constexpr (std::is_same_v<Message, Question>) return body_states_t::getHash();
  if constexpr (std::is_same_v<Message, Answer>) return body_wrenches_t::getHash();
  if constexpr (std::is_same_v<Message, BodiesHydrostatics>) return bodies_hydrostatics_t::getHash();
}

// Bytes before the first body: fingerprint, head, number of bodies.
template <typename Message>
std::size_t fixed_size() {
  const Message message;
  LayoutSize layout;
  layout(std::int64_t{}, std::int32_t{});
  visit_head(message, layout);
  return layout.size();
}

template <typename Message>
std::size_t body_size() {
  const typename decltype(Message::bodies)::value_type body;
  LayoutSize layout;
  visit_fields(body, layout);
  return layout.size();
}

// The number of bodies, or what is wrong.
template <typename Message>
tl::expected<std::size_t, Rejection> validate(Bytes bytes) {
  const std::size_t fixed = fixed_size<Message>();
  if (bytes.size() < fixed) return tl::unexpected(Rejection::kTruncated);
  std::int64_t found_fingerprint = 0;
  BigEndianReader{bytes.data()}(found_fingerprint);
  if (found_fingerprint != fingerprint<Message>()) return tl::unexpected(Rejection::kFingerprint);
  std::int32_t count = 0;
  BigEndianReader{bytes.data() + fixed - sizeof(count)}(count);
  if (count < 0) return tl::unexpected(Rejection::kCount);
  const auto bodies = static_cast<std::size_t>(count);
  const std::size_t rest = bytes.size() - fixed;
  if (rest % body_size<Message>() != 0 || rest / body_size<Message>() != bodies) {
    return tl::unexpected(Rejection::kLength);
  }
  return bodies;
}

template <typename Message>
std::optional<Rejection> decode_message(Bytes bytes, Message& message) {
  const auto bodies = validate<Message>(bytes);
  if (!bodies) return bodies.error();
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_head(message, reader);
  reader.skip(sizeof(std::int32_t));
  message.bodies.resize(*bodies);
  for (auto& body : message.bodies) visit_fields(body, reader);
  return std::nullopt;
}

template <typename Message>
void encode_message(const Message& message, std::vector<std::uint8_t>& bytes) {
  assert(message.bodies.size() <= std::numeric_limits<std::int32_t>::max());
  bytes.resize(fixed_size<Message>() + message.bodies.size() * body_size<Message>());
  BigEndianWriter writer(bytes.data());
  writer(fingerprint<Message>());
  visit_head(message, writer);
  writer(static_cast<std::int32_t>(message.bodies.size()));
  for (const auto& body : message.bodies) visit_fields(body, writer);
}

}  // namespace

const char* describe(Rejection rejection) {
  switch (rejection) {
    case Rejection::kTruncated:
      return "shorter than the fixed fields";
    case Rejection::kFingerprint:
      return "fingerprint of another type or version";
    case Rejection::kCount:
      return "negative count";
    case Rejection::kLength:
      return "length does not fit the count";
  }
  return "unknown reason";
}

std::optional<Rejection> decode(Bytes bytes, Question& question) {
  return decode_message(bytes, question);
}
std::optional<Rejection> decode(Bytes bytes, Answer& answer) {
  return decode_message(bytes, answer);
}
std::optional<Rejection> decode(Bytes bytes, BodiesHydrostatics& hydrostatics) {
  return decode_message(bytes, hydrostatics);
}

tl::expected<QuestionKey, Rejection> peek_key(Bytes bytes) {
  const auto bodies = validate<Question>(bytes);
  if (!bodies) return tl::unexpected(bodies.error());
  QuestionKey key;
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_fields(key, reader);
  return key;
}

void encode(const Question& question, std::vector<std::uint8_t>& bytes) {
  encode_message(question, bytes);
}
void encode(const Answer& answer, std::vector<std::uint8_t>& bytes) {
  encode_message(answer, bytes);
}
void encode(const BodiesHydrostatics& hydrostatics, std::vector<std::uint8_t>& bytes) {
  encode_message(hydrostatics, bytes);
}

}  // namespace buoyancy
