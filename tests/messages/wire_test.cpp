#include "messages/wire.h"

#include <algorithm>
#include <climits>
#include <string>

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

constexpr std::size_t kRequestFixed = 44;
constexpr std::size_t kBodyState = 108;
constexpr std::size_t kResponseFixed = 36;
constexpr std::size_t kBodyWrench = 104;
constexpr std::size_t kBodyHydrostatics = 512;  // after a header like a response's
constexpr std::size_t kBodyLoads = 760;         // likewise

template <typename Message>
ByteVector encoded(const Message& message) {
  ByteVector bytes;
  encode(message, bytes);
  return bytes;
}

template <std::size_t kSize>
void copy(const std::array<double, kSize>& from, double (&to)[kSize]) {
  std::copy(from.begin(), from.end(), to);
}

body_states_t to_generated(const WrenchRequest& request) {
  body_states_t message{};
  message.utime = request.id.utime;
  message.session_id = request.id.session_id;
  message.seq = request.id.seq;
  message.lead_time = request.lead_time;
  message.num_bodies = static_cast<std::int32_t>(request.bodies.size());
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
  body_wrenches_t message{};
  message.utime = response.id.utime;
  message.session_id = response.id.session_id;
  message.seq = response.id.seq;
  message.num_bodies = static_cast<std::int32_t>(response.bodies.size());
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

template <std::size_t kRows, std::size_t kColumns>
void copy(const std::array<std::array<double, kColumns>, kRows>& from, double (&to)[kRows][kColumns]) {
  for (std::size_t row = 0; row < kRows; ++row) copy(from[row], to[row]);
}

bodies_hydrostatics_t to_generated(const BodiesHydrostatics& hydrostatics) {
  bodies_hydrostatics_t message{};
  message.utime = hydrostatics.id.utime;
  message.session_id = hydrostatics.id.session_id;
  message.seq = hydrostatics.id.seq;
  message.num_bodies = static_cast<std::int32_t>(hydrostatics.bodies.size());
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
  bodies_loads_t message{};
  message.utime = loads.id.utime;
  message.session_id = loads.id.session_id;
  message.seq = loads.id.seq;
  message.num_bodies = static_cast<std::int32_t>(loads.bodies.size());
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

ByteVector request_of(std::size_t bodies) {
  WrenchRequest request{.id = {.utime = 1, .session_id = 2, .seq = 3}, .lead_time = 0.25, .bodies = {}};
  request.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) request.bodies[i].body_id = static_cast<std::int32_t>(i);
  return encoded(request);
}

void set_count(ByteVector& bytes, std::size_t fixed_size, std::int32_t count) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[fixed_size - 1 - i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(count) >> (8 * i));
  }
}

RC_GTEST_PROP(Wire, EncodesRequestsLikeGeneratedCode, ()) {
  const WrenchRequest request = random_request();
  RC_ASSERT(encoded(request) == encoded_by_lcm(to_generated(request)));
}

RC_GTEST_PROP(Wire, EncodesResponsesLikeGeneratedCode, ()) {
  const WrenchResponse response = random_response();
  RC_ASSERT(encoded(response) == encoded_by_lcm(to_generated(response)));
}

RC_GTEST_PROP(Wire, DecodesRequestsOfGeneratedCode, ()) {
  const body_states_t message = to_generated(random_request());
  const ByteVector bytes = encoded_by_lcm(message);
  WrenchRequest request = random_request();  // its previous content must not matter
  RC_ASSERT(!decode(bytes, request).has_value());
  RC_ASSERT(request.id.utime == message.utime);
  RC_ASSERT(request.id.session_id == message.session_id);
  RC_ASSERT(request.id.seq == message.seq);
  RC_ASSERT(request.bodies.size() == message.bodies.size());
  RC_ASSERT(encoded_by_lcm(to_generated(request)) == bytes);
}

RC_GTEST_PROP(Wire, DecodesResponsesOfGeneratedCode, ()) {
  const ByteVector bytes = encoded_by_lcm(to_generated(random_response()));
  WrenchResponse response = random_response();
  RC_ASSERT(!decode(bytes, response).has_value());
  RC_ASSERT(encoded_by_lcm(to_generated(response)) == bytes);
}

RC_GTEST_PROP(Wire, EncodesHydrostaticsLikeGeneratedCode, ()) {
  const BodiesHydrostatics hydrostatics = random_hydrostatics();
  RC_ASSERT(encoded(hydrostatics) == encoded_by_lcm(to_generated(hydrostatics)));
}

RC_GTEST_PROP(Wire, DecodesHydrostaticsOfGeneratedCode, ()) {
  const ByteVector bytes = encoded_by_lcm(to_generated(random_hydrostatics()));
  BodiesHydrostatics hydrostatics = random_hydrostatics();
  RC_ASSERT(!decode(bytes, hydrostatics).has_value());
  RC_ASSERT(encoded_by_lcm(to_generated(hydrostatics)) == bytes);
}

RC_GTEST_PROP(Wire, EncodesLoadsLikeGeneratedCode, ()) {
  const BodiesLoads loads = random_loads();
  RC_ASSERT(encoded(loads) == encoded_by_lcm(to_generated(loads)));
}

RC_GTEST_PROP(Wire, DecodesLoadsOfGeneratedCode, ()) {
  const ByteVector bytes = encoded_by_lcm(to_generated(random_loads()));
  BodiesLoads loads = random_loads();
  RC_ASSERT(!decode(bytes, loads).has_value());
  RC_ASSERT(encoded_by_lcm(to_generated(loads)) == bytes);
}

RC_GTEST_PROP(Wire, DecodesOrRejectsRandomBytesOfLoads, ()) {
  ByteVector bytes = encoded(random_loads());
  bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 2));
  for (int flips = *rc::gen::inRange(0, 3); flips > 0 && !bytes.empty(); --flips) {
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] ^= 1U;
  }
  BodiesLoads loads;
  loads.bodies.resize(2);
  if (decode(bytes, loads)) {
    RC_ASSERT(loads.bodies.size() == 2U);  // unchanged
  } else {
    RC_ASSERT(encoded(loads) == bytes);
  }
}

RC_GTEST_PROP(Wire, PeeksSameRequestIdAsDecode, ()) {
  const WrenchRequest request = random_request();
  const auto id = peek_request_id(encoded(request));
  RC_ASSERT(id.has_value());
  RC_ASSERT(id->utime == request.id.utime);
  RC_ASSERT(id->session_id == request.id.session_id);
  RC_ASSERT(id->seq == request.id.seq);
}

RC_GTEST_PROP(Wire, DecodesOrRejectsRandomBytesAfterValidFingerprint, ()) {
  ByteVector bytes = request_of(0);
  bytes.resize(8);
  const auto garbage = *rc::gen::arbitrary<ByteVector>();
  bytes.insert(bytes.end(), garbage.begin(), garbage.end());
  WrenchRequest request;
  RC_ASSERT(decode(bytes, request).has_value() == !peek_request_id(bytes).has_value());
}

RC_GTEST_PROP(RequestView, ReadsSameBodiesAsDecode, ()) {
  const WrenchRequest request = random_request();
  const ByteVector bytes = encoded(request);
  const auto view = RequestView::of(bytes);
  RC_ASSERT(view.has_value());
  WrenchRequest read{.id = view->id(), .lead_time = view->lead_time(), .bodies = {}};
  for (std::size_t i = 0; i < view->size(); ++i) {
    read.bodies.push_back(view->body(i));
    RC_ASSERT(view->body_id(i) == request.bodies[i].body_id);
  }
  RC_ASSERT(encoded(read) == bytes);
}

RC_GTEST_PROP(RequestView, RejectsSameBytesAsDecode, ()) {
  ByteVector bytes = encoded(random_request());
  bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 2));
  for (int flips = *rc::gen::inRange(0, 3); flips > 0 && !bytes.empty(); --flips) {
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] ^= 1U;
  }
  WrenchRequest decoded;
  const std::optional<DecodeError> error = decode(bytes, decoded);
  const auto view = RequestView::of(bytes);
  RC_ASSERT(view.has_value() == !error.has_value());
  if (error) RC_ASSERT(view.error() == *error);
}

RC_GTEST_PROP(ResponseWriter, WritesSameBytesAsEncode, ()) {
  const WrenchResponse response = random_response();
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
  EXPECT_EQ(request_of(0).size(), kRequestFixed);
  EXPECT_EQ(request_of(3).size(), kRequestFixed + 3 * kBodyState);
  EXPECT_EQ(encoded(WrenchResponse{}).size(), kResponseFixed);
  EXPECT_EQ(encoded(WrenchResponse{.id = {}, .bodies = {{}, {}}}).size(), kResponseFixed + 2 * kBodyWrench);
  EXPECT_EQ(encoded(BodiesHydrostatics{}).size(), kResponseFixed);
  EXPECT_EQ(encoded(BodiesHydrostatics{.id = {}, .bodies = {{}, {}}}).size(),
            kResponseFixed + 2 * kBodyHydrostatics);
  EXPECT_EQ(encoded(BodiesLoads{}).size(), kResponseFixed);
  EXPECT_EQ(encoded(BodiesLoads{.id = {}, .bodies = {{}, {}}}).size(), kResponseFixed + 2 * kBodyLoads);
  EXPECT_EQ(loads_size(2), kResponseFixed + 2 * kBodyLoads);
}

TEST(Wire, RejectsEveryTruncationOfRequest) {
  const ByteVector whole = request_of(3);
  WrenchRequest request;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part = Bytes(whole).first(size);
    const DecodeError expected = size < kRequestFixed ? DecodeError::kTruncated : DecodeError::kLength;
    EXPECT_EQ(decode(part, request), expected) << size << " bytes";
    ASSERT_FALSE(peek_request_id(part).has_value()) << size << " bytes";
    EXPECT_EQ(peek_request_id(part).error(), expected) << size << " bytes";
  }
}

TEST(Wire, RejectsEveryTruncationOfResponse) {
  const ByteVector whole = encoded(WrenchResponse{.id = {}, .bodies = {{}, {}}});
  WrenchResponse response;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), response),
              size < kResponseFixed ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
}

TEST(Wire, RejectsEveryTruncationOfHydrostatics) {
  const ByteVector whole = encoded(BodiesHydrostatics{.id = {}, .bodies = {{}, {}}});
  BodiesHydrostatics hydrostatics;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), hydrostatics),
              size < kResponseFixed ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
}

TEST(Wire, RejectsEveryTruncationOfLoads) {
  const ByteVector whole = encoded(BodiesLoads{.id = {}, .bodies = {{}, {}}});
  BodiesLoads loads;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), loads),
              size < kResponseFixed ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
}

TEST(Wire, RejectsEveryFlippedFingerprintBit) {
  const ByteVector whole = request_of(1);
  WrenchRequest request;
  for (std::size_t bit = 0; bit < 64; ++bit) {
    ByteVector bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_EQ(decode(bytes, request), DecodeError::kFingerprint) << "bit " << bit;
  }
}

TEST(Wire, RejectsOtherBuoyancyTypes) {
  WrenchRequest request;
  WrenchResponse response;
  EXPECT_EQ(decode(encoded(WrenchResponse{.id = {}, .bodies = {{}, {}}}), request),
            DecodeError::kFingerprint);
  EXPECT_EQ(decode(request_of(2), response), DecodeError::kFingerprint);
  EXPECT_EQ(decode(encoded(BodiesHydrostatics{}), response), DecodeError::kFingerprint);
  BodiesLoads loads;
  EXPECT_EQ(decode(encoded(WrenchResponse{}), loads), DecodeError::kFingerprint);
  EXPECT_EQ(decode(encoded(BodiesLoads{}), response), DecodeError::kFingerprint);
}

TEST(Wire, RejectsCountsThatDoNotMatchLength) {
  struct Case {
    std::int32_t count;
    DecodeError expected;
  };
  for (const Case& c :
       {Case{-1, DecodeError::kCount}, Case{INT_MIN, DecodeError::kCount}, Case{-2, DecodeError::kCount},
        Case{INT_MAX, DecodeError::kLength}, Case{0, DecodeError::kLength}, Case{1, DecodeError::kLength},
        Case{3, DecodeError::kLength}, Case{1 << 30, DecodeError::kLength}}) {
    ByteVector bytes = request_of(2);
    set_count(bytes, kRequestFixed, c.count);
    WrenchRequest request;
    EXPECT_EQ(decode(bytes, request), c.expected) << c.count;
    ByteVector response_bytes = encoded(WrenchResponse{.id = {}, .bodies = {{}, {}}});
    set_count(response_bytes, kResponseFixed, c.count);
    WrenchResponse response;
    EXPECT_EQ(decode(response_bytes, response), c.expected) << c.count;
    ByteVector loads_bytes = encoded(BodiesLoads{.id = {}, .bodies = {{}, {}}});
    set_count(loads_bytes, kResponseFixed, c.count);
    BodiesLoads loads;
    const AllocationCount allocations;
    EXPECT_EQ(decode(loads_bytes, loads), c.expected) << c.count;
    EXPECT_EQ(allocations.count(), 0) << c.count;
  }
}

TEST(Wire, RejectsTrailingBytes) {
  for (const std::size_t extra :
       {std::size_t{1}, std::size_t{8}, kBodyState - 1, kBodyState, 2 * kBodyState}) {
    ByteVector bytes = request_of(1);
    bytes.resize(bytes.size() + extra);
    WrenchRequest request;
    EXPECT_EQ(decode(bytes, request), DecodeError::kLength) << extra;
  }
}

TEST(Wire, LeavesRequestUnchangedOnDecodeError) {
  WrenchRequest request;
  ASSERT_FALSE(decode(request_of(3), request).has_value());
  ByteVector bad = request_of(2);
  bad.push_back(0);
  ASSERT_TRUE(decode(bad, request).has_value());
  EXPECT_EQ(encoded(request), request_of(3));
}

TEST(Wire, ChangesOnlySeqOfEncodedResponses) {
  WrenchResponse response;
  response.id = {.utime = -5, .session_id = 6, .seq = 7};
  response.bodies.resize(2);
  BodiesHydrostatics hydrostatics;
  hydrostatics.id = response.id;
  hydrostatics.bodies.resize(1);
  const auto check = [](auto message) {
    std::vector<std::uint8_t> bytes;
    encode(message, bytes);
    EXPECT_EQ(response_id(bytes).utime, -5);
    EXPECT_EQ(response_id(bytes).session_id, 6);
    EXPECT_EQ(response_id(bytes).seq, 7);
    set_response_seq(std::int64_t{1} << 40, bytes);
    message.id.seq = std::int64_t{1} << 40;
    std::vector<std::uint8_t> expected;
    encode(message, expected);
    EXPECT_EQ(bytes, expected);
  };
  BodiesLoads loads;
  loads.id = response.id;
  loads.bodies.resize(1);
  check(response);
  check(hydrostatics);
  check(loads);
}

TEST(Wire, DoesNotAllocateForHugeCount) {
  ByteVector bytes = request_of(0);
  set_count(bytes, kRequestFixed, INT_MAX);
  WrenchRequest request;
  const AllocationCount allocations;
  EXPECT_EQ(decode(bytes, request), DecodeError::kLength);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(Wire, DecodesFromUnalignedAddresses) {
  const ByteVector whole = request_of(2);
  for (std::size_t shift = 0; shift < 8; ++shift) {
    ByteVector shifted(shift);
    shifted.insert(shifted.end(), whole.begin(), whole.end());
    WrenchRequest request;
    ASSERT_FALSE(decode(Bytes(shifted).subspan(shift), request).has_value());
    EXPECT_EQ(encoded(request), whole) << "shifted by " << shift;
  }
}

TEST(Wire, DoesNotAllocateAfterWarmUp) {
  const ByteVector largest = request_of(1000);
  const ByteVector small = request_of(7);
  WrenchRequest request;
  ASSERT_FALSE(decode(largest, request).has_value());
  ByteVector bytes;
  encode(request, bytes);
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    for (const ByteVector* message : {&small, &largest}) {
      ASSERT_FALSE(decode(*message, request).has_value());
      encode(request, bytes);
      ASSERT_EQ(bytes, *message);
    }
  }
  EXPECT_EQ(allocations.count(), 0);
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
