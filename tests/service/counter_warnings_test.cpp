#include "service/daemon/counter_warnings.h"

#include <functional>
#include <utility>
#include <vector>

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
  EXPECT_TRUE(warnings_since(ServiceCounters{}, now, {}).empty());
}

// One event for each counter that grows, by how much it grew, and what to do where the name does not say it.
TEST(CounterWarnings, NameEveryCounterThatGrows) {
  struct Case {
    std::function<std::int64_t&(ServiceCounters&)> counter;
    const char* message;
    const char* detail;
  };
  const auto field = [](std::int64_t ServiceCounters::*counter) {
    return [counter](ServiceCounters& counters) -> std::int64_t& { return counters.*counter; };
  };
  const auto bodies = [](BodyStatus status) {
    return [status](ServiceCounters& counters) -> std::int64_t& { return count(counters, status); };
  };
  const std::vector<Case> cases{
      {field(&ServiceCounters::rejected_truncated), "messages rejected, shorter than the fixed fields", ""},
      {field(&ServiceCounters::rejected_fingerprint), "messages rejected, fingerprint of another type", ""},
      {field(&ServiceCounters::rejected_count), "messages rejected, count out of range", ""},
      {field(&ServiceCounters::rejected_length), "messages rejected, ", ""},
      {bodies(BodyStatus::kUnknownBody), "bodies with status UNKNOWN_BODY", ""},
      {bodies(BodyStatus::kNonFinitePose), "bodies with status NON_FINITE_POSE", ""},
      {bodies(BodyStatus::kNoSea), "bodies with status NO_SEA", "start what publishes it before the clients"},
      {bodies(BodyStatus::kBadCondition), "bodies with status BAD_CONDITION",
       "see the warning about its message"},
      {bodies(BodyStatus::kNonFiniteTwist), "bodies with status NON_FINITE_TWIST",
       "bodies with drag or added mass"},
      {bodies(BodyStatus::kNotCertified), "bodies with status NOT_CERTIFIED",
       "a trough uncovers the sea bed"},
      {field(&ServiceCounters::seas_rejected), "seas rejected", "up, gravity or the current"},
      {field(&ServiceCounters::bodies_work_capped),
       "bodies in waves with an error bound above their tolerance", "Raise the tolerance"},
      {field(&ServiceCounters::bodies_sea_too_steep), "bodies in a sea too steep for linear theory",
       "buoyancyd --check reports the steepness"},
      {field(&ServiceCounters::bodies_below_bed), "bodies that reach below the sea bed", "a body that sinks"},
      {field(&ServiceCounters::rejected_bodies), "requests rejected, more than 10000 bodies more", "repeats"},
      {field(&ServiceCounters::rejected_points), "requests rejected, more points than", "distribute"},
      {field(&ServiceCounters::water_points_failed), "points at which the water is not known", "NaN"},
      {field(&ServiceCounters::rejected_work), "requests rejected, computed for more than", "distribute"},
      {field(&ServiceCounters::rejected_busy), "requests rejected, ", "too many clients"},
      {field(&ServiceCounters::rejected_memory), "messages rejected, out of memory", "more memory"},
      {field(&ServiceCounters::outputs_too_large), "hydrostatics or loads of more than", "was sent"},
      {field(&ServiceCounters::replies_evicted), "stored replies discarded", "computed again"}};
  for (const auto& [counter, message, detail] : cases) {
    ServiceCounters before;
    counter(before) = 3;
    ServiceCounters now = before;
    EXPECT_TRUE(warnings_since(before, now, {}).empty()) << message;
    counter(now) += 4;
    const std::vector<LogEvent> warnings = warnings_since(before, now, {});
    ASSERT_EQ(warnings.size(), 1U) << message;
    EXPECT_THAT(warnings[0].message, HasSubstr(message));
    EXPECT_EQ(warnings[0].count, 4) << message;
    EXPECT_THAT(warnings[0].detail, HasSubstr(detail));
    EXPECT_EQ(warnings[0].detail.empty(), *detail == '\0') << message;
  }
}

TEST(CounterWarnings, NameTheNewestBodyOfAStatus) {
  BodyFailures newest;
  newest[static_cast<std::size_t>(BodyStatus::kUnknownBody)] = {42, 7};
  newest[static_cast<std::size_t>(BodyStatus::kNoSea)] = {43, 8};
  ServiceCounters now;
  count(now, BodyStatus::kUnknownBody) = 2;
  count(now, BodyStatus::kNoSea) = 1;
  const std::vector<LogEvent> warnings = warnings_since(ServiceCounters{}, now, newest);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0].detail, "body 7 in session 42");
  EXPECT_THAT(warnings[1].detail, HasSubstr("body 8 in session 43; no sea has been received"));
}

TEST(CounterWarnings, NameEveryLossThatGrows) {
  for (const auto& [counter, message] :
       {std::pair{&DropCounts::packets, "packets dropped by the kernel"},
        {&DropCounts::oversized_messages, "dropped"},
        {&DropCounts::partial_messages_evicted, "incomplete messages discarded"},
        {&DropCounts::fragments, "fragments of incomplete or contradictory messages dropped"}}) {
    DropCounts before;
    before.*counter = 3;
    DropCounts now = before;
    EXPECT_TRUE(warnings_since(before, now, {}).empty());
    now.*counter = 7;
    const std::vector<LogEvent> warnings = warnings_since(before, now, {});
    ASSERT_EQ(warnings.size(), 1U) << message;
    EXPECT_THAT(warnings[0].message, HasSubstr(message));
    EXPECT_EQ(warnings[0].count, 4);
  }
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

TEST(CounterWarnings, DescribeInjectedFaultsByKind) {
  EXPECT_EQ(describe_faults(
                {.dropped = 1, .delayed = 2, .duplicated = 3, .reordered = 4, .corrupted = 5, .stalls = 6}),
            "1 response dropped, 2 delayed, 3 duplicated, 4 reordered, 5 corrupted; 6 stalls");
}

}  // namespace
}  // namespace buoyancy::service
