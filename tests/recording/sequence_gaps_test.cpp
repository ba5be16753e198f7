#include "recording/sequence_gaps.h"

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

std::int64_t size_of(const SequenceGaps::Session& session) {
  std::int64_t size = 0;
  for (const SequenceGaps::Gap& gap : session.gaps) size += gap.last - gap.first + 1;
  return size;
}

// Numbers are lost, repeated and delayed; a set says which are missing.
TEST(SequenceGaps, AgreesWithASetOverRandomArrivals) {
  std::mt19937_64 generator(5);
  const auto chance = [&](double share) {
    return std::uniform_real_distribution(0.0, 1.0)(generator) < share;
  };
  for (int run = 0; run < 200; ++run) {
    SequenceGaps gaps;
    std::set<std::int64_t> seen;
    std::vector<std::int64_t> late;
    const std::int64_t start = run - 100;
    for (std::int64_t seq = start; seq < start + 300; ++seq) {
      if (seq == start || chance(0.8)) late.push_back(seq);
      if (chance(0.1)) late.push_back(seq);  // a retry
      while (!late.empty() && (seq == start || chance(0.7))) {
        const std::size_t next = generator() % late.size();
        gaps.add(7, late[next]);
        seen.insert(late[next]);
        late.erase(late.begin() + static_cast<std::ptrdiff_t>(next));
      }
    }
    const std::int64_t missing = *seen.rbegin() - *seen.begin() + 1 - static_cast<std::int64_t>(seen.size());
    ASSERT_EQ(gaps.missing(), missing) << run;
    for (std::int64_t seq = start - 5; seq < start + 305; ++seq) {
      const bool between = seq > *seen.begin() && seq < *seen.rbegin();
      EXPECT_EQ(gaps.is_missing(7, seq), between && !seen.contains(seq)) << seq;
      EXPECT_FALSE(gaps.is_missing(8, seq));
    }
    const auto incomplete = gaps.incomplete_sessions();
    ASSERT_EQ(incomplete.size(), missing > 0 ? 1U : 0U);
    if (missing == 0) continue;
    EXPECT_EQ(incomplete[0].session_id, 7);
    EXPECT_EQ(size_of(incomplete[0]), missing);
    for (const SequenceGaps::Gap& gap : incomplete[0].gaps) {
      for (std::int64_t seq = gap.first; seq <= gap.last; ++seq) EXPECT_FALSE(seen.contains(seq)) << seq;
    }
  }
}

TEST(SequenceGaps, CountsEverySessionOnItsOwn) {
  SequenceGaps gaps;
  for (const std::int64_t seq : {0, 1, 4}) gaps.add(1, seq);
  for (const std::int64_t seq : {100, 101, 103}) gaps.add(2, seq);
  gaps.add(3, 5);
  gaps.add(1, -10);  // a client that started over
  EXPECT_EQ(gaps.missing(), 3);
  EXPECT_EQ(gap_lines(gaps, "requests"),
            (std::vector<std::string>{"session 1: 2 requests missing, seq 2 to 3",
                                      "session 2: 1 requests missing, seq 102"}));
}

TEST(SequenceGaps, ListsTheFirstGapsOnly) {
  SequenceGaps gaps;
  for (std::int64_t seq = 0; seq <= 20; seq += 2) gaps.add(1, seq);
  EXPECT_EQ(gap_lines(gaps, "responses"),
            (std::vector<std::string>{
                "session 1: 10 responses missing, seq 1, 3, 5, 7, 9, 11, 13, 15 and 2 more gaps"}));
}

TEST(SequenceGaps, CountsTheWholeRangeOfNumbers) {
  constexpr std::int64_t kMin = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  SequenceGaps gaps;
  gaps.add(1, kMin);
  gaps.add(1, kMax);
  gaps.add(2, kMin);
  gaps.add(2, kMax);
  EXPECT_EQ(gaps.missing(), kMax);
}

// The counts stay right where memory is bounded.
TEST(SequenceGaps, CountsBeyondItsLimits) {
  SequenceGaps gaps;
  const auto sessions = static_cast<std::int64_t>(2 * SequenceGaps::kMaxSessions);
  for (std::int64_t session = 0; session < sessions; ++session) {
    gaps.add(session, 0);
    gaps.add(session, 2);
  }
  EXPECT_EQ(gaps.missing(), sessions);
  EXPECT_EQ(gaps.incomplete_sessions().size(), SequenceGaps::kMaxSessions);
  EXPECT_EQ(gaps.incomplete_sessions().front().session_id, sessions / 2)
      << "the least recently used are closed";

  SequenceGaps one;
  const auto count = static_cast<std::int64_t>(2 * SequenceGaps::kMaxGaps);
  for (std::int64_t i = 0; i <= count; ++i) one.add(1, 2 * i);
  EXPECT_EQ(one.missing(), count);
  one.add(1, 1);
  EXPECT_EQ(one.missing(), count - 1);
  EXPECT_EQ(one.incomplete_sessions()[0].gaps.size(), SequenceGaps::kMaxGaps - 1);
}

TEST(SequenceGaps, StaysBoundedWhereLateMessagesDivideOneGap) {
  SequenceGaps gaps;
  const auto late = static_cast<std::int64_t>(2 * SequenceGaps::kMaxGaps);
  gaps.add(1, 0);
  gaps.add(1, 2 * late + 2);
  for (std::int64_t i = 1; i <= late; ++i) gaps.add(1, 2 * i);
  EXPECT_EQ(gaps.incomplete_sessions()[0].gaps.size(), SequenceGaps::kMaxGaps);
  EXPECT_GE(gaps.missing(), late + 1) << "none is counted as seen that was not";
  EXPECT_TRUE(gaps.is_missing(1, 1));
}

}  // namespace
}  // namespace buoyancy
