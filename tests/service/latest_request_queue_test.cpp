#include "service/daemon/latest_request_queue.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

using PushResult = LatestRequestQueue::PushResult;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

PushResult push(LatestRequestQueue& latest, std::int64_t session, std::int64_t seq, const std::string& text) {
  return latest.push({0, session, seq}, bytes_of(text), 0.0);
}

std::vector<std::string> take_all(LatestRequestQueue& latest) {
  std::vector<std::string> taken;
  while (latest.pop_next([&](Bytes bytes, double) { taken.emplace_back(bytes.begin(), bytes.end()); })) {
  }
  return taken;
}

using Strings = std::vector<std::string>;

TEST(LatestRequestQueue, KeepsTheNewestOfEachSession) {
  LatestRequestQueue latest(8);
  EXPECT_EQ(push(latest, 1, 10, "a10"), PushResult::kQueued);
  EXPECT_EQ(push(latest, 2, 5, "b5"), PushResult::kQueued);
  EXPECT_EQ(push(latest, 1, 11, "a11"), PushResult::kReplaced);
  EXPECT_EQ(push(latest, 2, 4, "b4"), PushResult::kStale);
  EXPECT_EQ(take_all(latest), (Strings{"a11", "b5"})) << "who has waited longest comes first";
  EXPECT_TRUE(latest.empty());
  EXPECT_EQ(take_all(latest), Strings{});
}

TEST(LatestRequestQueue, PrefersTheLastToArriveOfEqualSeq) {
  LatestRequestQueue latest(8);
  push(latest, 1, 10, "first");
  EXPECT_EQ(push(latest, 1, 10, "second"), PushResult::kReplaced);
  EXPECT_EQ(take_all(latest), Strings{"second"});
  EXPECT_EQ(push(latest, 1, 10, "third"), PushResult::kQueued) << "a repeat of what was answered is answered";
}

TEST(LatestRequestQueue, KnowsWhatIsStaleAfterTheNewestWasTaken) {
  LatestRequestQueue latest(8);
  push(latest, 1, 100, "a");
  take_all(latest);
  EXPECT_EQ(push(latest, 1, 99, "b"), PushResult::kStale);
  EXPECT_EQ(push(latest, 1, 36, "c"), PushResult::kStale);
  EXPECT_EQ(push(latest, 1, 35, "d"), PushResult::kQueued) << "so far back that the client started over";
  EXPECT_EQ(take_all(latest), Strings{"d"});
  EXPECT_EQ(push(latest, 1, 36, "e"), PushResult::kQueued) << "and counts on from there";
}

TEST(LatestRequestQueue, TakesALowerSeqAfterASilenceForAnAskerThatStartedOver) {
  LatestRequestQueue latest(8);
  latest.push({0, 1, 30}, bytes_of("old"), 10.0);
  take_all(latest);
  EXPECT_EQ(latest.push({0, 1, 0}, bytes_of("late"), 10.1), PushResult::kStale);
  EXPECT_EQ(latest.push({0, 1, 0}, bytes_of("new"), 10.3), PushResult::kQueued);
  EXPECT_EQ(latest.push({0, 1, 1}, bytes_of("newer"), 10.301), PushResult::kReplaced)
      << "and counts on from there";
  EXPECT_EQ(take_all(latest), Strings{"newer"});
}

TEST(LatestRequestQueue, AnswersEveryStepOfAnAskerThatStartedOver) {
  LatestRequestQueue latest(8);
  push(latest, 1, 1000, "old");
  take_all(latest);
  for (std::int64_t seq = 0; seq < 1100; ++seq) {
    ASSERT_EQ(push(latest, 1, seq, "new"), PushResult::kQueued) << seq;
    take_all(latest);
  }
}

TEST(LatestRequestQueue, ComparesSeqsAtTheEndsOfTheirRange) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(supersedes(kHighest, kLowest));
  EXPECT_TRUE(supersedes(kLowest, kHighest)) << "a restart";
  EXPECT_FALSE(supersedes(kHighest - 1, kHighest));
  EXPECT_FALSE(supersedes(kLowest, kLowest + 64));
  EXPECT_TRUE(supersedes(kLowest, kLowest + 65));
  EXPECT_TRUE(supersedes(kLowest, kLowest));
}

TEST(LatestRequestQueue, SaysWhenEverySessionWaits) {
  LatestRequestQueue latest(2);
  push(latest, 1, 1, "a");
  push(latest, 2, 1, "b");
  EXPECT_EQ(push(latest, 3, 1, "c"), PushResult::kFull);
  EXPECT_EQ(push(latest, 2, 2, "b2"), PushResult::kReplaced) << "known sessions need no room";
  EXPECT_EQ(take_all(latest), (Strings{"a", "b2"}));
  EXPECT_EQ(push(latest, 3, 1, "c"), PushResult::kQueued);
  EXPECT_EQ(take_all(latest), Strings{"c"});
}

TEST(LatestRequestQueue, AnswersEverySessionInTurnHoweverFastTheOthersAsk) {
  LatestRequestQueue latest(8);
  Strings taken;
  std::int64_t seq = 0;
  push(latest, 1, 1, "slow");
  for (int answered = 0; answered < 6; ++answered) {
    for (int i = 0; i < 10; ++i) {
      ++seq;
      push(latest, 2, seq, "fast" + std::to_string(seq));
      push(latest, 3, seq, "faster" + std::to_string(seq));
    }
    latest.pop_next([&](Bytes bytes, double) { taken.emplace_back(bytes.begin(), bytes.end()); });
    push(latest, 1, seq, "slow");
  }
  EXPECT_EQ(taken, (Strings{"slow", "fast20", "faster30", "slow", "fast50", "faster60"}));
}

TEST(LatestRequestQueue, ForgetsTheSessionThatWasUsedLeastRecently) {
  LatestRequestQueue latest(2);
  push(latest, 1, 50, "a");
  push(latest, 2, 50, "b");
  push(latest, 1, 51, "a");
  take_all(latest);
  push(latest, 3, 1, "c");  // in the place of 2
  take_all(latest);
  EXPECT_EQ(push(latest, 1, 50, "a"), PushResult::kStale) << "1 is still known";
  EXPECT_EQ(push(latest, 2, 49, "b"), PushResult::kQueued) << "2 is not";
}

TEST(LatestRequestQueue, GivesBackTheTimeOfArrival) {
  LatestRequestQueue latest(2);
  latest.push({0, 1, 1}, bytes_of("a"), 1.5);
  latest.push({0, 1, 2}, bytes_of("b"), 2.5);
  EXPECT_TRUE(latest.pop_next([](Bytes, double arrival) { EXPECT_EQ(arrival, 2.5); }));
}

}  // namespace
}  // namespace buoyancy::service
