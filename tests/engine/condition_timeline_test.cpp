#include "engine/condition_timeline.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();

const Scene& boxes() {
  static const Scene kScene = scene_of(damaged_boxes());
  return kScene;
}

Expected<void> receive(ConditionTimeline& timeline, const ConditionChange& change,
                       const Scene& scene = boxes()) {
  return timeline.receive(encoded(change), scene);
}

// Of body 1, which is the first with compartments or tanks; nullopt: unknown.
std::optional<BodyCondition> hull_at(const ConditionTimeline& timeline, std::int64_t utime,
                                     const Scene& scene = boxes()) {
  BodyCondition condition;
  UtimeRange range;
  if (!timeline.condition_at(utime, 0, scene, condition, range)) return std::nullopt;
  return condition;
}

const BodyCondition kAtFirst{.flooded = {0.0, 0.25}, .liquid_volumes = {0.5}};

TEST(ConditionTimeline, BeginsWithTheSceneFile) {
  const ConditionTimeline timeline(boxes());
  ASSERT_EQ(timeline.size(), 2U);
  EXPECT_EQ(timeline.body(0), 0U);
  EXPECT_EQ(timeline.body(1), 2U);
  for (const std::int64_t utime : {kFirst, std::int64_t{0}, kLast}) {
    EXPECT_EQ(hull_at(timeline, utime), kAtFirst) << utime;
  }
  EXPECT_EQ(ConditionTimeline(scene_of("[[body]]\nid = 1\nshape = { type = \"box\" }\n")).size(), 0U);
}

TEST(ConditionTimeline, ChangesOneItemFromItsUtimeOn) {
  ConditionTimeline timeline(boxes());
  ASSERT_TRUE(receive(timeline, flooded(100, 1, 1.0)));
  ASSERT_TRUE(receive(timeline, filled(200, 0, 0.75)));
  EXPECT_EQ(hull_at(timeline, 99), kAtFirst);
  EXPECT_EQ(hull_at(timeline, 100), (BodyCondition{{0.0, 1.0}, {0.5}}));
  EXPECT_EQ(hull_at(timeline, 199), (BodyCondition{{0.0, 1.0}, {0.5}}));
  EXPECT_EQ(hull_at(timeline, 200), (BodyCondition{{0.0, 1.0}, {0.75}}));
  EXPECT_EQ(hull_at(timeline, kLast), (BodyCondition{{0.0, 1.0}, {0.75}}));
}

TEST(ConditionTimeline, ReplacesWhatHeldFromItsUtimeOn) {
  ConditionTimeline timeline(boxes());
  for (const std::int64_t utime : {10, 20, 30}) {
    ASSERT_TRUE(receive(timeline, flooded(utime, 0, 0.01 * static_cast<double>(utime))));
    ASSERT_TRUE(receive(timeline, flooded(utime, 1, 0.02 * static_cast<double>(utime))));
  }
  ASSERT_TRUE(receive(timeline, flooded(20, 0, 0.9)));  // a sender that has started over
  EXPECT_EQ(hull_at(timeline, 19)->flooded, (std::vector{0.1, 0.2}));
  EXPECT_EQ(hull_at(timeline, 29)->flooded, (std::vector{0.9, 0.4}));
  EXPECT_EQ(hull_at(timeline, 30)->flooded, (std::vector{0.9, 0.6})) << "the other one keeps its changes";
}

TEST(ConditionTimeline, KeepsTheLastChangesOfEachItem) {
  constexpr auto kMax = static_cast<std::int64_t>(ConditionHistory::kMaxChanges);
  ConditionTimeline timeline(boxes());
  const auto share = [](std::int64_t utime) { return static_cast<double>(utime) / 1000.0; };
  for (std::int64_t utime = 1; utime <= kMax; ++utime) {
    ASSERT_TRUE(receive(timeline, flooded(utime, 0, share(utime))));
  }
  EXPECT_EQ(hull_at(timeline, 0)->flooded[0], 0.0) << "none was dropped";
  // As senders repeat it in case of loss.
  for (std::int64_t i = 1; i <= kMax; ++i) ASSERT_TRUE(receive(timeline, flooded(kMax + i, 0, share(kMax))));
  EXPECT_EQ(hull_at(timeline, 0)->flooded[0], 0.0) << "a repeated one adds nothing";
  ASSERT_TRUE(receive(timeline, flooded(1000, 0, 1.0)));
  EXPECT_EQ(hull_at(timeline, 0)->flooded[0], share(1)) << "the one that was dropped holds before the rest";
  for (std::int64_t utime = 2; utime <= kMax; ++utime) {
    ASSERT_EQ(hull_at(timeline, utime)->flooded[0], share(utime));
  }
  EXPECT_EQ(hull_at(timeline, 1000)->flooded[0], 1.0);
}

TEST(ConditionTimeline, ForgetsTheDroppedChangeOfARunThatStartsOver) {
  constexpr auto kCount = static_cast<std::int64_t>(ConditionHistory::kMaxChanges) + 1;
  ConditionTimeline timeline(boxes());
  const auto share = [](std::int64_t utime) { return static_cast<double>(utime) / 1000.0; };
  for (std::int64_t utime = 1; utime <= kCount; ++utime) {
    ASSERT_TRUE(receive(timeline, flooded(100 + utime, 0, share(utime))));
  }
  ASSERT_EQ(hull_at(timeline, 101)->flooded[0], share(1)) << "dropped";
  ConditionTimeline from_second = timeline;
  ASSERT_TRUE(receive(from_second, flooded(102, 0, 1.0)));
  EXPECT_EQ(hull_at(from_second, 101)->flooded[0], share(1)) << "nothing has replaced it";
  for (const std::int64_t start : {101, 50}) {
    ConditionTimeline restarted = timeline;
    ASSERT_TRUE(receive(restarted, flooded(start, 0, 1.0)));
    EXPECT_EQ(hull_at(restarted, start - 1)->flooded[0], 0.0) << start;
    EXPECT_EQ(hull_at(restarted, start)->flooded[0], 1.0) << start;
  }
}

TEST(ConditionTimeline, AcceptsRoundedVolumesOfFullTanks) {
  ConditionTimeline timeline(boxes());
  const double capacity = boxes().bodies()[0].subdivision->tanks[0].capacity();
  ASSERT_TRUE(receive(timeline, filled(0, 0, capacity * (1.0 + 1e-10))));
  EXPECT_EQ(hull_at(timeline, 0)->liquid_volumes[0], capacity);
  EXPECT_FALSE(receive(timeline, filled(0, 0, capacity * (1.0 + 1e-8))));
}

struct HostileCase {
  const char* name;
  ConditionChange change;
  const char* value;
  const char* expected;
};

std::vector<HostileCase> hostile_cases() {
  ConditionChange unknown_kind = flooded(100, 0, 0.5);
  unknown_kind.kind = static_cast<ConditionKind>(7);
  ConditionChange no_compartment = flooded(100, 0, 0.5, 3);
  return {
      {"above", flooded(100, 0, 1.5), "flooded = 1.5", "a number from 0 to 1"},
      {"below", flooded(100, 1, -1e-9), "flooded = -1e-09", "a number from 0 to 1"},
      {"NaN", flooded(100, 0, kNaN), "flooded = nan", "a number from 0 to 1"},
      {"infinite", flooded(100, 0, kInfinity), "flooded = inf", "a number from 0 to 1"},
      {"litres", filled(100, 0, 500.0), "liquid_volume = 500", "from 0 to the tank's volume, 1 m^3"},
      {"negative", filled(100, 0, -0.1), "liquid_volume = -0.1", "from 0 to the tank's volume, 1 m^3"},
      {"no volume", filled(100, 0, kNaN), "liquid_volume = nan", "from 0 to the tank's volume, 1 m^3"},
      {"kind", unknown_kind, "kind = 7", "COMPARTMENT (0) or TANK (1)"},
      {"index", flooded(100, 2, 0.5), "compartment 2", "an index from 0 to 1"},
      {"negative index", filled(100, -1, 0.5), "tank -1", "an index from 0 to 0"},
      {"largest index", filled(100, std::numeric_limits<std::int32_t>::max(), 0.5), "tank 2147483647",
       "an index from 0 to 0"},
      {"no compartment", no_compartment, "compartment 0", "a tank: the body has no compartments"},
  };
}

TEST(ConditionTimeline, IsUnknownFromAnUnusableChangeOn) {
  for (const HostileCase& hostile : hostile_cases()) {
    ConditionTimeline timeline(boxes());
    const Expected<void> received = receive(timeline, hostile.change);
    ASSERT_FALSE(received) << hostile.name;
    const std::string message = received.error().message();
    EXPECT_THAT(message, AllOf(HasSubstr(hostile.value), HasSubstr(hostile.expected),
                               HasSubstr("Likely cause"), HasSubstr("BAD_CONDITION")));
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    const std::size_t body = hostile.change.body_id == 1 ? 0 : 1;
    BodyCondition condition;
    UtimeRange range;
    EXPECT_TRUE(timeline.condition_at(99, body, boxes(), condition, range)) << hostile.name;
    EXPECT_EQ(range.last, 99) << hostile.name;
    for (const std::int64_t utime : {std::int64_t{100}, kLast}) {
      EXPECT_FALSE(timeline.condition_at(utime, body, boxes(), condition, range)) << hostile.name;
      EXPECT_TRUE(timeline.condition_at(utime, 1 - body, boxes(), condition, range)) << hostile.name;
    }
  }
}

TEST(ConditionTimeline, IsKnownAgainAfterAUsableChangeOfTheSame) {
  ConditionTimeline timeline(boxes());
  ASSERT_FALSE(receive(timeline, flooded(100, 0, kNaN)));
  ASSERT_TRUE(receive(timeline, flooded(200, 1, 0.5)));
  ASSERT_TRUE(receive(timeline, filled(200, 0, 0.5)));
  EXPECT_FALSE(hull_at(timeline, 300)) << "the bow is still unknown";
  ASSERT_TRUE(receive(timeline, flooded(300, 0, 0.5)));
  EXPECT_FALSE(hull_at(timeline, 299));
  EXPECT_EQ(hull_at(timeline, 300)->flooded, (std::vector{0.5, 0.5}));
}

TEST(ConditionTimeline, IsKnownAgainAfterAnyUsableChangeIfNoneWasNamed) {
  ConditionTimeline timeline(boxes());
  ASSERT_FALSE(receive(timeline, flooded(100, 9, 0.5)));
  ASSERT_FALSE(receive(timeline, flooded(200, 0, kNaN)));
  EXPECT_FALSE(hull_at(timeline, 250));
  ASSERT_TRUE(receive(timeline, flooded(200, 0, 0.0)));
  EXPECT_FALSE(hull_at(timeline, 199));
  EXPECT_EQ(hull_at(timeline, 200), kAtFirst);
}

TEST(ConditionTimeline, RejectsWhatConcernsNoneOfItsBodies) {
  ConditionTimeline timeline(boxes());
  std::vector<std::uint8_t> cut = encoded(flooded(0, 0, 1.0));
  cut.pop_back();
  const Expected<void> truncated = timeline.receive(cut, boxes());
  ASSERT_FALSE(truncated);
  EXPECT_THAT(truncated.error().message(), HasSubstr("body_condition_t of this version"));
  const Expected<void> unknown = receive(timeline, flooded(0, 0, 1.0, 77));
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message(), HasSubstr("body_id = 77"));
  const Expected<void> plain = receive(timeline, flooded(0, 0, 1.0, 2));
  ASSERT_FALSE(plain);
  EXPECT_THAT(plain.error().message(), HasSubstr("body 2 (plain)"));
  EXPECT_EQ(hull_at(timeline, 0), kAtFirst);
}

TEST(ConditionTimeline, KeepsWhatWasReceivedForTheSameItems) {
  ConditionTimeline timeline(boxes());
  ASSERT_TRUE(receive(timeline, flooded(100, 0, 1.0)));
  ASSERT_TRUE(receive(timeline, filled(100, 0, 0.75, 3)));
  const std::string same = damaged_boxes({.bow_flooded = "0.5", .stern_flooded = "0.75"});
  const auto after = [&timeline](const std::string& text, std::int64_t utime) {
    ConditionTimeline next = timeline;
    const Scene scene = scene_of(text);
    next = next.for_scene(boxes(), scene);
    return hull_at(next, utime, scene);
  };
  EXPECT_EQ(after(same, 100), (BodyCondition{{1.0, 0.75}, {0.5}}));
  EXPECT_EQ(after(same, 99), (BodyCondition{{0.5, 0.75}, {0.5}})) << "as the new scene file says";
  const auto with = [](const std::string& part, const std::string& by) {
    std::string text = damaged_boxes();
    return text.replace(text.find(part), part.size(), by);
  };
  EXPECT_EQ(after(with("\"bow\"", "\"forepeak\""), 100), kAtFirst);
  EXPECT_EQ(after(with("[1, 1, 1]", "[1, 1, 0.5]"), 100)->flooded, kAtFirst.flooded) << "a smaller tank";
  const Scene other_ids = scene_of(with("id = 1\n", "id = 8\n"));
  timeline = timeline.for_scene(boxes(), other_ids);
  EXPECT_EQ(hull_at(timeline, 100, other_ids), kAtFirst);
  BodyCondition barge;
  UtimeRange range;
  EXPECT_TRUE(timeline.condition_at(100, 1, other_ids, barge, range));
  EXPECT_EQ(barge.liquid_volumes, std::vector{0.75}) << "of body 3";
}

// The condition at a time is that of the change, of those that hold then, that was received last.
class TimelineModel {
 public:
  void receive(const ConditionChange& change, bool usable, bool named) {
    changes_.push_back({change, usable, named});
  }
  std::optional<BodyCondition> at(std::int64_t utime) const {
    BodyCondition condition = kAtFirst;
    std::vector<bool> known(4, true);  // two compartments, a tank, and changes that name none
    for (const auto& [change, usable, named] : changes_) {
      if (change.utime > utime) continue;
      const auto index = static_cast<std::size_t>(change.index);
      const bool is_tank = change.kind == ConditionKind::kTank;
      if (named) known[is_tank ? 2 : index] = usable;
      if (usable || !named) known[3] = usable;
      if (usable)
        (is_tank ? condition.liquid_volumes : condition.flooded)[index] =
            is_tank ? change.liquid_volume : change.flooded;
    }
    if (std::ranges::find(known, false) != known.end()) return std::nullopt;
    return condition;
  }

 private:
  struct Received {
    ConditionChange change;
    bool usable;
    bool named;
  };
  std::vector<Received> changes_;
};

RC_GTEST_PROP(ConditionTimeline, AgreesWithAModelThatKeepsEverything, ()) {
  ConditionTimeline timeline(boxes());
  TimelineModel model;
  const auto count = *rc::gen::inRange<std::size_t>(0, ConditionHistory::kMaxChanges);
  for (std::size_t i = 0; i < count; ++i) {
    ConditionChange change;
    change.utime = *rc::gen::inRange<std::int64_t>(0, 12);
    change.body_id = 1;
    change.kind = static_cast<ConditionKind>(*rc::gen::inRange(0, 2));
    change.index = *rc::gen::inRange(0, change.kind == ConditionKind::kTank ? 1 : 2);
    const double value = *rc::gen::element(0.0, 0.25, 0.5, 0.75, 1.0, -1.0, kNaN);
    change.flooded = value;
    change.liquid_volume = value;
    const bool named = *rc::gen::inRange(0, 8) != 0;
    if (!named) change.index += 2;
    const bool usable = named && value >= 0.0;
    RC_ASSERT(receive(timeline, change).has_value() == usable);
    model.receive(change, usable, named);
  }
  for (std::int64_t utime = -1; utime <= 12; ++utime) {
    RC_ASSERT(hull_at(timeline, utime) == model.at(utime));
    BodyCondition condition;
    UtimeRange range;
    timeline.condition_at(utime, 0, boxes(), condition, range);
    RC_ASSERT(range.contains(utime));
    for (std::int64_t other = -1; other <= 12; ++other) {
      if (range.contains(other)) RC_ASSERT(hull_at(timeline, other) == hull_at(timeline, utime));
    }
  }
}

}  // namespace
}  // namespace buoyancy
