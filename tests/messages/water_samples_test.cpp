// Requests for the water at points and their responses: the encoding, compared with LCM's generated code.
#include "messages/water_samples.h"

#include <climits>

#include <buoyancy/water_points_t.hpp>
#include <buoyancy/water_samples_t.hpp>
#include <gtest/gtest.h>

#include "messages/type_name.h"
#include "messages/wire_views.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

constexpr RequestId kId{.utime = -5, .session_id = 6, .seq = 7};

// Every number of a message is another one.
WaterPoint point(std::size_t i) {
  const auto first = static_cast<double>(3 * i);
  return {{first, first + 1.0, first + 2.0}};
}
WaterSample sample(std::size_t i) {
  const auto first = static_cast<double>(6 * i);
  return {first, first + 1.0, {first + 2.0, first + 3.0, first + 4.0}, first + 5.0};
}

ByteVector points_message(std::size_t count) {
  std::vector<WaterPoint> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(point(i));
  ByteVector bytes;
  encode(BorrowedWaterPoints{kId, points}, bytes);
  return bytes;
}

ByteVector points_by_lcm(std::size_t count) {
  water_points_t message{};
  message.utime = kId.utime;
  message.session_id = kId.session_id;
  message.seq = kId.seq;
  message.num_points = static_cast<std::int32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto position = point(i).position;
    message.points.emplace_back(position.begin(), position.end());
  }
  return encoded_by_lcm(message);
}

ByteVector samples_by_lcm(std::size_t count, BodyStatus status, bool zeros = false) {
  water_samples_t message{};
  message.utime = kId.utime;
  message.session_id = kId.session_id;
  message.seq = kId.seq;
  message.status = static_cast<std::int32_t>(status);
  message.num_points = static_cast<std::int32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const WaterSample of = zeros ? WaterSample{} : sample(i);
    message.elevation.push_back(of.elevation);
    message.pressure.push_back(of.pressure);
    message.velocity.emplace_back(of.velocity.begin(), of.velocity.end());
    message.density.push_back(of.density);
  }
  return encoded_by_lcm(message);
}

TEST(WaterPoints, AreEncodedAndDecodedLikeGeneratedCode) {
  for (const std::size_t count : {0U, 1U, 5U}) {
    const ByteVector bytes = points_by_lcm(count);
    EXPECT_EQ(points_message(count), bytes);
    EXPECT_EQ(bytes.size(), water_points_size(count));
    WaterPoints decoded;
    ASSERT_FALSE(decode(bytes, decoded));
    EXPECT_EQ(decoded.id.seq, kId.seq);
    ASSERT_EQ(decoded.points.size(), count);
    const auto view = WaterPointsView::of(bytes);
    ASSERT_TRUE(view);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(decoded.points[i].position, point(i).position);
      EXPECT_EQ(view->point(i).position, point(i).position);
    }
  }
}

TEST(WaterSamples, AreWrittenAndDecodedLikeGeneratedCode) {
  ByteVector written;
  WaterSamples decoded;
  for (const std::size_t count : {5U, 0U, 1U, 4U}) {
    WaterSamplesWriter(kId, count, written);
    WaterSamplesWriter writer(written);
    for (std::size_t i = count; i-- > 0;) writer.set(i, sample(i));
    const ByteVector bytes = samples_by_lcm(count, BodyStatus::kOk);
    EXPECT_EQ(written, bytes);
    EXPECT_EQ(bytes.size(), water_samples_size(count));
    ASSERT_FALSE(decode(bytes, decoded));
    EXPECT_EQ(decoded.status, BodyStatus::kOk);
    EXPECT_EQ(decoded.id.utime, kId.utime);
    ASSERT_EQ(decoded.samples.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(decoded.samples[i].elevation, sample(i).elevation);
      EXPECT_EQ(decoded.samples[i].pressure, sample(i).pressure);
      EXPECT_EQ(decoded.samples[i].velocity, sample(i).velocity);
      EXPECT_EQ(decoded.samples[i].density, sample(i).density);
    }
    writer.fail(BodyStatus::kNoSea);
    EXPECT_EQ(written, samples_by_lcm(count, BodyStatus::kNoSea, true));
  }
}

TEST(WaterSamples, StatusesEqualTheConstantsOfTheDefinition) {
  EXPECT_EQ(static_cast<std::int32_t>(BodyStatus::kOk), water_samples_t::OK);
  EXPECT_EQ(static_cast<std::int32_t>(BodyStatus::kNonFinitePose), water_samples_t::NON_FINITE_POSE);
  EXPECT_EQ(static_cast<std::int32_t>(BodyStatus::kOutOfRange), water_samples_t::OUT_OF_RANGE);
  EXPECT_EQ(static_cast<std::int32_t>(BodyStatus::kNoSea), water_samples_t::NO_SEA);
}

void set_count(ByteVector& bytes, std::size_t at, std::int32_t count) {
  BigEndianWriter{bytes.data() + at}(count);
}

TEST(WaterPoints, AreRejectedUnlessFingerprintCountAndLengthFit) {
  const ByteVector two = points_message(2);
  const std::size_t fixed = water_points_size(0);
  const AllocationCount allocations;
  for (std::size_t size = 0; size < two.size(); ++size) {
    const auto expected = size < fixed ? DecodeError::kTruncated : DecodeError::kLength;
    const auto view = WaterPointsView::of(Bytes(two).first(size));
    ASSERT_FALSE(view) << size;
    EXPECT_EQ(view.error(), expected) << size;
    const auto peeked = peek_request(Bytes(two).first(size));
    ASSERT_FALSE(peeked) << size;
    EXPECT_EQ(peeked.error(), expected) << size;
  }
  EXPECT_EQ(allocations.count(), 0);
  struct Count {
    std::int32_t count;
    DecodeError error;
  };
  for (const auto [count, error] :
       {Count{-1, DecodeError::kCount}, Count{INT_MIN, DecodeError::kCount}, Count{3, DecodeError::kLength},
        Count{1, DecodeError::kLength}, Count{INT_MAX, DecodeError::kLength}}) {
    ByteVector bytes = two;
    set_count(bytes, fixed - 4, count);
    EXPECT_EQ(peek_request(bytes).error(), error) << count;
    WaterPoints points{.id = kId, .points = {}};
    EXPECT_EQ(decode(bytes, points), error) << count;
    ByteVector samples = samples_by_lcm(2, BodyStatus::kOk);
    set_count(samples, water_samples_size(0) - 4, count);
    WaterSamples decoded;
    EXPECT_EQ(decode(samples, decoded), error) << count;
  }
  ByteVector other = two;
  other[3] ^= 1U;
  EXPECT_EQ(peek_request(other).error(), DecodeError::kFingerprint);
  EXPECT_EQ(WaterPointsView::of(other).error(), DecodeError::kFingerprint);
}

TEST(Requests, AreToldApartByTheirFingerprint) {
  const auto points = peek_request(points_message(3));
  ASSERT_TRUE(points);
  EXPECT_EQ(points->kind, RequestKind::kWaterPoints);
  EXPECT_EQ(points->size, 3U);
  EXPECT_EQ(points->session(), (SessionKey{kId.session_id, RequestKind::kWaterPoints}));
  WrenchRequest request{.id = kId, .lead_time = 0.5, .bodies = {}};
  request.bodies.resize(2);
  const auto bodies = peek_request(encoded(request));
  ASSERT_TRUE(bodies);
  EXPECT_EQ(bodies->kind, RequestKind::kBodies);
  EXPECT_EQ(bodies->size, 2U);
  EXPECT_EQ(bodies->lead_time, 0.5);
  EXPECT_NE(bodies->session(), points->session());
  EXPECT_EQ(type_name(points_message(1)), "buoyancy.water_points_t");
  EXPECT_EQ(type_name(samples_by_lcm(1, BodyStatus::kOk)), "buoyancy.water_samples_t");
}

}  // namespace
}  // namespace buoyancy
