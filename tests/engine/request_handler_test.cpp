#include "engine/request_handler.h"

#include <algorithm>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/box_scene.h"
#include "tests/engine/malformed_messages.h"
#include "tests/engine/reply.h"
#include "tests/support/allocation_count.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

ByteVector request(std::int64_t session_id, std::int64_t seq, double height = 0.0) {
  return request_bytes({.utime = 7, .session_id = session_id, .seq = seq}, {upright(kBox, height)});
}

std::int64_t bodies_computed(const ServiceCounters& counters) {
  std::int64_t sum = 0;
  for (const std::int64_t bodies : counters.bodies) sum += bodies;
  return sum;
}

TEST(RequestHandler, ReturnsResponseWithRequestId) {
  RequestHandler handler(shared_box_scene());
  const RequestId id{.utime = -5, .session_id = INT64_MIN, .seq = INT64_MAX};
  const WrenchResponse response =
      decoded<WrenchResponse>(handler.handle(request_bytes(id, {upright(kBox, 0.0)})));
  EXPECT_EQ(response.id.utime, id.utime);
  EXPECT_EQ(response.id.session_id, id.session_id);
  EXPECT_EQ(response.id.seq, id.seq);
  ASSERT_EQ(response.bodies.size(), 1U);
  EXPECT_NEAR(response.bodies[0].force[2], 0.5 * kWeight, response.bodies[0].force_error_bound);
  EXPECT_EQ(handler.counters().requests, 1);
  EXPECT_EQ(handler.counters().computed, 1);
}

TEST(RequestHandler, ReturnsBodiesInRequestedOrderWithRepetitions) {
  RequestHandler handler(shared_box_scene());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BodyState> bodies{upright(kOffsetBox, 0.1), upright(kBox, -0.2), upright(kNoBody, 0.0),
                                      upright(kOffsetBox, 0.3), upright(kBox, -0.2), upright(kFastBox, 9.0),
                                      upright(kBox, nan)};
  const WrenchResponse response =
      decoded<WrenchResponse>(handler.handle(request_bytes({.session_id = 1, .seq = 1}, bodies)));
  ASSERT_EQ(response.bodies.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) EXPECT_EQ(response.bodies[i].body_id, bodies[i].body_id);
  EXPECT_NEAR(response.bodies[0].submerged_volume, 0.4, 1e-13);
  EXPECT_NEAR(response.bodies[1].submerged_volume, 0.7, 1e-13);
  EXPECT_EQ(response.bodies[2].status, BodyStatus::kUnknownBody);
  EXPECT_NEAR(response.bodies[3].submerged_volume, 0.2, 1e-13);
  EXPECT_EQ(response.bodies[4].submerged_volume, response.bodies[1].submerged_volume);
  EXPECT_EQ(response.bodies[5].submerged_volume, 0.0);
  EXPECT_EQ(response.bodies[6].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(bodies_computed(handler.counters()), 7);
  const auto& newest = handler.newest_failures();
  EXPECT_FALSE(newest[static_cast<std::size_t>(BodyStatus::kOk)]);
  EXPECT_FALSE(newest[static_cast<std::size_t>(BodyStatus::kNoSea)]);
  const auto& unknown = newest[static_cast<std::size_t>(BodyStatus::kUnknownBody)];
  const auto& not_finite = newest[static_cast<std::size_t>(BodyStatus::kNonFinitePose)];
  ASSERT_TRUE(unknown && not_finite);
  EXPECT_EQ(unknown->body_id, kNoBody);
  EXPECT_EQ(unknown->session_id, 1);
  EXPECT_EQ(not_finite->body_id, kBox);
}

// A failure in an early slice is named although other requests are answered before the whole one is.
TEST(RequestHandler, NamesFailuresOfRequestsInSlices) {
  RequestHandler handler(shared_box_scene(), {.threads = 1});
  constexpr Deadline kPassed{};
  const ByteVector sliced = request_bytes({.session_id = 5, .seq = 1},
                                          {upright(kNoBody, 0.0), upright(kBox, 0.1), upright(kBox, 0.2)});
  ASSERT_EQ(handler.begin(sliced, kPassed), RequestHandler::Step::kStarted);
  handler.handle(request(6, 1));
  while (handler.in_progress() > 0) handler.resume(kPassed);
  const auto& unknown = handler.newest_failures()[static_cast<std::size_t>(BodyStatus::kUnknownBody)];
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->body_id, kNoBody);
  EXPECT_EQ(unknown->session_id, 5);
}

TEST(RequestHandler, HandlesThousandBodies) {
  RequestHandler handler(shared_box_scene());
  std::vector<BodyState> bodies(1000);
  for (int i = 0; i < 1000; ++i) bodies[static_cast<std::size_t>(i)] = upright(kBox, -0.5 + 1e-3 * i);
  const WrenchResponse response =
      decoded<WrenchResponse>(handler.handle(request_bytes({.session_id = 1, .seq = 1}, bodies)));
  ASSERT_EQ(response.bodies.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    ASSERT_NEAR(response.bodies[i].submerged_volume, 1.0 - 1e-3 * static_cast<double>(i), 1e-13);
  }
}

TEST(RequestHandler, ReportsBadLeadTimeForEveryKnownBody) {
  RequestHandler handler(shared_box_scene());
  const std::vector<BodyState> bodies{upright(kBox, 0.0), upright(kNoBody, 0.0), upright(kOffsetBox, 0.0)};
  const WrenchResponse response = decoded<WrenchResponse>(handler.handle(
      request_bytes({.session_id = 1, .seq = 1}, bodies, std::numeric_limits<double>::quiet_NaN())));
  ASSERT_EQ(response.bodies.size(), 3U);
  EXPECT_EQ(response.bodies[0].status, BodyStatus::kBadLeadTime);
  EXPECT_EQ(response.bodies[1].status, BodyStatus::kUnknownBody);
  EXPECT_EQ(response.bodies[2].status, BodyStatus::kBadLeadTime);
}

TEST(RequestHandler, ReturnsSameBytesForRetryWithoutComputing) {
  for (const ByteVector& bytes : {request(1, 1), request_bytes({.session_id = 1, .seq = 1}, {})}) {
    RequestHandler handler(shared_box_scene());
    const ByteVector first = copy_of(handler.handle(bytes));
    const ServiceCounters before = handler.counters();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(copy_of(handler.handle(bytes)), first);
    const ServiceCounters& after = handler.counters();
    EXPECT_EQ(after.requests, before.requests + 3);
    EXPECT_EQ(after.retries, 3);
    EXPECT_EQ(after.computed, before.computed);
    EXPECT_EQ(after.bodies, before.bodies);
    EXPECT_EQ(after.bodies_crossing, before.bodies_crossing);
  }
}

TEST(RequestHandler, RecomputesConflictingRetry) {
  RequestHandler handler(shared_box_scene());
  handler.handle(request(1, 1, 0.0));
  const WrenchResponse changed = decoded<WrenchResponse>(handler.handle(request(1, 1, 0.25)));
  EXPECT_NEAR(changed.bodies[0].submerged_volume, 0.25, 1e-13);
  EXPECT_EQ(handler.counters().conflicting_retries, 1);
  EXPECT_EQ(handler.counters().computed, 2);
  EXPECT_EQ(handler.counters().retries, 0);
  EXPECT_EQ(handler.counters().stale, 0);
  // From now on, a retry is compared with the changed request.
  EXPECT_NEAR(decoded<WrenchResponse>(handler.handle(request(1, 1, 0.25))).bodies[0].submerged_volume, 0.25,
              1e-13);
  EXPECT_EQ(handler.counters().retries, 1);
}

TEST(RequestHandler, AcceptsNegativeSequenceNumbers) {
  RequestHandler handler(shared_box_scene());
  handler.handle(request(1, INT64_MIN));
  handler.handle(request(1, -4));
  EXPECT_EQ(handler.newest_seq(1), -4);
  handler.handle(request(1, -5));
  EXPECT_EQ(handler.newest_seq(1), -4);
  EXPECT_EQ(handler.counters().stale, 1);
}

TEST(RequestHandler, LimitsNumberOfSessions) {
  RequestHandler handler(shared_box_scene());
  for (std::int64_t id = 0; id < 1000; ++id) {
    EXPECT_FALSE(handler.handle(request(id, 1)).empty());
    EXPECT_LE(handler.counters().sessions, 64);
  }
  EXPECT_EQ(handler.counters().sessions, 64);
  EXPECT_EQ(handler.counters().sessions_evicted, 1000 - 64);
  EXPECT_EQ(handler.newest_seq(1000 - 65), std::nullopt);
  EXPECT_EQ(handler.newest_seq(1000 - 64), 1);
}

// A scene with a taller box at another index, and fewer bodies.
Scene taller_box_scene() {
  return scene_of(R"(
    [world]
    gravity = 10.0
    [water]
    density = 1000.0
    [[body]]
    id = 2
    shape = { type = "box", size = [1, 1, 1], segments = [2, 2, 2] }
    [[body]]
    id = 1
    shape = { type = "box", size = [1, 1, 2], segments = [2, 2, 2] }
  )");
}

TEST(RequestHandler, UsesNewSceneWithinSession) {
  const Scene taller = taller_box_scene();
  RequestHandler handler(shared_box_scene());
  for (const std::int64_t session_id : {1, 2}) handler.handle(request(session_id, 5));
  handler.set_scene(taller);
  EXPECT_EQ(&handler.scene(), &taller);
  const WrenchResponse response = decoded<WrenchResponse>(handler.handle(request(1, 6)));
  EXPECT_EQ(response.id.seq, 6);
  EXPECT_NEAR(response.bodies[0].submerged_volume, 1.0, 1e-13) << "at the pose of the last response";
  EXPECT_EQ(handler.newest_seq(2), 5);
  const WrenchResponse gone = decoded<WrenchResponse>(handler.handle(
      request_bytes({.session_id = 2, .seq = 6}, {upright(kFastBox, 0.0), upright(kOffsetBox, 0.0)})));
  EXPECT_EQ(gone.bodies[0].status, BodyStatus::kUnknownBody);
  EXPECT_EQ(gone.bodies[1].status, BodyStatus::kOk);
  EXPECT_EQ(handler.counters().computed, 4);
  EXPECT_EQ(handler.counters().sessions, 2);
  EXPECT_EQ(handler.counters().bodies_unchanged, 1) << "only the second session's first request";
}

TEST(RequestHandler, ReturnsStoredBytesForRetryAfterSceneChange) {
  const ByteVector retried =
      request_bytes({.session_id = 1, .seq = 5}, {upright(kBox, 0.1), upright(kHydrostaticBox, 0.1)});
  auto before = std::make_unique<Scene>(box_scene());
  const Scene taller = taller_box_scene();
  RequestHandler handler(*before);
  const ByteVector first = copy_of(handler.handle(retried));
  const ByteVector hydrostatics = copy_of(handler.last_hydrostatics());
  ASSERT_FALSE(hydrostatics.empty());
  handler.set_scene(taller);
  before.reset();
  EXPECT_EQ(copy_of(handler.handle(retried)), first);
  EXPECT_EQ(copy_of(handler.last_hydrostatics()), hydrostatics);
  EXPECT_EQ(handler.counters().retries, 1);
  EXPECT_FALSE(handler.handle(request(1, 6)).empty());
  EXPECT_TRUE(handler.last_hydrostatics().empty());
}

TEST(RequestHandler, ClearsCachedResultsOnSceneChange) {
  const Scene other = box_scene();
  const auto make_request = [](std::int64_t seq) {
    return request_bytes({.session_id = 1, .seq = seq}, {upright(kBox, 0.1), upright(kHydrostaticBox, 0.1)});
  };
  RequestHandler handler(shared_box_scene());
  handler.handle(make_request(1));
  handler.set_scene(other);
  handler.handle(make_request(2));
  EXPECT_EQ(handler.counters().bodies_unchanged, 0);
  EXPECT_EQ(handler.counters().hydrostatics, 2);
  handler.handle(make_request(3));
  EXPECT_EQ(handler.counters().bodies_unchanged, 2);
  EXPECT_EQ(handler.counters().hydrostatics, 2);
}

TEST(RequestHandler, CountsSupersededAndStaleRequests) {
  RequestHandler handler(shared_box_scene());
  handler.record_superseded();
  handler.record_superseded();
  handler.record_stale();
  EXPECT_EQ(handler.counters().requests, 3);
  EXPECT_EQ(handler.counters().superseded, 2);
  EXPECT_EQ(handler.counters().stale, 1);
  EXPECT_EQ(handler.counters().computed, 0);
}

TEST(MalformedMessages, HasManyDistinctMessages) {
  const auto list = malformed_messages();
  EXPECT_GE(list.size(), 40U);
  std::set<std::string> names;
  std::set<std::string> contents;
  for (const MalformedMessage& message : list) {
    EXPECT_TRUE(names.insert(message.name).second) << message.name;
    EXPECT_TRUE(contents.emplace(message.bytes.begin(), message.bytes.end()).second) << message.name;
  }
}

std::int64_t rejections(const ServiceCounters& counters, DecodeError error) {
  switch (error) {
    case DecodeError::kTruncated:
      return counters.rejected_truncated;
    case DecodeError::kFingerprint:
      return counters.rejected_fingerprint;
    case DecodeError::kCount:
      return counters.rejected_count;
    case DecodeError::kLength:
      return counters.rejected_length;
  }
  return -1;
}

TEST(RequestHandler, RejectsAndCountsMalformedMessages) {
  RequestHandler handler(shared_box_scene());
  std::int64_t rejected = 0;
  for (const MalformedMessage& message : malformed_messages()) {
    SCOPED_TRACE(message.name);
    const std::int64_t before = rejections(handler.counters(), message.error);
    EXPECT_TRUE(handler.handle(message.bytes).empty());
    EXPECT_EQ(rejections(handler.counters(), message.error), before + 1);
    EXPECT_EQ(handler.counters().rejected(), ++rejected);

    const WrenchResponse response = decoded<WrenchResponse>(handler.handle(request(1, rejected)));
    ASSERT_EQ(response.bodies.size(), 1U);
    EXPECT_NEAR(response.bodies[0].submerged_volume, 0.5, 1e-13);
    EXPECT_EQ(handler.counters().computed, rejected);
    EXPECT_EQ(handler.counters().requests, 2 * rejected);
  }
  EXPECT_EQ(handler.counters().sessions, 1);
}

TEST(RequestHandler, KeepsStoredResponseAfterMalformedMessages) {
  RequestHandler handler(shared_box_scene());
  const ByteVector first = copy_of(handler.handle(request(77, 5)));
  for (const MalformedMessage& message : malformed_messages()) {
    const AllocationCount allocations;
    handler.handle(message.bytes);
    EXPECT_EQ(allocations.count(), 0) << message.name;
    ASSERT_EQ(copy_of(handler.handle(request(77, 5))), first) << message.name;
  }
  EXPECT_EQ(handler.counters().computed, 1);
}

TEST(RequestHandler, DoesNotAllocateAfterWarmUp) {
  // Two sessions alternate, with small and large messages and bodies of several methods and statuses.
  std::vector<BodyState> many(300, upright(kBox, 0.1));
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].body_id =
        std::array{kBox, kOffsetBox, kFastBox, kHierarchicalBox, kHydrostaticBox, kNoBody}[i % 6];
    many[i].angular_velocity = {0.1, 0.2, 0.3};
  }
  const auto make_request = [&](std::int64_t session_id, std::int64_t seq, bool large) {
    return request_bytes({.session_id = session_id, .seq = seq},
                         large ? many : std::vector<BodyState>{upright(kBox, 0.2)}, 1e-3);
  };
  std::vector<ByteVector> requests;
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    for (const std::int64_t session_id : {1, 2}) {
      requests.push_back(make_request(session_id, seq, seq % 2 == 0));
      requests.push_back(requests.back());
    }
  }
  RequestHandler handler(shared_box_scene());
  for (const std::int64_t session_id : {1, 2}) handler.handle(make_request(session_id, -1, true));

  const AllocationCount allocations;
  for (const ByteVector& bytes : requests) {
    ASSERT_FALSE(handler.handle(bytes).empty());
    ASSERT_EQ(handler.last_hydrostatics().empty(), bytes.size() < 1000);
  }
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(handler.counters().computed, 2 + 20);
  EXPECT_EQ(handler.counters().retries, 20);

  const Scene other = box_scene();
  handler.set_scene(other);
  const AllocationCount after_scene_change;
  for (const ByteVector& bytes : requests) handler.handle(bytes);
  EXPECT_EQ(after_scene_change.count(), 0);
}

TEST(RequestHandler, DoesNotAllocateForManyBodiesAfterWarmUp) {
  constexpr int kBodies = 5'000;
  std::string text;
  for (int id = 1; id <= kBodies; ++id) {
    text += "[[body]]\nid = " + std::to_string(id) + "\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  }
  const Scene crates = scene_of(text);
  std::vector<ByteVector> requests;
  for (std::int64_t seq = 0; seq < 6; ++seq) {
    std::vector<BodyState> states;
    for (int id = 1; id <= kBodies; ++id) {
      states.push_back(upright(id, 2.0 * std::sin(0.7 * id + 0.1 * static_cast<double>(seq))));
    }
    requests.push_back(request_bytes({.session_id = 1, .seq = seq}, states));
  }
  RequestHandler handler(crates, {.threads = 2});
  handler.handle(requests.front());
  const AllocationCount allocations;
  for (const ByteVector& bytes : requests) handler.handle(bytes);
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(handler.counters().computed, 6);
  EXPECT_GT(handler.counters().bodies_crossing, 1'000);
}

// A simple model of the session contract in request_handler.h: a list of whole requests, most recently used
// first.
class SessionModel {
 public:
  explicit SessionModel(std::size_t max_sessions) : max_sessions_(max_sessions) {}

  void handle(std::int64_t id, std::int64_t seq, const ByteVector& bytes) {
    const auto known =
        std::find_if(sessions_.begin(), sessions_.end(), [&](const StoredSession& s) { return s.id == id; });
    StoredSession next{.id = id, .newest = seq, .last = seq, .bytes = bytes};
    if (known != sessions_.end()) {
      if (known->bytes == bytes) {
        ++expected.retries;
        sessions_.splice(sessions_.begin(), sessions_, known);
        return;
      }
      if (seq == known->last) ++expected.conflicting_retries;
      if (seq < known->newest) ++expected.stale;
      next.newest = std::max(seq, known->newest);
      sessions_.erase(known);
    } else if (sessions_.size() == max_sessions_) {
      sessions_.pop_back();
      ++expected.sessions_evicted;
    }
    ++expected.computed;
    sessions_.push_front(next);
    expected.sessions = static_cast<std::int64_t>(sessions_.size());
  }

  std::optional<std::int64_t> newest_seq(std::int64_t id) const {
    const auto known = std::ranges::find(sessions_, id, &StoredSession::id);
    return known == sessions_.end() ? std::nullopt : std::optional(known->newest);
  }

  ServiceCounters expected;

 private:
  struct StoredSession {
    std::int64_t id, newest, last;
    ByteVector bytes;
  };
  std::size_t max_sessions_;
  std::list<StoredSession> sessions_;
};

RC_GTEST_PROP(RequestHandler, ManagesSessionsLikeModel, ()) {
  const std::size_t max_sessions = *rc::gen::inRange<std::size_t>(1, 5);
  RequestHandler handler(shared_box_scene(), {.max_sessions = max_sessions});
  SessionModel model(max_sessions);
  std::map<ByteVector, ByteVector> responses;
  const auto num_requests = *rc::gen::inRange(0, 200);
  for (int i = 0; i < num_requests; ++i) {
    const auto id = *rc::gen::inRange<std::int64_t>(0, 7);
    const auto seq = *rc::gen::inRange<std::int64_t>(0, 3);
    const double height = *rc::gen::element(0.0, 0.25);
    const ByteVector bytes = request(id, seq, height);
    model.handle(id, seq, bytes);
    const ByteVector responded = copy_of(handler.handle(bytes));
    const WrenchResponse response = decoded<WrenchResponse>(responded);
    RC_ASSERT(response.id.session_id == id);
    RC_ASSERT(response.id.seq == seq);
    RC_ASSERT(response.bodies.size() == std::size_t{1});
    RC_ASSERT(std::abs(response.bodies[0].submerged_volume - (0.5 - height)) < 1e-13);
    RC_ASSERT(responses.emplace(bytes, responded).first->second == responded);  // whatever came between
    for (std::int64_t each = 0; each < 7; ++each) {
      RC_ASSERT(handler.newest_seq(each) == model.newest_seq(each));
      RC_ASSERT(handler.is_retry(each, bytes) == (each == id));
    }
  }
  const ServiceCounters& counters = handler.counters();
  RC_ASSERT(counters.requests == num_requests);
  RC_ASSERT(counters.computed == model.expected.computed);
  RC_ASSERT(counters.retries == model.expected.retries);
  RC_ASSERT(counters.conflicting_retries == model.expected.conflicting_retries);
  RC_ASSERT(counters.stale == model.expected.stale);
  RC_ASSERT(counters.sessions == model.expected.sessions);
  RC_ASSERT(counters.sessions_evicted == model.expected.sessions_evicted);
}

}  // namespace
}  // namespace buoyancy
