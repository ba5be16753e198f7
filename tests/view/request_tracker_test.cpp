#include "view/live/request_tracker.h"

#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy::view {
namespace {

constexpr std::int64_t kMillisecond = 1'000;  // us

RequestId request_id(std::int64_t session_id, std::int64_t seq) {
  return {0, session_id, seq};
}

TEST(RequestTracker, MeasuresTimeFromRequestToResponse) {
  RequestTracker tracker;
  EXPECT_TRUE(tracker.on_request(request_id(1, 5), 100 * kMillisecond, 0.1));
  EXPECT_TRUE(tracker.on_request(request_id(2, 5), 101 * kMillisecond, 0.101));
  EXPECT_DOUBLE_EQ(tracker.on_response(request_id(2, 5), 104 * kMillisecond).value(), 0.003);
  EXPECT_DOUBLE_EQ(tracker.on_response(request_id(1, 5), 107 * kMillisecond).value(), 0.007);
  EXPECT_EQ(tracker.counts().requests, 2);
  EXPECT_EQ(tracker.counts().responses, 2);
  EXPECT_EQ(tracker.counts().sessions, 2);
}

TEST(RequestTracker, MeasuresFromFirstArrivalOfRepeatedRequest) {
  RequestTracker tracker;
  tracker.on_request(request_id(1, 0), 0, 0.0);
  EXPECT_FALSE(tracker.on_request(request_id(1, 0), 100 * kMillisecond, 0.1));
  EXPECT_DOUBLE_EQ(tracker.on_response(request_id(1, 0), 101 * kMillisecond).value(), 0.101);
  EXPECT_EQ(tracker.on_response(request_id(1, 0), 102 * kMillisecond), std::nullopt);
  EXPECT_EQ(tracker.counts().requests, 1);
  EXPECT_EQ(tracker.counts().requests_repeated, 1);
  EXPECT_EQ(tracker.counts().responses, 1);
  EXPECT_EQ(tracker.counts().responses_repeated, 1);
}

TEST(RequestTracker, IgnoresGapsOfArbitrarySeq) {
  RequestTracker tracker;
  for (const std::int64_t utime : {5, 1'005, 2'005}) {
    EXPECT_FALSE(tracker.contains(request_id(1, utime)));
    EXPECT_TRUE(tracker.on_request(request_id(1, utime), utime, 0.0, SeqPolicy::kArbitrary));
    EXPECT_TRUE(tracker.contains(request_id(1, utime)));
  }
  EXPECT_EQ(tracker.counts().requests_missed, 0);
  EXPECT_EQ(tracker.counts().requests, 3);
}

TEST(RequestTracker, ExpiresUnansweredRequests) {
  RequestTracker tracker;
  tracker.on_request(request_id(1, 0), 0, 0.0);
  tracker.on_request(request_id(1, 1), 0, 0.1);
  ASSERT_TRUE(tracker.on_response(request_id(1, 1), 0));
  tracker.expire(RequestTracker::kTimeout);
  EXPECT_EQ(tracker.counts().unanswered, 0) << "not expired yet";
  tracker.expire(RequestTracker::kTimeout + 0.2);
  EXPECT_EQ(tracker.counts().unanswered, 1);
  EXPECT_EQ(tracker.size(), 0U);
  EXPECT_EQ(tracker.on_response(request_id(1, 0), 1), std::nullopt);
  EXPECT_EQ(tracker.counts().responses_without_request, 1);
}

TEST(RequestTracker, MatchesRequestRepeatedAfterExpiry) {
  RequestTracker tracker;
  tracker.on_request(request_id(1, 7), 0, 0.0);
  tracker.expire(10.0);
  EXPECT_FALSE(tracker.on_request(request_id(1, 7), 10'000 * kMillisecond, 10.0));
  EXPECT_DOUBLE_EQ(tracker.on_response(request_id(1, 7), 10'001 * kMillisecond).value(), 0.001);
  EXPECT_EQ(tracker.counts().requests, 1);
  EXPECT_EQ(tracker.counts().requests_repeated, 1);
}

TEST(RequestTracker, CountsSeqGapsButNoRestarts) {
  RequestTracker tracker;
  tracker.on_request(request_id(1, 10), 0, 0.0);
  tracker.on_request(request_id(1, 14), 0, 0.0);
  EXPECT_EQ(tracker.counts().requests_missed, 3);
  tracker.on_request(request_id(1, 3), 0, 0.0);
  tracker.on_request(request_id(1, 4), 0, 0.0);
  tracker.on_request(request_id(2, 1000), 0, 0.0);
  tracker.on_request(request_id(1, 4'000'000), 0, 0.0);
  EXPECT_EQ(tracker.counts().requests_missed, 3);
}

TEST(RequestTracker, ReturnsZeroWhenClockGoesBack) {
  RequestTracker tracker;
  tracker.on_request(request_id(1, 0), 5 * kMillisecond, 0.0);
  EXPECT_EQ(tracker.on_response(request_id(1, 0), kMillisecond), 0.0);
}

TEST(RequestTracker, DropsOldestBeyondMaxPending) {
  RequestTracker tracker;
  constexpr std::int64_t kExcess = 1'000;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(RequestTracker::kMaxPending) + kExcess; ++i) {
    tracker.on_request(request_id(i, i), 0, 0.0);
  }
  EXPECT_EQ(tracker.size(), RequestTracker::kMaxPending);
  EXPECT_EQ(tracker.counts().unanswered, kExcess);
}

RC_GTEST_PROP(RequestTracker, KeepsCountsConsistentForAnyTraffic, ()) {
  using Limits = std::numeric_limits<std::int64_t>;
  RequestTracker tracker;
  std::int64_t sent_requests = 0;
  std::int64_t sent_responses = 0;
  double now = 0.0;
  const auto steps = *rc::gen::inRange(0, 300);
  for (int i = 0; i < steps; ++i) {
    const auto session_id = *rc::gen::element<std::int64_t>(0, 1, -1, Limits::max(), Limits::min());
    const auto seq = *rc::gen::element<std::int64_t>(0, 1, 2, 3, 1'000, Limits::max(), Limits::min());
    const RequestId id = request_id(session_id, seq);
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        tracker.on_request(id, *rc::gen::inRange<std::int64_t>(0, 1'000), now);
        ++sent_requests;
        break;
      case 1:
        if (const auto latency = tracker.on_response(id, *rc::gen::inRange<std::int64_t>(0, 1'000))) {
          RC_ASSERT(*latency >= 0.0);
        }
        ++sent_responses;
        break;
      default:
        now += 0.5 * *rc::gen::inRange(0, 4);
        tracker.expire(now);
    }
  }
  tracker.expire(now + 2.0 * RequestTracker::kTimeout);
  const RequestTracker::Counts& counts = tracker.counts();
  RC_ASSERT(tracker.size() == 0U);
  RC_ASSERT(counts.requests + counts.requests_repeated == sent_requests);
  RC_ASSERT(counts.responses + counts.responses_repeated + counts.responses_without_request ==
            sent_responses);
  RC_ASSERT(counts.unanswered >= counts.requests - counts.responses);
  RC_ASSERT(counts.requests_missed >= 0);
}

}  // namespace
}  // namespace buoyancy::view
