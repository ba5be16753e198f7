#include "messages/wire.h"

#include <algorithm>
#include <climits>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <utility>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/bodies_loads_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "messages/wire_views.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

template <std::size_t kSize>
void copy(const std::array<double, kSize>& from, double (&to)[kSize]) {
  std::copy(from.begin(), from.end(), to);
}

template <std::size_t kRows, std::size_t kColumns>
void copy(const std::array<std::array<double, kColumns>, kRows>& from, double (&to)[kRows][kColumns]) {
  for (std::size_t row = 0; row < kRows; ++row) copy(from[row], to[row]);
}

template <typename Generated, typename Message>
Generated with_header_of(const Message& message) {
  Generated generated{};
  generated.utime = message.id.utime;
  generated.session_id = message.id.session_id;
  generated.seq = message.id.seq;
  generated.num_bodies = static_cast<std::int32_t>(message.bodies.size());
  return generated;
}

body_states_t to_generated(const WrenchRequest& request) {
  auto message = with_header_of<body_states_t>(request);
  message.lead_time = request.lead_time;
  for (const BodyState& body : request.bodies) {
    body_state_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    copy(body.position, to.position);
    copy(body.quaternion_wxyz, to.quaternion_wxyz);
    copy(body.linear_velocity, to.linear_velocity);
    copy(body.angular_velocity, to.angular_velocity);
  }
  return message;
}

body_wrenches_t to_generated(const WrenchResponse& response) {
  auto message = with_header_of<body_wrenches_t>(response);
  for (const BodyWrench& body : response.bodies) {
    body_wrench_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    to.status = static_cast<std::int32_t>(body.status);
    copy(body.force, to.force);
    copy(body.torque, to.torque);
    to.submerged_volume = body.submerged_volume;
    copy(body.center_of_buoyancy, to.center_of_buoyancy);
    to.force_error_bound = body.force_error_bound;
    to.torque_error_bound = body.torque_error_bound;
  }
  return message;
}

bodies_hydrostatics_t to_generated(const BodiesHydrostatics& hydrostatics) {
  auto message = with_header_of<bodies_hydrostatics_t>(hydrostatics);
  for (const BodyHydrostatics& body : hydrostatics.bodies) {
    body_hydrostatics_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    to.status = static_cast<std::int32_t>(body.status);
    to.submerged_volume = body.submerged_volume;
    copy(body.center_of_buoyancy, to.center_of_buoyancy);
    to.wetted_area = body.wetted_area;
    to.waterplane_area = body.waterplane_area;
    copy(body.waterplane_centroid, to.waterplane_centroid);
    copy(body.waterplane_second_moments, to.waterplane_second_moments);
    copy(body.waterplane_axes, to.waterplane_axes);
    copy(body.metacentric_radii, to.metacentric_radii);
    copy(body.metacenters, to.metacenters);
    copy(body.metacentric_heights, to.metacentric_heights);
    copy(body.stiffness, to.stiffness);
  }
  return message;
}

bodies_loads_t to_generated(const BodiesLoads& loads) {
  auto message = with_header_of<bodies_loads_t>(loads);
  for (const BodyLoads& body : loads.bodies) {
    body_loads_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    to.status = static_cast<std::int32_t>(body.status);
    to.immersion = body.immersion;
    copy(body.buoyancy_force, to.buoyancy_force);
    copy(body.buoyancy_torque, to.buoyancy_torque);
    copy(body.drag_force, to.drag_force);
    copy(body.drag_torque, to.drag_torque);
    copy(body.added_mass_force, to.added_mass_force);
    copy(body.added_mass_torque, to.added_mass_torque);
    copy(body.added_mass, to.added_mass);
    copy(body.damping, to.damping);
    copy(body.water_velocity, to.water_velocity);
  }
  return message;
}

template <typename Message>
Message message_of(std::size_t bodies) {
  Message message;
  message.id = {.utime = -5, .session_id = 6, .seq = 7};
  message.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) message.bodies[i].body_id = static_cast<std::int32_t>(i);
  return message;
}

// The error of decode(), which whatever else reads requests must agree with.
template <typename Message>
std::optional<DecodeError> error_of(Bytes bytes, Message& message) {
  const std::optional<DecodeError> error = decode(bytes, message);
  if constexpr (std::is_same_v<Message, WrenchRequest>) {
    const auto id = peek_request_id(bytes);
    const auto view = RequestView::of(bytes);
    EXPECT_EQ(id ? std::nullopt : std::optional(id.error()), error);
    EXPECT_EQ(view ? std::nullopt : std::optional(view.error()), error);
  }
  return error;
}

template <typename Message>
void expect_codec_of_lcm() {
  const Message message = random_message<Message>();
  const ByteVector bytes = encoded_by_lcm(to_generated(message));
  RC_ASSERT(encoded(message) == bytes);
  Message decoded = random_message<Message>();  // whose content must not matter
  RC_ASSERT(!decode(bytes, decoded).has_value());
  RC_ASSERT(encoded_by_lcm(to_generated(decoded)) == bytes);
}

RC_GTEST_PROP(Wire, EncodesAndDecodesLikeGeneratedCode, ()) {
  expect_codec_of_lcm<WrenchRequest>();
  expect_codec_of_lcm<WrenchResponse>();
  expect_codec_of_lcm<BodiesHydrostatics>();
  expect_codec_of_lcm<BodiesLoads>();
}

template <typename Message>
void expect_decoded_or_rejected() {
  ByteVector bytes = encoded(random_message<Message>());
  bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 2));
  for (int flips = *rc::gen::inRange(0, 3); flips > 0 && !bytes.empty(); --flips) {
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] ^= 1U;
  }
  Message message = message_of<Message>(2);
  if (error_of(bytes, message)) {
    RC_ASSERT(encoded(message) == encoded(message_of<Message>(2)));  // unchanged
  } else {
    RC_ASSERT(encoded(message) == bytes);
  }
}

RC_GTEST_PROP(Wire, DecodesOrRejectsRandomBytes, ()) {
  expect_decoded_or_rejected<WrenchRequest>();
  expect_decoded_or_rejected<WrenchResponse>();
  expect_decoded_or_rejected<BodiesHydrostatics>();
  expect_decoded_or_rejected<BodiesLoads>();
}

RC_GTEST_PROP(RequestView, ReadsSameBodiesAsDecode, ()) {
  const auto request = random_message<WrenchRequest>();
  const ByteVector bytes = encoded(request);
  const auto id = peek_request_id(bytes);
  const auto view = RequestView::of(bytes);
  RC_ASSERT(id.has_value());
  RC_ASSERT(view.has_value());
  WrenchRequest read{.id = view->id(), .lead_time = view->lead_time(), .bodies = {}};
  for (std::size_t i = 0; i < view->size(); ++i) {
    read.bodies.push_back(view->body(i));
    RC_ASSERT(view->body_id(i) == request.bodies[i].body_id);
  }
  RC_ASSERT(encoded(read) == bytes);
  read.id = *id;
  RC_ASSERT(encoded(read) == bytes);
}

RC_GTEST_PROP(ResponseWriter, WritesSameBytesAsEncode, ()) {
  const auto response = random_message<WrenchResponse>();
  ByteVector bytes(*rc::gen::inRange<std::size_t>(0, 1000), 0xab);
  ResponseWriter writer(response.id, response.bodies.size(), bytes);
  for (std::size_t i = response.bodies.size(); i-- > 0;) writer.set(i, response.bodies[i]);
  RC_ASSERT(bytes == encoded(response));
  for (std::size_t i = 0; i < response.bodies.size(); ++i) {
    RC_ASSERT(encoded(WrenchResponse{.id = {}, .bodies = {writer.body(i)}}) ==
              encoded(WrenchResponse{.id = {}, .bodies = {response.bodies[i]}}));
  }
}

TEST(Wire, EncodesToSizesOfMessageDefinitions) {
  EXPECT_EQ(request_size(2), 44U + 2 * 108U);
  EXPECT_EQ(response_size(2), 36U + 2 * 104U);
  EXPECT_EQ(hydrostatics_size(2), 36U + 2 * 512U);
  EXPECT_EQ(loads_size(2), 36U + 2 * 760U);
}

std::size_t size_of(const WrenchRequest& message) {
  return request_size(message.bodies.size());
}
std::size_t size_of(const WrenchResponse& message) {
  return response_size(message.bodies.size());
}
std::size_t size_of(const BodiesHydrostatics& message) {
  return hydrostatics_size(message.bodies.size());
}
std::size_t size_of(const BodiesLoads& message) {
  return loads_size(message.bodies.size());
}

template <typename Message>
class WireMessage : public testing::Test {
 protected:
  const Message two_ = message_of<Message>(2);
  const ByteVector bytes_ = encoded(two_);
  const std::size_t fixed_ = size_of(Message{});
  const std::size_t body_ = size_of(message_of<Message>(1)) - fixed_;
  Message decoded_ = message_of<Message>(3);

  // An error, which must leave the message as it was, and must not allocate.
  DecodeError error(Bytes bytes) {
    const AllocationCount allocations;
    const std::optional<DecodeError> error = error_of(bytes, decoded_);
    EXPECT_EQ(allocations.count(), 0);
    EXPECT_EQ(encoded(decoded_), encoded(message_of<Message>(3))) << "changed";
    EXPECT_TRUE(error);
    return error.value_or(DecodeError{-1});
  }
};
using Messages = testing::Types<WrenchRequest, WrenchResponse, BodiesHydrostatics, BodiesLoads>;
TYPED_TEST_SUITE(WireMessage, Messages);

TYPED_TEST(WireMessage, IsRejectedUnlessItsLengthIsExact) {
  EXPECT_EQ(this->bytes_.size(), size_of(this->two_));
  for (std::size_t size = 0; size < this->bytes_.size(); ++size) {
    EXPECT_EQ(this->error(Bytes(this->bytes_).first(size)),
              size < this->fixed_ ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
  for (const std::size_t extra :
       {std::size_t{1}, std::size_t{8}, this->body_ - 1, this->body_, 2 * this->body_}) {
    ByteVector longer = this->bytes_;
    longer.resize(longer.size() + extra);
    EXPECT_EQ(this->error(longer), DecodeError::kLength) << extra;
  }
}

TYPED_TEST(WireMessage, IsRejectedIfItsCountDoesNotMatchItsLength) {
  using enum DecodeError;
  for (const auto& [count, expected] :
       std::initializer_list<std::pair<std::int32_t, DecodeError>>{{-1, kCount},
                                                                   {INT_MIN, kCount},
                                                                   {-2, kCount},
                                                                   {INT_MAX, kLength},
                                                                   {0, kLength},
                                                                   {1, kLength},
                                                                   {3, kLength},
                                                                   {1 << 30, kLength}}) {
    ByteVector bytes = this->bytes_;
    BigEndianWriter{bytes.data() + this->fixed_ - 4}(count);
    EXPECT_EQ(this->error(bytes), expected) << count;
  }
}

TYPED_TEST(WireMessage, IsRejectedIfItsFingerprintIsAnother) {
  for (std::size_t bit = 0; bit < 64; ++bit) {
    ByteVector bytes = this->bytes_;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_EQ(this->error(bytes), DecodeError::kFingerprint) << "bit " << bit;
  }
  for (const ByteVector& other :
       {encoded(message_of<WrenchRequest>(2)), encoded(message_of<WrenchResponse>(2)),
        encoded(message_of<BodiesHydrostatics>(2)), encoded(message_of<BodiesLoads>(2))}) {
    if (other == this->bytes_) continue;
    EXPECT_EQ(this->error(other), DecodeError::kFingerprint);
  }
}

TYPED_TEST(WireMessage, IsDecodedFromUnalignedAddresses) {
  for (std::size_t shift = 0; shift < 8; ++shift) {
    ByteVector shifted(shift);
    shifted.insert(shifted.end(), this->bytes_.begin(), this->bytes_.end());
    ASSERT_FALSE(decode(Bytes(shifted).subspan(shift), this->decoded_).has_value());
    EXPECT_EQ(encoded(this->decoded_), this->bytes_) << "shifted by " << shift;
  }
}

TYPED_TEST(WireMessage, DoesNotAllocateAfterWarmUp) {
  const ByteVector largest = encoded(message_of<TypeParam>(1000));
  ByteVector bytes;
  ASSERT_FALSE(decode(largest, this->decoded_).has_value());
  encode(this->decoded_, bytes);
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    for (const ByteVector* message : {&this->bytes_, &largest}) {
      ASSERT_FALSE(decode(*message, this->decoded_).has_value());
      encode(this->decoded_, bytes);
      ASSERT_EQ(bytes, *message);
    }
  }
  EXPECT_EQ(allocations.count(), 0);
}

TEST(Wire, ChangesOnlySeqOfEncodedResponses) {
  const auto check = [](auto message) {
    ByteVector bytes = encoded(message);
    EXPECT_EQ(response_id(bytes).utime, -5);
    EXPECT_EQ(response_id(bytes).session_id, 6);
    EXPECT_EQ(response_id(bytes).seq, 7);
    message.id.seq = std::int64_t{1} << 40;
    set_response_seq(message.id.seq, bytes);
    EXPECT_EQ(bytes, encoded(message));
  };
  check(message_of<WrenchResponse>(2));
  check(message_of<BodiesHydrostatics>(1));
  check(message_of<BodiesLoads>(1));
}

TEST(BodyStatus, ConvertsToNamesOfMessageDefinition) {
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::OK}), "OK");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::UNKNOWN_BODY}), "UNKNOWN_BODY");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::NON_FINITE_POSE}), "NON_FINITE_POSE");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::BAD_QUATERNION}), "BAD_QUATERNION");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::NON_FINITE_TWIST}), "NON_FINITE_TWIST");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::BAD_LEAD_TIME}), "BAD_LEAD_TIME");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::OPEN_EDGE_WET}), "OPEN_EDGE_WET");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::OUT_OF_RANGE}), "OUT_OF_RANGE");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::NO_SEA}), "NO_SEA");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::BAD_CONDITION}), "BAD_CONDITION");
  EXPECT_STREQ(to_string(BodyStatus{body_wrench_t::NOT_CERTIFIED}), "NOT_CERTIFIED");
  EXPECT_STREQ(to_string(BodyStatus{kBodyStatusCount}), "UNKNOWN_STATUS");
}

TEST(DecodeError, ConvertsToDistinctDescriptions) {
  const std::vector<std::string> descriptions{
      to_string(DecodeError::kTruncated), to_string(DecodeError::kFingerprint),
      to_string(DecodeError::kCount), to_string(DecodeError::kLength)};
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    EXPECT_FALSE(descriptions[i].empty());
    EXPECT_EQ(std::count(descriptions.begin(), descriptions.end(), descriptions[i]), 1) << descriptions[i];
  }
}

}  // namespace
}  // namespace buoyancy
