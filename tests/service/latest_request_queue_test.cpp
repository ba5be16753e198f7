#include "service/daemon/latest_request_queue.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

using Fate = LatestQuestions::Fate;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Fate offer(LatestQuestions& latest, std::int64_t session, std::int64_t seq, const std::string& text) {
  return latest.offer({0, session, seq}, bytes_of(text), 0.0);
}

std::vector<std::string> take_all(LatestQuestions& latest) {
  std::vector<std::string> taken;
  while (latest.take_next([&](Bytes bytes, double) { taken.emplace_back(bytes.begin(), bytes.end()); })) {
  }
  return taken;
}

using Strings = std::vector<std::string>;

TEST(LatestQuestions, KeepsTheNewestOfEachSession) {
  LatestQuestions latest(8);
  EXPECT_EQ(offer(latest, 1, 10, "a10"), Fate::kWaits);
  EXPECT_EQ(offer(latest, 2, 5, "b5"), Fate::kWaits);
  EXPECT_EQ(offer(latest, 1, 11, "a11"), Fate::kOvertook);
  EXPECT_EQ(offer(latest, 2, 4, "b4"), Fate::kStale);
  EXPECT_EQ(take_all(latest), (Strings{"a11", "b5"})) << "who has waited longest comes first";
  EXPECT_TRUE(latest.empty());
  EXPECT_EQ(take_all(latest), Strings{});
}

TEST(LatestQuestions, PrefersTheLastToArriveOfEqualSeq) {
  LatestQuestions latest(8);
  offer(latest, 1, 10, "first");
  EXPECT_EQ(offer(latest, 1, 10, "second"), Fate::kOvertook);
  EXPECT_EQ(take_all(latest), Strings{"second"});
  EXPECT_EQ(offer(latest, 1, 10, "third"), Fate::kWaits) << "a repeat of what was answered is answered";
}

TEST(LatestQuestions, KnowsWhatIsStaleAfterTheNewestWasTaken) {
  LatestQuestions latest(8);
  offer(latest, 1, 100, "a");
  take_all(latest);
  EXPECT_EQ(offer(latest, 1, 99, "b"), Fate::kStale);
  EXPECT_EQ(offer(latest, 1, 36, "c"), Fate::kStale);
  EXPECT_EQ(offer(latest, 1, 35, "d"), Fate::kWaits) << "so far back that the asker started over";
  EXPECT_EQ(take_all(latest), Strings{"d"});
  EXPECT_EQ(offer(latest, 1, 36, "e"), Fate::kWaits) << "and counts on from there";
}

TEST(LatestQuestions, TakesALowerSeqAfterASilenceForAnAskerThatStartedOver) {
  LatestQuestions latest(8);
  latest.offer({0, 1, 30}, bytes_of("old"), 10.0);
  take_all(latest);
  EXPECT_EQ(latest.offer({0, 1, 0}, bytes_of("late"), 10.1), Fate::kStale);
  EXPECT_EQ(latest.offer({0, 1, 0}, bytes_of("new"), 10.3), Fate::kWaits);
  EXPECT_EQ(latest.offer({0, 1, 1}, bytes_of("newer"), 10.301), Fate::kOvertook)
      << "and counts on from there";
  EXPECT_EQ(take_all(latest), Strings{"newer"});
}

TEST(LatestQuestions, AnswersEveryStepOfAnAskerThatStartedOver) {
  LatestQuestions latest(8);
  offer(latest, 1, 1000, "old");
  take_all(latest);
  for (std::int64_t seq = 0; seq < 1100; ++seq) {
    ASSERT_EQ(offer(latest, 1, seq, "new"), Fate::kWaits) << seq;
    take_all(latest);
  }
}

TEST(LatestQuestions, ComparesSeqsAtTheEndsOfTheirRange) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(supersedes(kHighest, kLowest));
  EXPECT_TRUE(supersedes(kLowest, kHighest)) << "a restart";
  EXPECT_FALSE(supersedes(kHighest - 1, kHighest));
  EXPECT_FALSE(supersedes(kLowest, kLowest + 64));
  EXPECT_TRUE(supersedes(kLowest, kLowest + 65));
  EXPECT_TRUE(supersedes(kLowest, kLowest));
}

TEST(LatestQuestions, SaysWhenEverySessionWaits) {
  LatestQuestions latest(2);
  offer(latest, 1, 1, "a");
  offer(latest, 2, 1, "b");
  EXPECT_EQ(offer(latest, 3, 1, "c"), Fate::kNoRoom);
  EXPECT_EQ(offer(latest, 2, 2, "b2"), Fate::kOvertook) << "known sessions need no room";
  EXPECT_EQ(take_all(latest), (Strings{"a", "b2"}));
  EXPECT_EQ(offer(latest, 3, 1, "c"), Fate::kWaits);
  EXPECT_EQ(take_all(latest), Strings{"c"});
}

TEST(LatestQuestions, AnswersEverySessionInTurnHoweverFastTheOthersAsk) {
  LatestQuestions latest(8);
  Strings taken;
  std::int64_t seq = 0;
  offer(latest, 1, 1, "slow");
  for (int answered = 0; answered < 6; ++answered) {
    for (int i = 0; i < 10; ++i) {
      ++seq;
      offer(latest, 2, seq, "fast" + std::to_string(seq));
      offer(latest, 3, seq, "faster" + std::to_string(seq));
    }
    latest.take_next([&](Bytes bytes, double) { taken.emplace_back(bytes.begin(), bytes.end()); });
    offer(latest, 1, seq, "slow");
  }
  EXPECT_EQ(taken, (Strings{"slow", "fast20", "faster30", "slow", "fast50", "faster60"}));
}

TEST(LatestQuestions, ForgetsTheSessionThatWasUsedLeastRecently) {
  LatestQuestions latest(2);
  offer(latest, 1, 50, "a");
  offer(latest, 2, 50, "b");
  offer(latest, 1, 51, "a");
  take_all(latest);
  offer(latest, 3, 1, "c");  // in the place of 2
  take_all(latest);
  EXPECT_EQ(offer(latest, 1, 50, "a"), Fate::kStale) << "1 is still known";
  EXPECT_EQ(offer(latest, 2, 49, "b"), Fate::kWaits) << "2 is not";
}

TEST(LatestQuestions, GivesBackTheTimeOfArrival) {
  LatestQuestions latest(2);
  latest.offer({0, 1, 1}, bytes_of("a"), 1.5);
  latest.offer({0, 1, 2}, bytes_of("b"), 2.5);
  EXPECT_TRUE(latest.take_next([](Bytes, double arrival) { EXPECT_EQ(arrival, 2.5); }));
}

}  // namespace
}  // namespace buoyancy
