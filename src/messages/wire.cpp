#include "messages/wire.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>
#include <utility>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/bodies_loads_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <buoyancy/water_points_t.hpp>
#include <buoyancy/water_samples_t.hpp>

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
  if constexpr (std::is_same_v<Message, WaterPoints>) return water_points_t::getHash();
  if constexpr (std::is_same_v<Message, WaterSamples>) return water_samples_t::getHash();
}

// What a message has a number of.
template <typename Message>
auto& elements_of(Message& message) {
  if constexpr (std::is_same_v<Message, WaterPoints>) {
    return message.points;
  } else if constexpr (std::is_same_v<Message, WaterSamples>) {
    return message.samples;
  } else {
    return message.bodies;
  }
}

// Size [bytes] of everything before the first element: fingerprint, header, number of elements.
template <typename Message>
std::size_t fixed_size() {
  const Message message;
  LayoutSize layout;
  layout(std::int64_t{}, std::int32_t{});
  visit_header(message, layout);
  return layout.size();
}

template <typename Message>
std::size_t element_size() {
  using Elements = std::remove_reference_t<decltype(elements_of(std::declval<Message&>()))>;
  return encoded_element_size<typename Elements::value_type>();
}

template <typename Message>
std::size_t encoded_size(std::size_t elements) {
  return fixed_size<Message>() + elements * element_size<Message>();
}

std::int64_t fingerprint_in(Bytes bytes) {
  std::int64_t fingerprint = 0;
  BigEndianReader{bytes.data()}(fingerprint);
  return fingerprint;
}

// Returns the number of elements.
template <typename Message>
tl::expected<std::size_t, DecodeError> validate(Bytes bytes) {
  const std::size_t fixed = fixed_size<Message>();
  if (bytes.size() < fixed) return tl::unexpected(DecodeError::kTruncated);
  if (fingerprint_in(bytes) != fingerprint<Message>()) return tl::unexpected(DecodeError::kFingerprint);
  std::int32_t count = 0;
  BigEndianReader{bytes.data() + fixed - sizeof(count)}(count);
  if (count < 0) return tl::unexpected(DecodeError::kCount);
  const auto elements = static_cast<std::size_t>(count);
  const std::size_t rest = bytes.size() - fixed;
  if (rest % element_size<Message>() != 0 || rest / element_size<Message>() != elements) {
    return tl::unexpected(DecodeError::kLength);
  }
  return elements;
}

template <typename Message>
Message read_header(Bytes bytes) {
  Message message;
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_header(message, reader);
  return message;
}

template <typename Message>
std::optional<DecodeError> decode_message(Bytes bytes, Message& message) {
  const auto count = validate<Message>(bytes);
  if (!count) return count.error();
  BigEndianReader reader(bytes.data() + sizeof(std::int64_t));
  visit_header(message, reader);
  auto& elements = elements_of(message);
  elements.resize(*count);
  const std::uint8_t* const first = bytes.data() + fixed_size<Message>();
  if constexpr (std::is_same_v<Message, WaterSamples>) {
    for (std::size_t i = 0; i < *count; ++i) {
      ArrayFields<BigEndianReader, const std::uint8_t> of_element(first, *count, i);
      visit_fields(elements[i], of_element);
    }
  } else {
    BigEndianReader of_elements(first);
    for (auto& element : elements) visit_fields(element, of_elements);
  }
  return std::nullopt;
}

// Replaces bytes by the fixed fields of `message` and room for this number of elements, whatever its own are.
// Returns the address of the first element.
template <typename Message>
std::uint8_t* encode_fixed(const Message& message, std::size_t elements, std::vector<std::uint8_t>& bytes) {
  assert(elements <= std::numeric_limits<std::int32_t>::max());
  const std::size_t size = encoded_size<Message>(elements);
  if (size > bytes.capacity()) bytes.clear();  // a vector that is not empty would grow to twice its size
  bytes.resize(size);
  BigEndianWriter writer(bytes.data());
  writer(fingerprint<Message>());
  visit_header(message, writer);
  writer(static_cast<std::int32_t>(elements));
  return bytes.data() + fixed_size<Message>();
}

// fixed: the message that holds the other fields; its own elements are not used.
template <typename Message, typename Elements>
void encode_message(const Message& fixed, const Elements& elements, std::vector<std::uint8_t>& bytes) {
  BigEndianWriter writer(encode_fixed(fixed, elements.size(), bytes));
  for (const auto& element : elements) visit_fields(element, writer);
}

// The number of elements of a message that encode_fixed() has begun.
template <typename Message>
std::size_t size_of_begun(const std::vector<std::uint8_t>& bytes) {
  return (bytes.size() - fixed_size<Message>()) / element_size<Message>();
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
std::optional<DecodeError> decode(Bytes bytes, WaterPoints& points) {
  return decode_message(bytes, points);
}
std::optional<DecodeError> decode(Bytes bytes, WaterSamples& samples) {
  return decode_message(bytes, samples);
}

tl::expected<RequestId, DecodeError> peek_request_id(Bytes bytes) {
  const auto view = RequestView::of(bytes);
  if (!view) return tl::unexpected(view.error());
  return view->id();
}

tl::expected<RequestHeader, DecodeError> peek_request(Bytes bytes) {
  const bool is_points =
      bytes.size() >= fixed_size<WaterPoints>() && fingerprint_in(bytes) == fingerprint<WaterPoints>();
  const auto size = is_points ? validate<WaterPoints>(bytes) : validate<WrenchRequest>(bytes);
  if (!size) return tl::unexpected(size.error());
  if (is_points) {
    return RequestHeader{RequestKind::kWaterPoints, read_header<WaterPoints>(bytes).id, 0.0, *size};
  }
  const auto fixed = read_header<WrenchRequest>(bytes);
  return RequestHeader{RequestKind::kBodies, fixed.id, fixed.lead_time, *size};
}

tl::expected<RequestView, DecodeError> RequestView::of(Bytes bytes) {
  const auto bodies = validate<WrenchRequest>(bytes);
  if (!bodies) return tl::unexpected(bodies.error());
  const auto fixed = read_header<WrenchRequest>(bytes);
  RequestView view;
  view.id_ = fixed.id;
  view.lead_time_ = fixed.lead_time;
  view.size_ = *bodies;
  view.bodies_ = bytes.data() + fixed_size<WrenchRequest>();
  return view;
}

tl::expected<WaterPointsView, DecodeError> WaterPointsView::of(Bytes bytes) {
  const auto points = validate<WaterPoints>(bytes);
  if (!points) return tl::unexpected(points.error());
  return WaterPointsView(bytes.data() + fixed_size<WaterPoints>(), *points);
}

template <typename Message>
BodiesWriter<Message>::BodiesWriter(const RequestId& id, std::size_t bodies, std::vector<std::uint8_t>& bytes)
    : size_(bodies), bodies_(encode_fixed(Message{.id = id, .bodies = {}}, bodies, bytes)) {}

template <typename Message>
BodiesWriter<Message>::BodiesWriter(std::vector<std::uint8_t>& begun)
    : size_(size_of_begun<Message>(begun)), bodies_(begun.data() + fixed_size<Message>()) {}

template class BodiesWriter<WrenchResponse>;
template class BodiesWriter<BodiesHydrostatics>;
template class BodiesWriter<BodiesLoads>;

WaterSamplesWriter::WaterSamplesWriter(const RequestId& id, std::size_t samples,
                                       std::vector<std::uint8_t>& bytes)
    : size_(samples), samples_(encode_fixed(WaterSamples{.id = id, .samples = {}}, samples, bytes)) {}

WaterSamplesWriter::WaterSamplesWriter(std::vector<std::uint8_t>& begun)
    : size_(size_of_begun<WaterSamples>(begun)), samples_(begun.data() + fixed_size<WaterSamples>()) {}

void WaterSamplesWriter::fail(BodyStatus status) {
  // Before the samples come the status and their number.
  BigEndianWriter(samples_ - sizeof(std::int32_t) - sizeof(status))(status);
  std::fill_n(samples_, size_ * element_size<WaterSamples>(), std::uint8_t{0});
}

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
std::size_t water_points_size(std::size_t points) {
  return encoded_size<WaterPoints>(points);
}
std::size_t water_samples_size(std::size_t points) {
  return encoded_size<WaterSamples>(points);
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
void encode(const BorrowedWaterPoints& points, std::vector<std::uint8_t>& bytes) {
  encode_message(WaterPoints{.id = points.id, .points = {}}, points.points, bytes);
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
