#include "service/daemon/counter_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/one_box_scene.h"
#include "tests/support/scene_of.h"

namespace buoyancy::service {
namespace {

using ::testing::HasSubstr;

std::int64_t& count(ServiceCounters& counters, BodyStatus status) {
  return counters.bodies[static_cast<std::size_t>(status)];
}

TEST(CounterWarnings, AreEmptyIfNothingWentWrong) {
  ServiceCounters now;
  now.requests = 5;
  now.computed = 5;
  now.seas_received = 2;
  now.wave_patches = 1000;
  count(now, BodyStatus::kOk) = 5;
  EXPECT_TRUE(warnings_since({}, now).empty());
}

TEST(CounterWarnings, NameCausesOfRejectionAndBodyStatuses) {
  ServiceCounters before;
  before.rejected_count = 3;
  ServiceCounters now = before;
  now.rejected_count = 5;
  count(now, BodyStatus::kUnknownBody) = 4;
  const std::vector<LogEvent> warnings = warnings_since(before, now);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].message, "messages rejected, count out of range");
  EXPECT_EQ(warnings[0].count, 2);
  EXPECT_EQ(warnings[1].message, "bodies with status UNKNOWN_BODY");
  EXPECT_EQ(warnings[1].count, 4);
  EXPECT_EQ(warnings[1].detail, "");
}

TEST(CounterWarnings, SayWhatToDoWithoutSea) {
  ServiceCounters now;
  count(now, BodyStatus::kNoSea) = 2;
  const std::vector<LogEvent> warnings = warnings_since({}, now);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].message, "bodies with status NO_SEA");
  EXPECT_THAT(warnings[0].detail, HasSubstr("start what publishes it before the clients"));
}

TEST(CounterWarnings, PointToTheMessageOfAnUnusableCondition) {
  ServiceCounters now;
  now.conditions_rejected = 1;
  count(now, BodyStatus::kBadCondition) = 2;
  const std::vector<LogEvent> warnings = warnings_since({}, now);
  ASSERT_EQ(warnings.size(), 1U) << "the message has a warning of its own";
  EXPECT_EQ(warnings[0].message, "bodies with status BAD_CONDITION");
  EXPECT_THAT(warnings[0].detail, HasSubstr("see the warning about its message"));
}

TEST(CounterWarnings, SayWhereTwistsAreNeeded) {
  ServiceCounters now;
  count(now, BodyStatus::kNonFiniteTwist) = 3;
  const std::vector<LogEvent> warnings = warnings_since({}, now);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0].detail, HasSubstr("bodies with drag or added mass"));
}

TEST(CounterWarnings, NamePosesWithoutTheVelocitiesThatDragNeeds) {
  const PoseChannel pose{"FRAME", 1, ""};
  const std::optional<LogEvent> warning = missing_velocities(pose, scene_of(kLoadsBoxScene), 7);
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->message, "poses without velocities on FRAME, whose body 'hull' has drag or added mass");
  EXPECT_EQ(warning->count, 7);
  EXPECT_THAT(warning->detail, HasSubstr("Send pose_t instead of rigid_transform_t"));
  EXPECT_FALSE(missing_velocities(pose, scene_of(kOneBoxScene), 7));
  EXPECT_FALSE(missing_velocities({"FRAME", 2, ""}, scene_of(kLoadsBoxScene), 7)) << "no such body any more";
}

TEST(CounterWarnings, SayWhatToDoAboutWaves) {
  ServiceCounters now;
  now.seas_rejected = 1;
  now.bodies_work_capped = 20;
  now.bodies_sea_too_steep = 300;
  const std::vector<LogEvent> warnings = warnings_since({}, now);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_EQ(warnings[0].message, "seas rejected");
  EXPECT_EQ(warnings[0].count, 1);
  EXPECT_THAT(warnings[0].detail, HasSubstr("up, gravity or the current"));
  EXPECT_EQ(warnings[1].message, "bodies in waves with an error bound above their tolerance");
  EXPECT_EQ(warnings[1].count, 20);
  EXPECT_THAT(warnings[1].detail, HasSubstr("Raise the tolerance"));
  EXPECT_EQ(warnings[2].message, "bodies in a sea too steep for linear theory");
  EXPECT_EQ(warnings[2].count, 300);
  EXPECT_THAT(warnings[2].detail, HasSubstr("buoyancyd --check reports the steepness"));
  EXPECT_TRUE(warnings_since(now, now).empty());
}

TEST(CounterWarnings, DescribeInjectedFaultsByKind) {
  EXPECT_EQ(describe_faults(
                {.dropped = 1, .delayed = 2, .duplicated = 3, .reordered = 4, .corrupted = 5, .stalls = 6}),
            "1 response dropped, 2 delayed, 3 duplicated, 4 reordered, 5 corrupted; 6 stalls");
}

}  // namespace
}  // namespace buoyancy::service
