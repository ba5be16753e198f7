#include "waves/random_phase.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

using Words = std::array<std::uint32_t, 4>;

TEST(RandomPhase, PhiloxGivesItsPublishedNumbers) {
  constexpr std::uint32_t kOnes = 0xFFFFFFFF;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomPhase, IsUniformOverTheTurn) {
  constexpr std::uint32_t kNumber = 20'000;
  double cosines = 0.0, sines = 0.0, sum = 0.0;
  for (std::uint32_t i = 0; i < kNumber; ++i) {
    const double phase = random_phase(7, 0, i);
    ASSERT_GE(phase, 0.0);
    ASSERT_LT(phase, 360.0);
    sum += phase;
    cosines += std::cos(phase * 0.017453292519943295);
    sines += std::sin(phase * 0.017453292519943295);
  }
  EXPECT_NEAR(sum / kNumber, 180.0, 3.0);
  EXPECT_NEAR(cosines / kNumber, 0.0, 0.02);
  EXPECT_NEAR(sines / kNumber, 0.0, 0.02);
}

TEST(RandomPhase, DependsOnSeedSystemAndComponent) {
  const double phase = random_phase(1, 0, 0);
  EXPECT_EQ(random_phase(1, 0, 0), phase);
  EXPECT_NE(random_phase(2, 0, 0), phase);
  EXPECT_NE(random_phase(std::uint64_t{1} << 32U | 1U, 0, 0), phase);
  EXPECT_NE(random_phase(1, 1, 0), phase);
  EXPECT_NE(random_phase(1, 0, 1), phase);
}

TEST(RandomOrder, IsEveryOrderEquallyOften) {
  std::map<std::vector<std::size_t>, int> counts;
  constexpr std::uint32_t kGroups = 6000;
  for (std::uint32_t group = 0; group < kGroups; ++group) ++counts[random_order(7, 0, group, 3)];
  ASSERT_EQ(counts.size(), 6U);
  for (const auto& [order, count] : counts) EXPECT_NEAR(count, kGroups / 6, 100);
  EXPECT_EQ(random_order(7, 0, 0, 1), std::vector<std::size_t>{0});
  EXPECT_NE(random_order(7, 0, 0, 50), random_order(8, 0, 0, 50));
  EXPECT_NE(random_order(7, 0, 0, 50), random_order(7, 1, 0, 50));
}

}  // namespace
}  // namespace buoyancy
