// Replays of logs in which compartments and tanks change.
#include "engine/request_handler.h"
#include "messages/status.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/damaged_boxes.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr const char* kChannel = "BUOYANCY_CONDITION";
constexpr int kRequests = 6'000;  // of four blocks, and more than a batch holds

std::string condition_event(std::int64_t timestamp, const ConditionChange& change,
                            const std::string& channel = kChannel) {
  return event(channel, timestamp, encoded(change));
}

// Every 97th event is a change, some of them for earlier or later requests, and one cannot be used.
std::vector<ConditionChange> changes_at(int i) {
  std::vector<ConditionChange> changes;
  if (i % 97 == 5) changes.push_back(flooded(i + i % 7 - 3, (i / 97) % 2, 0.25 * (i % 5)));
  if (i % 1'310 == 7) changes.push_back(filled(i, 0, 0.125 * (i % 9)));
  if (i == 3'000) changes.push_back(filled(i, 0, -1.0));
  return changes;
}

std::string log_with_damage(const std::string& channel = kChannel) {
  std::string log;
  for (int i = 0; i < kRequests; ++i) {
    for (const ConditionChange& change : changes_at(i)) log += condition_event(i, change, channel);
    log += event("BUOYANCY_STATES", i, request(i, 0.0001 * i - 0.3));
  }
  return log;
}

class ReplayWithConditions : public Replay {
 protected:
  void SetUp() override { scene_ = write("damaged.toml", damaged_boxes()); }

  std::vector<LoggedEvent> wrenches(const std::string& file) const {
    return events_of(path(file), only_channel(std::string(kWrenchesChannel)));
  }
};

TEST_F(ReplayWithConditions, RespondsLikeOneHandlerOnAnyThreads) {
  const std::string input = write("in.lcmlog", log_with_damage());
  for (const char* jobs : {"1", "3", "8"}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), {"--jobs", jobs});
    EXPECT_EQ(finished.exit_code, 1) << "one change cannot be used";
    EXPECT_TRUE(contains(finished.standard_error,
                         "event at 3000 us: a condition received for body 1 (hull), ballast"));
    const Scene scene = scene_of(damaged_boxes());
    RequestHandler handler(scene, {.threads = 1});
    const std::vector<LoggedEvent> found = wrenches("out.lcmlog");
    const std::vector<LoggedEvent> hydrostatics =
        events_of(path("out.lcmlog"), only_channel(std::string(kHydrostaticsChannel)));
    ASSERT_EQ(found.size(), std::size_t{kRequests});
    ASSERT_EQ(hydrostatics.size(), std::size_t{kRequests});
    for (int i = 0; i < kRequests; ++i) {
      const auto at = static_cast<std::size_t>(i);
      for (const ConditionChange& change : changes_at(i)) handler.receive_condition(encoded(change));
      const Bytes expected = handler.handle(request(i, 0.0001 * i - 0.3));
      ASSERT_TRUE(std::ranges::equal(found[at].bytes, expected)) << i << " of " << jobs << " threads";
      ASSERT_TRUE(std::ranges::equal(hydrostatics[at].bytes, handler.last_hydrostatics())) << i;
    }
    EXPECT_EQ(handler.counters().bodies[static_cast<std::size_t>(BodyStatus::kBadCondition)], 937);
  }
}

TEST_F(ReplayWithConditions, JoinsPartsToTheWholeOutput) {
  const std::string input = write("in.lcmlog", log_with_damage("DAMAGE"));
  const std::vector<std::string> channel{"--condition-channel", "DAMAGE"};
  const FinishedProcess whole = replay(input, path("whole.lcmlog"), channel);
  ASSERT_EQ(whole.exit_code, 1) << whole.standard_error;
  for (const char* part : {"3/3", "1/3", "2/3"}) {
    const FinishedProcess finished =
        replay(input, path("out.lcmlog"), {"--condition-channel", "DAMAGE", "--part", part});
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  }
  const FinishedProcess joined = run({"--join", "3", input, path("out.lcmlog")});
  EXPECT_EQ(joined.exit_code, 1) << joined.standard_error;
  EXPECT_EQ(joined.standard_error, whole.standard_error);
  EXPECT_TRUE(read_file(path("out.lcmlog")) == read_file(path("whole.lcmlog")));
  const auto counts = [](const std::string& summary) { return summary.substr(0, summary.find("seconds")); };
  EXPECT_EQ(counts(joined.standard_output), counts(whole.standard_output));
  EXPECT_TRUE(contains(whole.standard_output, "conditions"));
}

TEST_F(ReplayWithConditions, CopiesTheMessagesIfAsked) {
  const std::string input = write("in.lcmlog", condition_event(1, flooded(0, 0, 1.0)) + log_of_requests(2));
  ASSERT_EQ(replay(input, path("out.lcmlog"), {"--copy", ".*"}).exit_code, 0);
  EXPECT_EQ(events_of(path("out.lcmlog"), only_channel(kChannel)).size(), 1U);
}

TEST_F(ReplayWithConditions, RefusesOneChannelForTwoTypes) {
  const std::string input = write("in.lcmlog", log_of_requests(1));
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--condition-channel", "BUOYANCY_STATES"},
        std::vector<std::string>{"--pose", "BUOYANCY_CONDITION=1"}}) {
    const FinishedProcess finished = replay(input, path("out.lcmlog"), options);
    EXPECT_EQ(finished.exit_code, 2) << finished.standard_error;
  }
}

TEST_F(ReplayWithConditions, IgnoresTheChannelOfAPlainScene) {
  scene_ = write("scene.toml", kOneBoxScene);
  const std::string input = write("in.lcmlog", condition_event(1, flooded(0, 0, 7.0)) + log_of_requests(2));
  EXPECT_EQ(replay(input, path("out.lcmlog")).exit_code, 0);
}

}  // namespace
}  // namespace buoyancy
