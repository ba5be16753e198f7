#include "service/daemon/latest_request_queue.h"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

using PushResult = LatestRequestQueue::PushResult;

constexpr std::size_t kManyBytes = 1'000'000;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

PushResult push(LatestRequestQueue& queue, std::int64_t session, std::int64_t seq, const std::string& text) {
  return queue.push({.id = {0, session, seq}}, bytes_of(text), 0.0);
}

std::vector<std::string> pop_all(LatestRequestQueue& queue) {
  std::vector<std::string> popped;
  while (queue.pop_next([](const SessionKey&) { return true; },
                        [&](Bytes bytes, double) { popped.emplace_back(bytes.begin(), bytes.end()); })) {
  }
  return popped;
}

using Strings = std::vector<std::string>;

TEST(LatestRequestQueue, KeepsNewestOfEachSession) {
  LatestRequestQueue queue(8, kManyBytes);
  EXPECT_EQ(push(queue, 1, 10, "a10"), PushResult::kQueued);
  EXPECT_EQ(push(queue, 2, 5, "b5"), PushResult::kQueued);
  EXPECT_EQ(push(queue, 1, 11, "a11"), PushResult::kReplaced);
  EXPECT_EQ(push(queue, 2, 4, "b4"), PushResult::kStale);
  EXPECT_EQ(pop_all(queue), (Strings{"a11", "b5"})) << "the session that has waited longest comes first";
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(pop_all(queue), Strings{});
}

TEST(LatestRequestQueue, KeepsLastArrivalOfEqualSeqs) {
  LatestRequestQueue queue(8, kManyBytes);
  push(queue, 1, 10, "first");
  EXPECT_EQ(push(queue, 1, 10, "second"), PushResult::kReplaced);
  EXPECT_EQ(pop_all(queue), Strings{"second"});
  EXPECT_EQ(push(queue, 1, 10, "third"), PushResult::kQueued) << "a retry of a popped request is queued";
}

TEST(LatestRequestQueue, DropsStaleRequestsAfterNewestWasPopped) {
  LatestRequestQueue queue(8, kManyBytes);
  push(queue, 1, 100, "a");
  pop_all(queue);
  EXPECT_EQ(push(queue, 1, 99, "b"), PushResult::kStale);
  EXPECT_EQ(push(queue, 1, 36, "c"), PushResult::kStale);
  EXPECT_EQ(push(queue, 1, 35, "d"), PushResult::kQueued) << "low enough for a restarted client";
  EXPECT_EQ(pop_all(queue), Strings{"d"});
  EXPECT_EQ(push(queue, 1, 36, "e"), PushResult::kQueued) << "the session continues from there";
}

TEST(LatestRequestQueue, AcceptsLowerSeqAfterRestartIdleTime) {
  LatestRequestQueue queue(8, kManyBytes);
  queue.push({.id = {0, 1, 30}}, bytes_of("old"), 10.0);
  pop_all(queue);
  EXPECT_EQ(queue.push({.id = {0, 1, 0}}, bytes_of("late"), 10.1), PushResult::kStale);
  EXPECT_EQ(queue.push({.id = {0, 1, 0}}, bytes_of("new"), 10.3), PushResult::kQueued);
  EXPECT_EQ(queue.push({.id = {0, 1, 1}}, bytes_of("newer"), 10.301), PushResult::kReplaced)
      << "the session continues from there";
  EXPECT_EQ(pop_all(queue), Strings{"newer"});
}

TEST(LatestRequestQueue, QueuesEveryRequestOfRestartedClient) {
  LatestRequestQueue queue(8, kManyBytes);
  push(queue, 1, 1000, "old");
  pop_all(queue);
  for (std::int64_t seq = 0; seq < 1100; ++seq) {
    ASSERT_EQ(push(queue, 1, seq, "new"), PushResult::kQueued) << seq;
    pop_all(queue);
  }
}

TEST(LatestRequestQueue, ComparesSeqsAtLimitsOfTheirRange) {
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kHighest = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(supersedes(kHighest, kLowest));
  EXPECT_TRUE(supersedes(kLowest, kHighest)) << "a restart";
  EXPECT_FALSE(supersedes(kHighest - 1, kHighest));
  EXPECT_FALSE(supersedes(kLowest, kLowest + 64));
  EXPECT_TRUE(supersedes(kLowest, kLowest + 65));
  EXPECT_TRUE(supersedes(kLowest, kLowest));
}

TEST(LatestRequestQueue, ReportsFullIfEverySessionHasPendingRequest) {
  LatestRequestQueue queue(2, kManyBytes);
  push(queue, 1, 1, "a");
  push(queue, 2, 1, "b");
  EXPECT_EQ(push(queue, 3, 1, "c"), PushResult::kFull);
  EXPECT_EQ(push(queue, 2, 2, "b2"), PushResult::kReplaced) << "a known session needs no place";
  EXPECT_EQ(pop_all(queue), (Strings{"a", "b2"}));
  EXPECT_EQ(push(queue, 3, 1, "c"), PushResult::kQueued);
  EXPECT_EQ(pop_all(queue), Strings{"c"});
}

TEST(LatestRequestQueue, ServesSessionsInTurnWhateverTheirRequestRates) {
  LatestRequestQueue queue(8, kManyBytes);
  Strings popped;
  std::int64_t seq = 0;
  push(queue, 1, 1, "slow");
  for (int round = 0; round < 6; ++round) {
    for (int i = 0; i < 10; ++i) {
      ++seq;
      push(queue, 2, seq, "fast" + std::to_string(seq));
      push(queue, 3, seq, "faster" + std::to_string(seq));
    }
    queue.pop_next([](const SessionKey&) { return true; },
                   [&](Bytes bytes, double) { popped.emplace_back(bytes.begin(), bytes.end()); });
    push(queue, 1, seq, "slow");
  }
  EXPECT_EQ(popped, (Strings{"slow", "fast20", "faster30", "slow", "fast50", "faster60"}));
}

TEST(LatestRequestQueue, EvictsLeastRecentlyUsedSession) {
  LatestRequestQueue queue(2, kManyBytes);
  push(queue, 1, 50, "a");
  push(queue, 2, 50, "b");
  push(queue, 1, 51, "a");
  pop_all(queue);
  push(queue, 3, 1, "c");  // evicts session 2
  pop_all(queue);
  EXPECT_EQ(push(queue, 1, 50, "a"), PushResult::kStale) << "1 is still known";
  EXPECT_EQ(push(queue, 2, 49, "b"), PushResult::kQueued) << "2 is not";
}

TEST(LatestRequestQueue, ReturnsArrivalTimeOfNewestRequest) {
  LatestRequestQueue queue(2, kManyBytes);
  queue.push({.id = {0, 1, 1}}, bytes_of("a"), 1.5);
  queue.push({.id = {0, 1, 2}}, bytes_of("b"), 2.5);
  EXPECT_TRUE(queue.pop_next([](const SessionKey&) { return true; },
                             [](Bytes, double arrival) { EXPECT_EQ(arrival, 2.5); }));
}

TEST(LatestRequestQueue, KeepsPendingRequestsWithinTheirMemory) {
  LatestRequestQueue queue(8, 1'000);
  const std::string large(400, 'a');
  EXPECT_EQ(push(queue, 1, 1, large), PushResult::kQueued);
  EXPECT_EQ(push(queue, 2, 1, large), PushResult::kQueued);
  EXPECT_EQ(push(queue, 3, 1, large), PushResult::kFull);
  EXPECT_EQ(push(queue, 1, 2, large), PushResult::kReplaced);
  EXPECT_TRUE(queue.pop_next([](const SessionKey& session) { return session == 2; }, [](Bytes, double) {}));
  EXPECT_FALSE(queue.pop_next([](const SessionKey& session) { return session == 2; }, [](Bytes, double) {}));
  EXPECT_EQ(push(queue, 3, 1, large), PushResult::kQueued) << "in the memory of a popped one";
  EXPECT_EQ(push(queue, 4, 1, std::string(2'000, 'a')), PushResult::kFull);
}

}  // namespace
}  // namespace buoyancy::service
