#include "messages/sea_grid.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <buoyancy/sea_grid_t.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::size_t kFixed = 8 + 8 + 8 + 2 * 8 + 2 * 8 + 8 + 4 + 4 + 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const SeaGridHeader kHeader{-7, 5, {-3.0, 4.0}, {0.5, 0.25}, 1.5, 1, 5, 6};

std::vector<float> random_elevations(std::size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-2.0F, 2.0F);
  std::vector<float> elevations(count);
  for (float& elevation : elevations) elevation = uniform(random);
  return elevations;
}

ByteVector bytes_of(const SeaGridHeader& header, const std::vector<float>& elevations) {
  ByteVector bytes;
  encode(header, elevations, bytes);
  return bytes;
}

TEST(SeaGrid, EncodesLikeGeneratedCode) {
  const std::vector<float> elevations = random_elevations(30);
  sea_grid_t message{};
  message.utime = kHeader.utime;
  message.instance_id = kHeader.instance_id;
  std::copy(kHeader.origin.begin(), kHeader.origin.end(), message.origin);
  std::copy(kHeader.spacing.begin(), kHeader.spacing.end(), message.spacing);
  message.level = kHeader.level;
  message.periodic = kHeader.periodic;
  message.rows = kHeader.rows;
  message.columns = kHeader.columns;
  for (auto row = elevations.begin(); row != elevations.end(); row += kHeader.columns) {
    message.elevation.emplace_back(row, row + kHeader.columns);
  }
  const ByteVector bytes = bytes_of(kHeader, elevations);
  EXPECT_EQ(bytes, encoded_by_lcm(message));
  EXPECT_EQ(bytes.size(), sea_grid_size(5, 6));
  EXPECT_EQ(peek_sea_grid(bytes).value(), kHeader);
}

TEST(SeaGrid, RejectsEveryTruncationAndTrailingBytes) {
  ByteVector whole = bytes_of(kHeader, random_elevations(30));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_EQ(peek_sea_grid(Bytes(whole).first(size)).error(),
              size < kFixed ? DecodeError::kTruncated : DecodeError::kLength)
        << size << " bytes";
  }
  whole.push_back(0);
  EXPECT_EQ(peek_sea_grid(whole).error(), DecodeError::kLength);
  whole.pop_back();
  ++whole[0];
  EXPECT_EQ(peek_sea_grid(whole).error(), DecodeError::kFingerprint);
}

// Whatever the length, so that products of counts that overflow reach nothing.
TEST(SeaGrid, RejectsCountsOutOfRange) {
  for (const std::int32_t count : {std::numeric_limits<std::int32_t>::min(), -1, 0, 3, 4097, 65'536,
                                   std::numeric_limits<std::int32_t>::max()}) {
    for (std::int32_t SeaGridHeader::*side : {&SeaGridHeader::rows, &SeaGridHeader::columns}) {
      ByteVector bytes = bytes_of(kHeader, random_elevations(30));
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t at = kFixed - (side == &SeaGridHeader::rows ? 8 : 4) + i;
        bytes[at] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(count) >> (24 - 8 * i));
      }
      EXPECT_EQ(peek_sea_grid(bytes).error(), DecodeError::kCount) << count;
      ElevationSpline surface;
      const Expected<void> set = set_surface(bytes, surface);
      ASSERT_FALSE(set);
      EXPECT_THAT(set.error().message(), HasSubstr("sea_grid_t"));
    }
  }
}

TEST(SeaGrid, SetsTheSurfaceOfItsSamples) {
  const std::vector<float> elevations = random_elevations(30);
  ElevationSpline of_message;
  ASSERT_TRUE(set_surface(bytes_of(kHeader, elevations), of_message));
  ElevationSpline of_samples;
  ASSERT_TRUE(of_samples.set(ElevationGrid<float>{elevations, 5, 6, kHeader.origin, kHeader.spacing, true}));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-9.0, 9.0);
  for (int i = 0; i < 100; ++i) {
    const double x1 = uniform(random);
    const double x2 = uniform(random);
    EXPECT_EQ(of_message.at(x1, x2).eta, of_samples.at(x1, x2).eta);
  }
}

TEST(SeaGrid, NamesTheFieldThatCannotBeUsed) {
  struct Case {
    std::function<void(SeaGridHeader&, std::vector<float>&)> spoil;
    std::string actual;
  };
  const std::vector<Case> cases{
      {[](SeaGridHeader& header, auto&) { header.level = kNaN; }, "level = nan"},
      {[](SeaGridHeader& header, auto&) { header.level = -kInfinity; }, "level = -inf"},
      {[](SeaGridHeader& header, auto&) { header.periodic = 2; }, "periodic = 2"},
      {[](SeaGridHeader& header, auto&) { header.spacing[0] = 0.0; }, "spacing[0] = 0"},
      {[](SeaGridHeader& header, auto&) { header.spacing[1] = -0.25; }, "spacing[1] = -0.25"},
      {[](SeaGridHeader& header, auto&) { header.spacing[1] = kInfinity; }, "spacing[1] = inf"},
      {[](SeaGridHeader& header, auto&) { header.origin[1] = kNaN; }, "origin[1] = nan"},
      {[](SeaGridHeader&, auto& elevations) { elevations[7] = -1000.5F; }, "elevation[1][1] = -1000.5"},
      {[](SeaGridHeader&, auto& elevations) { elevations[29] = std::nanf(""); }, "elevation[4][5] = nan"},
  };
  for (const Case& bad : cases) {
    SeaGridHeader header = kHeader;
    std::vector<float> elevations = random_elevations(30);
    ElevationSpline surface;
    ASSERT_TRUE(set_surface(bytes_of(header, elevations), surface));
    const double before = surface.at(-2.0, 4.3).eta;
    bad.spoil(header, elevations);
    const Expected<void> set = set_surface(bytes_of(header, elevations), surface);
    ASSERT_FALSE(set) << bad.actual;
    EXPECT_THAT(set.error().message(), StartsWith("the received grid of the sea: "));
    EXPECT_THAT(set.error().actual, HasSubstr(bad.actual));
    EXPECT_EQ(surface.at(-2.0, 4.3).eta, before);
  }
}

TEST(SeaGrid, AllocatesNothingForAnotherGridOfItsSize) {
  const ByteVector first = bytes_of(kHeader, random_elevations(30, 1));
  const ByteVector second = bytes_of(kHeader, random_elevations(30, 2));
  ElevationSpline surface;
  ASSERT_TRUE(set_surface(first, surface));
  const AllocationCount allocations;
  EXPECT_TRUE(set_surface(second, surface));
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace buoyancy
