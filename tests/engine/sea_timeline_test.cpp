#include "engine/sea_timeline.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/sea_bytes.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
const std::string kBox = "[[body]]\nid = 1\nshape = { type = \"box\" }\n";

const Scene& receiving() {
  static const Scene scene = scene_of("[water]\nwaves = \"received\"\n" + kBox);
  return scene;
}

// A sea of this height [m], which tells it from others.
ByteVector sea(std::int64_t utime, int height) {
  return sea_bytes("waves = { type = \"regular\", period = 8, height = " + std::to_string(height) + " }\n",
                   utime);
}

// From when on the sea at this time holds, and its height; nullopt: none is known.
std::optional<std::pair<std::int64_t, int>> at(const SeaTimeline& timeline, std::int64_t utime) {
  const std::shared_ptr<const SeaPeriod>* const period = timeline.at(utime);
  if (period == nullptr) return std::nullopt;
  const auto state = decoded<SeaState>((*period)->message);
  const int height = static_cast<int>(std::lround(2.0 * state.amplitude.at(0)));
  EXPECT_EQ((*period)->sea == nullptr, height == 0) << "a sea without waves is water at rest";
  return std::pair{(*period)->from_utime, height};
}

TEST(SeaTimeline, OfASceneWithASeaHoldsAlways) {
  for (const std::string waves : {"[]", "{ type = \"regular\", height = 1, period = 8 }"}) {
    const Scene scene = scene_of("[water]\nwaves = " + waves + "\n" + kBox);
    const SeaTimeline timeline(scene);
    for (const std::int64_t utime : {kFirst, std::int64_t{0}, kLast}) {
      ASSERT_NE(timeline.at(utime), nullptr) << utime;
      EXPECT_EQ((*timeline.at(utime))->sea, scene.prepared_sea());
    }
  }
  EXPECT_EQ(SeaTimeline(receiving()).at(kLast), nullptr);
}

// At each time that sea holds, of those from then or earlier, that was received last. One that is received
// again, as senders do once a second, goes on.
RC_GTEST_PROP(SeaTimeline, AgreesWithAModelThatKeepsEverything, ()) {
  SeaTimeline timeline(receiving());
  std::vector<std::pair<std::int64_t, int>> received;
  const auto height_at = [&](std::int64_t utime) {
    std::optional<int> height;
    for (const auto& [from, of_sea] : received) {
      if (from <= utime) height = of_sea;
    }
    return height;
  };
  const auto count = *rc::gen::inRange<std::size_t>(0, SeaTimeline::kMaxSeas);
  for (std::size_t i = 0; i < count; ++i) {
    received.push_back({*rc::gen::inRange<std::int64_t>(-6, 6), *rc::gen::inRange(0, 3)});
    RC_ASSERT(timeline.receive(sea(received.back().first, received.back().second), receiving()).has_value());
  }
  for (std::int64_t utime = -7; utime <= 6; ++utime) {
    const std::optional<int> height = height_at(utime);
    const auto found = at(timeline, utime);
    RC_ASSERT(found.has_value() == height.has_value());
    if (!height) continue;
    RC_ASSERT(found->second == *height);
    std::int64_t from = utime;
    while (height_at(from - 1) == height) --from;
    RC_ASSERT(found->first == from);
  }
}

TEST(SeaTimeline, KeepsTheLastSeas) {
  constexpr auto kMax = static_cast<int>(SeaTimeline::kMaxSeas);
  SeaTimeline timeline(receiving());
  for (int n = 1; n <= kMax; ++n) ASSERT_TRUE(timeline.receive(sea(10 * n, n % 5 + 1), receiving()));
  // The newest again, as senders repeat it.
  for (int n = 1; n <= kMax; ++n)
    ASSERT_TRUE(timeline.receive(sea(10 * kMax + n, kMax % 5 + 1), receiving()));
  for (int n = 1; n <= kMax; ++n) {
    EXPECT_EQ(at(timeline, 10 * n + 9), (std::pair{std::int64_t{10 * n}, n % 5 + 1})) << "none was dropped";
  }
  ASSERT_TRUE(timeline.receive(sea(1'000, 0), receiving()));
  EXPECT_EQ(at(timeline, 19), std::nullopt);
  EXPECT_EQ(at(timeline, 20), (std::pair{std::int64_t{20}, 3}));
  EXPECT_EQ(at(timeline, kLast), (std::pair{std::int64_t{1'000}, 0}));
}

TEST(SeaTimeline, KeepsWhatHoldsWhereASeaCannotBeUsed) {
  SeaTimeline timeline(receiving());
  ASSERT_TRUE(timeline.receive(sea(0, 1), receiving()));
  ASSERT_TRUE(timeline.receive(sea(10, 2), receiving()));
  ByteVector cut = sea(5, 3);
  cut.pop_back();
  EXPECT_FALSE(timeline.receive(cut, receiving()));
  EXPECT_FALSE(
      timeline.receive(sea_bytes("waves = []\n", 5), scene_of("[world]\ngravity = 5\n[water]\nwaves = "
                                                              "\"received\"\n" +
                                                              kBox)));
  EXPECT_EQ(at(timeline, 5), (std::pair{std::int64_t{0}, 1}));
  EXPECT_EQ(at(timeline, 10), (std::pair{std::int64_t{10}, 2}));
}

}  // namespace
}  // namespace buoyancy
