#include "service/daemon/rate_limited_log.h"

#include <gtest/gtest.h>

namespace buoyancy::service {
namespace {

using Lines = std::vector<std::string>;

TEST(RateLimitedLog, LogsEventAtOnceThenCountsAtGrowingIntervals) {
  RateLimitedLog log;
  std::vector<std::pair<double, std::string>> logged;
  for (int second = 0; second <= 2000; ++second) {  // 5 per second
    log.add({"rejected", 5, {}}, second);
    for (const std::string& line : log.drain(second)) logged.emplace_back(second, line);
  }
  EXPECT_EQ(logged, (std::vector<std::pair<double, std::string>>{{0, "rejected: 5"},
                                                                 {1, "rejected: 5 in 1 s"},
                                                                 {11, "rejected: 50 in 10 s"},
                                                                 {71, "rejected: 300 in 60 s"},
                                                                 {671, "rejected: 3000 in 600 s"},
                                                                 {1271, "rejected: 3000 in 600 s"},
                                                                 {1871, "rejected: 3000 in 600 s"}}));
}

TEST(RateLimitedLog, WritesFewLinesForDayLongEvent) {
  RateLimitedLog log;
  std::size_t lines = 0;
  for (int second = 0; second < 86'400; ++second) {
    log.add({"rejected", 1, {}}, second);
    lines += log.drain(second).size();
  }
  EXPECT_LT(lines, 150U);
  EXPECT_GT(lines, 140U);
}

TEST(RateLimitedLog, CountsEveryOccurrence) {
  RateLimitedLog log;
  log.add({"rejected", 1, {}}, 0.0);
  EXPECT_EQ(log.drain(0.0), Lines{"rejected: 1"});
  log.add({"rejected", 7, {}}, 0.5);
  EXPECT_EQ(log.drain(0.5), Lines{});
  EXPECT_EQ(log.drain(1.0), Lines{"rejected: 7 in 1 s"}) << "although it does not occur again";
  EXPECT_EQ(log.drain(2.0), Lines{});
}

TEST(RateLimitedLog, KeepsTimeAndNewestDetailPerEvent) {
  RateLimitedLog log;
  log.add({"not sent", 1, "no route"}, 0.0);
  EXPECT_EQ(log.drain(0.0), Lines{"not sent: 1; no route"});
  log.add({"not sent", 1, "no route"}, 0.2);
  log.add({"not sent", 1, "too large"}, 0.3);
  log.add({"rejected", 2, {}}, 0.3);
  EXPECT_EQ(log.drain(0.3), Lines{"rejected: 2"});
  EXPECT_EQ(log.drain(1.0), Lines{"not sent: 2 in 1 s; too large"});
}

TEST(RateLimitedLog, LogsAtOnceAgainAfterLongestInterval) {
  RateLimitedLog log;
  for (int second = 0; second < 100; ++second) {
    log.add({"rejected", 1, {}}, second);
    log.drain(second);
  }
  EXPECT_EQ(log.drain(698.0).size(), 1U) << "the pending occurrences";
  log.drain(699.0);
  log.add({"rejected", 1, {}}, 700.0);
  EXPECT_EQ(log.drain(700.0), Lines{"rejected: 1"});
}

TEST(RateLimitedLog, IgnoresEventsWithCountZero) {
  RateLimitedLog log;
  log.add({"rejected", 0, {}}, 0.0);
  EXPECT_EQ(log.drain(0.0), Lines{});
}

}  // namespace
}  // namespace buoyancy::service
