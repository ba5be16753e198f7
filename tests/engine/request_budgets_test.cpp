// Requests in slices, and what they may cost.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "engine/request_handler.h"
#include "tests/engine/box_scene.h"
#include "tests/engine/reply.h"
#include "tests/support/allocation_count.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using Step = RequestHandler::Step;

constexpr Deadline kPassed{};  // of few bodies: a slice of one

// Bodies of every kind of output that there is in this water.
Scene mixed_scene(const std::string& water) {
  const bool has_waves = water.find("waves") != water.npos;
  const std::string hydrostatics = has_waves ? "" : ", \"hydrostatics\"";
  return scene_of(water + R"(
    [[body]]
    id = 1
    shape = { type = "box", segments = [2, 2, 2] }
    outputs = ["wrench")" +
                  hydrostatics + R"(]
    [[body]]
    id = 2
    shape = { type = "sphere", segments = 6 }
    [[body]]
    id = 3
    shape = { type = "box", segments = [2, 2, 2] }
    outputs = ["wrench", "loads"]
    [body.drag]
    linear = [20, 60, 60, 5, 5, 8]
    [[body]]
    id = 4
    shape = { type = "box", segments = [2, 2, 2] }
    outputs = ["wrench", "loads")" +
                  hydrostatics + R"(]
  )");
}

const std::string kStill = "[water]\ndensity = 1000\n";
const std::string kWaves = kStill + R"([water.waves]
type = "jonswap"
significant_wave_height = 0.5
peak_period = 4.0
)";

const Scene& shared_scene() {
  static const Scene scene = mixed_scene(kStill);
  return scene;
}

// Bodies 1 to 5, of which the last is unknown, some of them twice or at no valid pose.
ByteVector mixed_request(std::int64_t session_id, std::int64_t utime, std::size_t bodies) {
  std::mt19937 random(static_cast<unsigned>(utime));
  std::uniform_real_distribution<double> height(-0.7, 0.7);
  std::vector<BodyState> states;
  for (std::size_t i = 0; i < bodies; ++i) {
    states.push_back(upright(static_cast<std::int32_t>(1 + i % 5), height(random)));
    states.back().linear_velocity = {height(random), 0.1, 0.0};
    if (i % 11 == 7) states.back().position[0] = std::nan("");
  }
  return request_bytes({.utime = utime, .session_id = session_id, .seq = utime}, states);
}

Reply whole_reply(const Scene& scene, const ByteVector& request) {
  RequestHandler handler(scene, {.threads = 1});
  return reply_to(handler, request);
}

TEST(RequestBudgets, SlicesHaveTheBytesOfTheWholeRequest) {
  for (const std::string& water : {kStill, kWaves}) {
    const Scene scene = mixed_scene(water);
    const ByteVector sliced = mixed_request(1, 1'000'000, 60);
    const Reply whole = whole_reply(scene, sliced);
    ASSERT_FALSE(whole.loads.empty());
    for (const unsigned threads : {1U, 4U}) {
      RequestHandler handler(scene, {.threads = threads});
      ASSERT_EQ(handler.begin(sliced, kPassed), Step::kStarted);
      int slices = 1;
      for (; handler.in_progress() > 0; ++slices) {
        // Another session has the same bodies elsewhere, at another time.
        const ByteVector other = mixed_request(2, 5'000'000 + slices, 7);
        handler.handle(other);
        ASSERT_EQ(reply_of(handler), whole_reply(scene, other));
        handler.resume(kPassed);
      }
      EXPECT_EQ(reply_of(handler), whole);
      EXPECT_GT(slices, threads == 1 ? 30 : 5);
      EXPECT_EQ(handler.counters().requests, slices);
      EXPECT_EQ(handler.counters().computed, slices);
      EXPECT_EQ(handler.counters().requests_sliced, 1);
      handler.handle(sliced);
      EXPECT_EQ(reply_of(handler), whole);
      EXPECT_EQ(handler.counters().retries, 1);
    }
  }
}

TEST(RequestBudgets, RequestsInProgressTakeTurns) {
  const Scene scene = mixed_scene(kStill);
  RequestHandler handler(scene, {.threads = 1});
  std::vector<ByteVector> requests;
  for (std::int64_t session = 0; session < 3; ++session) {
    requests.push_back(mixed_request(session, 10 + session, 20 + 10 * static_cast<std::size_t>(session)));
    EXPECT_EQ(handler.begin(requests.back(), kPassed), Step::kStarted);
  }
  for (std::size_t finished = 0; finished < 3;) {
    const std::int64_t session = handler.next_session().id;
    if (handler.resume(kPassed) != Step::kAnswered) continue;
    EXPECT_EQ(static_cast<std::size_t>(session), finished++) << "the shortest first";
    EXPECT_EQ(reply_of(handler), whole_reply(scene, requests[static_cast<std::size_t>(session)]));
  }
}

TEST(RequestBudgets, CountsRetriesOfARequestInProgress) {
  RequestHandler handler(shared_scene(), {.threads = 1});
  const ByteVector request = mixed_request(1, 1, 20);
  EXPECT_EQ(handler.begin(request, kPassed), Step::kStarted);
  EXPECT_EQ(handler.begin(request, kPassed), Step::kStarted);
  EXPECT_EQ(handler.counters().retries, 1);
  EXPECT_EQ(handler.in_progress(), 1U);
  EXPECT_EQ(handler.begin(mixed_request(1, 2, 1), kPassed), Step::kBusy) << "another one of the session";
  EXPECT_FALSE(handler.has_room_for(1));
  EXPECT_TRUE(handler.has_room_for(2));
  EXPECT_EQ(handler.counters().requests, 2);
}

TEST(RequestBudgets, LimitsTheRequestsInProgress) {
  RequestHandler handler(shared_scene(), {.threads = 1});
  const auto limit = static_cast<std::int64_t>(RequestHandler::kMaxInProgress);
  for (std::int64_t session = 0; session < limit; ++session) {
    EXPECT_EQ(handler.begin(mixed_request(session, 1, 20), kPassed), Step::kStarted);
  }
  EXPECT_EQ(handler.begin(mixed_request(limit, 1, 20), kPassed), Step::kBusy);
  EXPECT_EQ(handler.begin(mixed_request(limit, 1, 1), kPassed), Step::kAnswered) << "one slice is enough";
  EXPECT_FALSE(handler.has_room_for(limit));
}

TEST(RequestBudgets, StartsAgainInANewScene) {
  const Scene before = mixed_scene(kStill);
  const Scene after = mixed_scene("[water]\ndensity = 1030\n");
  RequestHandler handler(before, {.threads = 1});
  const ByteVector request = mixed_request(1, 1, 30);
  EXPECT_EQ(handler.begin(request, kPassed), Step::kStarted);
  handler.resume(kPassed);
  handler.set_scene(after);
  while (handler.in_progress() > 0) handler.resume(kPassed);
  EXPECT_EQ(reply_of(handler), whole_reply(after, request));
}

// As on a machine on which looking at all bodies takes a whole slice.
TEST(RequestBudgets, ComputesInEverySliceAsLongAsItLooksAtBodies) {
  constexpr int kBodies = 10'000;
  std::vector<BodyState> states;
  for (int i = 0; i < kBodies; ++i) states.push_back(upright(1, 1e-5 * i));
  const ByteVector request = request_bytes({.utime = 1, .session_id = 1, .seq = 1}, states);
  RequestHandler handler(shared_box_scene(), {.threads = 1});
  int slices = 1;
  for (Step step = handler.begin(request, kPassed); step == Step::kStarted; ++slices) {
    step = handler.resume(kPassed);
  }
  EXPECT_LT(slices, kBodies / 4);
  EXPECT_EQ(reply_of(handler), whole_reply(shared_box_scene(), request));
}

TEST(RequestBudgets, RejectsMoreBodiesThanTheSceneHas) {
  RequestHandler handler(shared_box_scene(), {.threads = 1, .budgets = {.extra_bodies = 10}});
  const std::size_t most = shared_box_scene().bodies().size() + 10;
  const std::vector<BodyState> bodies(most + 1, upright(kBox, 0.0));
  EXPECT_TRUE(handler.handle(request_bytes({.session_id = 1, .seq = 1}, bodies)).empty());
  EXPECT_EQ(handler.counters().rejected_bodies, 1);
  EXPECT_EQ(handler.counters().rejected(), 1);
  EXPECT_EQ(handler.counters().sessions, 0) << "before any work";
  EXPECT_FALSE(
      handler.handle(request_bytes({.session_id = 1, .seq = 1}, {bodies.begin(), bodies.end() - 1})).empty());
}

TEST(RequestBudgets, RejectsARequestThatComputesTooLong) {
  RequestHandler handler(shared_scene(), {.threads = 1, .budgets = {.computing = {}}});
  const ByteVector request = mixed_request(1, 1, 20);
  EXPECT_EQ(handler.begin(request, kPassed), Step::kStarted);
  EXPECT_EQ(handler.resume(kPassed), Step::kRejected);
  EXPECT_EQ(handler.counters().rejected_work, 1);
  EXPECT_EQ(handler.in_progress(), 0U);
  EXPECT_EQ(handler.counters().retained_bytes, 0);
  EXPECT_EQ(handler.begin(request, kNoDeadline), Step::kAnswered);
}

// Messages of exactly the budget are sent; the first byte more leaves them out, each by its own size.
TEST(RequestBudgets, LeavesOutWhatNoReceiverAccepts) {
  const ByteVector request = mixed_request(1, 1, 60);
  const Reply whole = whole_reply(shared_scene(), request);
  const std::size_t hydrostatics = whole.hydrostatics.size();
  const std::size_t loads = whole.loads.size();
  ASSERT_NE(hydrostatics, loads);
  for (const std::size_t budget : {hydrostatics - 1, hydrostatics, loads - 1, loads}) {
    RequestHandler handler(shared_scene(), {.threads = 1, .budgets = {.message_bytes = budget}});
    const Reply reply = reply_to(handler, request);
    EXPECT_EQ(reply.response, whole.response);
    EXPECT_EQ(reply.hydrostatics, hydrostatics <= budget ? whole.hydrostatics : ByteVector()) << budget;
    EXPECT_EQ(reply.loads, loads <= budget ? whole.loads : ByteVector()) << budget;
    EXPECT_EQ(handler.counters().outputs_too_large, (hydrostatics > budget) + (loads > budget));
  }
}

TEST(RequestBudgets, HandlesWhatFillsItsMemoryExactly) {
  const ByteVector request = mixed_request(1, 1, 60);
  const Reply whole = whole_reply(shared_scene(), request);
  const std::size_t bytes =
      request.size() + whole.response.size() + whole.hydrostatics.size() + whole.loads.size();
  for (const std::size_t budget : {bytes - 1, bytes}) {
    RequestHandler handler(shared_scene(), {.threads = 1, .budgets = {.retained_bytes = budget}});
    EXPECT_EQ(handler.begin(request, kNoDeadline), budget == bytes ? Step::kAnswered : Step::kBusy);
  }
}

// The request is evaluated in parts of BodyEvaluator::kMaxStates: the second one has its own outputs.
TEST(RequestBudgets, PartsOfALargeRequestHaveTheRepliesOfASmallOne) {
  constexpr std::size_t kPeriod = 7;
  std::vector<BodyState> states;
  for (std::size_t i = 0; i < kPeriod; ++i) {
    states.push_back(upright(static_cast<std::int32_t>(1 + i % 5), 0.1 * static_cast<double>(i) - 0.4));
  }
  const Reply small = whole_reply(shared_scene(), request_bytes({.session_id = 1}, states));
  const auto wrenches = response_of(small).bodies;
  const auto hydrostatics = decoded<BodiesHydrostatics>(small.hydrostatics).bodies;
  const auto loads = decoded<BodiesLoads>(small.loads).bodies;
  constexpr std::size_t kMax = BodyEvaluator::kMaxStates;
  for (const std::size_t count : {kMax, kMax + 1, 2 * kMax + kPeriod}) {
    std::vector<BodyState> many;
    for (std::size_t i = 0; i < count; ++i) many.push_back(states[i % kPeriod]);
    const Reply large = whole_reply(shared_scene(), request_bytes({.session_id = 1}, many));
    const auto same = [](const auto& found, const auto& expected, const auto& field) {
      for (std::size_t i = 0; i < found.size(); ++i) {
        const auto& of = expected[i % expected.size()];
        if (found[i].body_id != of.body_id || field(found[i]) != field(of)) return false;
      }
      return true;
    };
    ASSERT_EQ(response_of(large).bodies.size(), count);
    EXPECT_TRUE(same(response_of(large).bodies, wrenches, [](const BodyWrench& b) { return b.torque; }));
    EXPECT_TRUE(same(decoded<BodiesHydrostatics>(large.hydrostatics).bodies, hydrostatics,
                     [](const BodyHydrostatics& b) { return b.submerged_volume; }));
    EXPECT_TRUE(same(decoded<BodiesLoads>(large.loads).bodies, loads,
                     [](const BodyLoads& b) { return b.buoyancy_force; }));
  }
}

TEST(RequestBudgets, RetainsRepliesOfTheSessionsUsedLast) {
  constexpr std::size_t kBudget = 100'000;
  RequestHandler handler(shared_scene(), {.threads = 1, .budgets = {.retained_bytes = kBudget}});
  std::int64_t largest = 0;
  for (std::int64_t session = 0; session < 20; ++session) {
    EXPECT_FALSE(handler.handle(mixed_request(session, 1, 50)).empty());
    largest = std::max(largest, handler.counters().retained_bytes);
  }
  EXPECT_LE(largest, static_cast<std::int64_t>(kBudget));
  EXPECT_GT(largest, static_cast<std::int64_t>(kBudget / 2));
  EXPECT_GT(handler.counters().replies_evicted, 10);
  handler.handle(mixed_request(19, 1, 50));
  EXPECT_EQ(handler.counters().retries, 1) << "of the newest";
  EXPECT_FALSE(handler.handle(mixed_request(0, 1, 50)).empty());
  EXPECT_EQ(handler.counters().retries, 1) << "of the oldest: computed again";
  EXPECT_EQ(handler.counters().conflicting_retries, 0);
  EXPECT_EQ(handler.begin(mixed_request(0, 2, 1'000), kNoDeadline), Step::kBusy) << "larger than all";
}

TEST(RequestBudgets, AFailedAllocationCostsThatRequestOnly) {
  for (const std::string& water : {kStill, kWaves}) {
    const Scene scene = mixed_scene(water);
    const ByteVector request = mixed_request(1, 1'000'000, 60);
    const ByteVector other = mixed_request(2, 2'000'000, 50);
    const Reply expected = whole_reply(scene, request);
    const Reply expected_of_other = whole_reply(scene, other);
    bool has_failed = true;
    std::int64_t n = 1;
    for (; has_failed; ++n) {
      RequestHandler handler(scene, {.threads = 1});
      handler.handle(other);
      Step step = Step::kStarted;
      {
        const FailingAllocation failing(n);
        step = handler.begin(request, kPassed);
        while (step == Step::kStarted) step = handler.resume(kPassed);
        has_failed = failing.has_failed();
      }
      ASSERT_EQ(step, has_failed ? Step::kRejected : Step::kAnswered) << n;
      ASSERT_EQ(handler.counters().rejected_memory, has_failed ? 1 : 0) << n;
      handler.handle(other);
      ASSERT_EQ(reply_of(handler), expected_of_other) << n;
      handler.handle(request);
      ASSERT_EQ(reply_of(handler), expected) << n;
    }
    EXPECT_GT(n, 4);
  }
}

TEST(RequestBudgets, AFailedAllocationOnAWorkerThreadCostsThatRequestOnly) {
  const Scene scene = mixed_scene(kWaves);
  const ByteVector request = mixed_request(1, 1'000'000, 400);
  const Reply expected = whole_reply(scene, request);
  bool has_failed = true;
  for (std::int64_t n = 1; has_failed; ++n) {
    RequestHandler handler(scene, {.threads = 2});
    Step step = Step::kStarted;
    {
      const FailingAllocation failing(n);
      step = handler.begin(request, kNoDeadline);
      has_failed = failing.has_failed();
    }
    ASSERT_EQ(step, has_failed ? Step::kRejected : Step::kAnswered) << n;
    handler.handle(request);
    ASSERT_EQ(reply_of(handler), expected) << n;
  }
}

}  // namespace
}  // namespace buoyancy
