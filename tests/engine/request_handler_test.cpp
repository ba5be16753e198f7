#include "engine/request_handler.h"

#include <algorithm>
#include <list>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/engine/box_scene.h"
#include "tests/engine/malformed_messages.h"
#include "tests/support/allocation_count.h"

namespace buoyancy {
namespace {

using ByteVector = std::vector<std::uint8_t>;

const Scene& scene() {
  static const Scene the_scene = box_scene();
  return the_scene;
}

ByteVector copied(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

Answer decoded(Bytes bytes) {
  Answer answer;
  EXPECT_FALSE(decode(bytes, answer).has_value());
  return answer;
}

ByteVector question(std::int64_t session_id, std::int64_t seq, double height = 0.0) {
  return question_bytes({.utime = 7, .session_id = session_id, .seq = seq}, {upright(kBox, height)});
}

std::int64_t bodies_computed(const Counters& counters) {
  std::int64_t sum = 0;
  for (const std::int64_t bodies : counters.bodies) sum += bodies;
  return sum;
}

TEST(Exchange, AnswersCarryTheKeyOfTheQuestion) {
  Exchange exchange(scene());
  const QuestionKey key{.utime = -5, .session_id = INT64_MIN, .seq = INT64_MAX};
  const Answer answer = decoded(exchange.answer(question_bytes(key, {upright(kBox, 0.0)})));
  EXPECT_EQ(answer.key.utime, key.utime);
  EXPECT_EQ(answer.key.session_id, key.session_id);
  EXPECT_EQ(answer.key.seq, key.seq);
  ASSERT_EQ(answer.bodies.size(), 1U);
  EXPECT_NEAR(answer.bodies[0].force[2], 0.5 * kWeight, answer.bodies[0].force_error_bound);
  EXPECT_EQ(exchange.counters().questions, 1);
  EXPECT_EQ(exchange.counters().answered, 1);
}

TEST(Exchange, AnswersBodiesInTheAskedOrderAndAsOftenAsAsked) {
  Exchange exchange(scene());
  const std::vector<BodyState> bodies{upright(kOffsetBox, 0.1), upright(kBox, -0.2), upright(kNoBody, 0.0),
                                      upright(kOffsetBox, 0.3), upright(kBox, -0.2), upright(kFastBox, 9.0)};
  const Answer answer = decoded(exchange.answer(question_bytes({.session_id = 1, .seq = 1}, bodies)));
  ASSERT_EQ(answer.bodies.size(), bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) EXPECT_EQ(answer.bodies[i].body_id, bodies[i].body_id);
  EXPECT_NEAR(answer.bodies[0].submerged_volume, 0.4, 1e-13);
  EXPECT_NEAR(answer.bodies[1].submerged_volume, 0.7, 1e-13);
  EXPECT_EQ(answer.bodies[2].status, BodyStatus::kUnknownBody);
  EXPECT_NEAR(answer.bodies[3].submerged_volume, 0.2, 1e-13);
  EXPECT_EQ(answer.bodies[4].submerged_volume, answer.bodies[1].submerged_volume);
  EXPECT_EQ(answer.bodies[5].submerged_volume, 0.0);
  EXPECT_EQ(bodies_computed(exchange.counters()), 6);
}

TEST(Exchange, AnswersAQuestionWithoutBodies) {
  Exchange exchange(scene());
  const Answer answer = decoded(exchange.answer(question_bytes({.session_id = 3, .seq = 9}, {})));
  EXPECT_EQ(answer.key.session_id, 3);
  EXPECT_EQ(answer.key.seq, 9);
  EXPECT_TRUE(answer.bodies.empty());
  EXPECT_EQ(exchange.counters().answered, 1);
}

TEST(Exchange, AnswersAThousandBodies) {
  Exchange exchange(scene());
  std::vector<BodyState> bodies(1000);
  for (int i = 0; i < 1000; ++i) bodies[static_cast<std::size_t>(i)] = upright(kBox, -0.5 + 1e-3 * i);
  const Answer answer = decoded(exchange.answer(question_bytes({.session_id = 1, .seq = 1}, bodies)));
  ASSERT_EQ(answer.bodies.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    ASSERT_NEAR(answer.bodies[i].submerged_volume, 1.0 - 1e-3 * static_cast<double>(i), 1e-13);
  }
}

TEST(Exchange, ABadBodyDoesNotSpoilItsNeighbours) {
  Exchange exchange(scene());
  std::vector<BodyState> bodies(3, upright(kBox, 0.0));
  bodies[1].position[2] = std::numeric_limits<double>::quiet_NaN();
  const Answer answer = decoded(exchange.answer(question_bytes({.session_id = 1, .seq = 1}, bodies)));
  ASSERT_EQ(answer.bodies.size(), 3U);
  EXPECT_EQ(answer.bodies[0].status, BodyStatus::kOk);
  EXPECT_EQ(answer.bodies[1].status, BodyStatus::kNonFinitePose);
  EXPECT_EQ(answer.bodies[2].status, BodyStatus::kOk);
  EXPECT_EQ(answer.bodies[2].force, answer.bodies[0].force);
}

TEST(Exchange, ABadLeadTimeIsEveryKnownBodysStatus) {
  Exchange exchange(scene());
  const std::vector<BodyState> bodies{upright(kBox, 0.0), upright(kNoBody, 0.0), upright(kOffsetBox, 0.0)};
  const Answer answer = decoded(exchange.answer(
      question_bytes({.session_id = 1, .seq = 1}, bodies, std::numeric_limits<double>::quiet_NaN())));
  ASSERT_EQ(answer.bodies.size(), 3U);
  EXPECT_EQ(answer.bodies[0].status, BodyStatus::kBadLeadTime);
  EXPECT_EQ(answer.bodies[1].status, BodyStatus::kUnknownBody);
  EXPECT_EQ(answer.bodies[2].status, BodyStatus::kBadLeadTime);
}

TEST(Exchange, ARepeatGetsTheSameBytesWithoutComputing) {
  Exchange exchange(scene());
  const ByteVector first = copied(exchange.answer(question(1, 1)));
  const Counters before = exchange.counters();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(copied(exchange.answer(question(1, 1))), first);
  const Counters& after = exchange.counters();
  EXPECT_EQ(after.questions, before.questions + 3);
  EXPECT_EQ(after.repeated, 3);
  EXPECT_EQ(after.answered, before.answered);
  EXPECT_EQ(after.bodies, before.bodies);
  EXPECT_EQ(after.bodies_crossing, before.bodies_crossing);
}

TEST(Exchange, ARepeatOfAQuestionWithoutBodiesIsARepeat) {
  Exchange exchange(scene());
  const ByteVector empty = question_bytes({.session_id = 1, .seq = 1}, {});
  const ByteVector first = copied(exchange.answer(empty));
  EXPECT_EQ(copied(exchange.answer(empty)), first);
  EXPECT_EQ(exchange.counters().repeated, 1);
}

TEST(Exchange, TheSameStepWithOtherBytesIsComputedAnew) {
  Exchange exchange(scene());
  exchange.answer(question(1, 1, 0.0));
  const Answer changed = decoded(exchange.answer(question(1, 1, 0.25)));
  EXPECT_NEAR(changed.bodies[0].submerged_volume, 0.25, 1e-13);
  EXPECT_EQ(exchange.counters().changed_repeats, 1);
  EXPECT_EQ(exchange.counters().answered, 2);
  EXPECT_EQ(exchange.counters().repeated, 0);
  EXPECT_EQ(exchange.counters().stale, 0);
  // What is repeated from now on is the changed one.
  EXPECT_NEAR(decoded(exchange.answer(question(1, 1, 0.25))).bodies[0].submerged_volume, 0.25, 1e-13);
  EXPECT_EQ(exchange.counters().repeated, 1);
}

TEST(Exchange, AnswersAStaleStepAndCountsIt) {
  Exchange exchange(scene());
  const ByteVector first = copied(exchange.answer(question(1, 1)));
  exchange.answer(question(1, 2));
  EXPECT_EQ(copied(exchange.answer(question(1, 1))), first);
  EXPECT_EQ(exchange.counters().stale, 1);
  EXPECT_EQ(exchange.counters().answered, 3);
  EXPECT_EQ(exchange.newest_seq(1), 2);
}

TEST(Exchange, ANewSessionStartsAfresh) {
  Exchange exchange(scene());
  exchange.answer(question(1, 1000));
  EXPECT_EQ(exchange.newest_seq(1), 1000);
  EXPECT_EQ(exchange.newest_seq(2), std::nullopt);
  EXPECT_FALSE(exchange.answer(question(2, 0)).empty());
  EXPECT_EQ(exchange.newest_seq(2), 0);
  EXPECT_EQ(exchange.newest_seq(1), 1000);
  EXPECT_EQ(exchange.counters().stale, 0);
  EXPECT_EQ(exchange.counters().sessions, 2);
}

TEST(Exchange, SequenceNumbersMayBeNegative) {
  Exchange exchange(scene());
  exchange.answer(question(1, INT64_MIN));
  exchange.answer(question(1, -4));
  EXPECT_EQ(exchange.newest_seq(1), -4);
  exchange.answer(question(1, -5));
  EXPECT_EQ(exchange.newest_seq(1), -4);
  EXPECT_EQ(exchange.counters().stale, 1);
}

TEST(Exchange, ForgetsTheLeastRecentlyUsedSession) {
  Exchange exchange(scene(), {.max_sessions = 2});
  exchange.answer(question(1, 1));
  exchange.answer(question(2, 1));
  exchange.answer(question(1, 1));  // a repeat is a use
  exchange.answer(question(3, 1));
  EXPECT_EQ(exchange.newest_seq(1), 1);
  EXPECT_EQ(exchange.newest_seq(2), std::nullopt);
  EXPECT_EQ(exchange.newest_seq(3), 1);
  EXPECT_EQ(exchange.counters().sessions, 2);
  EXPECT_EQ(exchange.counters().sessions_forgotten, 1);
}

TEST(Exchange, AForgottenSessionIsAnsweredAsBeforeByComputing) {
  Exchange exchange(scene(), {.max_sessions = 1});
  const ByteVector first = copied(exchange.answer(question(1, 5)));
  exchange.answer(question(2, 9));
  EXPECT_EQ(copied(exchange.answer(question(1, 5))), first);
  EXPECT_EQ(exchange.counters().answered, 3);
  EXPECT_EQ(exchange.counters().repeated, 0);
  EXPECT_EQ(exchange.counters().sessions, 1);
  EXPECT_EQ(exchange.counters().sessions_forgotten, 2);
}

TEST(Exchange, KeepsAtMostSoManySessions) {
  Exchange exchange(scene());
  for (std::int64_t id = 0; id < 1000; ++id) {
    EXPECT_FALSE(exchange.answer(question(id, 1)).empty());
    EXPECT_LE(exchange.counters().sessions, 64);
  }
  EXPECT_EQ(exchange.counters().sessions, 64);
  EXPECT_EQ(exchange.counters().sessions_forgotten, 1000 - 64);
  EXPECT_EQ(exchange.newest_seq(1000 - 65), std::nullopt);
  EXPECT_EQ(exchange.newest_seq(1000 - 64), 1);
}

// A box of another height, its id in another place of the scene, and one body less.
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

TEST(Exchange, AnswersNewQuestionsFromAnotherSceneWithinTheSameSession) {
  const Scene taller = taller_box_scene();
  Exchange exchange(scene());
  for (const std::int64_t session_id : {1, 2}) exchange.answer(question(session_id, 5));
  exchange.use(taller);
  EXPECT_EQ(&exchange.scene(), &taller);
  const Answer answer = decoded(exchange.answer(question(1, 6)));
  EXPECT_EQ(answer.key.seq, 6);
  EXPECT_NEAR(answer.bodies[0].submerged_volume, 1.0, 1e-13) << "at the pose of the last answer";
  EXPECT_EQ(exchange.newest_seq(2), 5);
  const Answer gone = decoded(exchange.answer(
      question_bytes({.session_id = 2, .seq = 6}, {upright(kFastBox, 0.0), upright(kOffsetBox, 0.0)})));
  EXPECT_EQ(gone.bodies[0].status, BodyStatus::kUnknownBody);
  EXPECT_EQ(gone.bodies[1].status, BodyStatus::kOk);
  EXPECT_EQ(exchange.counters().answered, 4);
  EXPECT_EQ(exchange.counters().sessions, 2);
  EXPECT_EQ(exchange.counters().bodies_unchanged, 1) << "of the second session's first question alone";
}

TEST(Exchange, GivesARepeatTheBytesThatTheSceneBeforeAnsweredItWith) {
  const ByteVector asked =
      question_bytes({.session_id = 1, .seq = 5}, {upright(kBox, 0.1), upright(kHydrostaticBox, 0.1)});
  auto before = std::make_unique<Scene>(box_scene());
  const Scene taller = taller_box_scene();
  Exchange exchange(*before);
  const ByteVector first = copied(exchange.answer(asked));
  const ByteVector hydrostatics = copied(exchange.hydrostatics());
  ASSERT_FALSE(hydrostatics.empty());
  exchange.use(taller);
  before.reset();
  EXPECT_EQ(copied(exchange.answer(asked)), first);
  EXPECT_EQ(copied(exchange.hydrostatics()), hydrostatics);
  EXPECT_EQ(exchange.counters().repeated, 1);
  EXPECT_FALSE(exchange.answer(question(1, 6)).empty());
  EXPECT_TRUE(exchange.hydrostatics().empty());
}

TEST(Exchange, RemembersNothingOfTheBodiesOfTheSceneBefore) {
  const Scene other = box_scene();
  const auto asked = [](std::int64_t seq) {
    return question_bytes({.session_id = 1, .seq = seq}, {upright(kBox, 0.1), upright(kHydrostaticBox, 0.1)});
  };
  Exchange exchange(scene());
  exchange.answer(asked(1));
  exchange.use(other);
  exchange.answer(asked(2));
  EXPECT_EQ(exchange.counters().bodies_unchanged, 0);
  EXPECT_EQ(exchange.counters().hydrostatics, 2);
  exchange.answer(asked(3));
  EXPECT_EQ(exchange.counters().bodies_unchanged, 2);
  EXPECT_EQ(exchange.counters().hydrostatics, 2);
}

TEST(Exchange, CountsWhatTheModeLatestPassesOver) {
  Exchange exchange(scene());
  exchange.count_overtaken();
  exchange.count_overtaken();
  exchange.count_stale();
  EXPECT_EQ(exchange.counters().questions, 3);
  EXPECT_EQ(exchange.counters().overtaken, 2);
  EXPECT_EQ(exchange.counters().stale, 1);
  EXPECT_EQ(exchange.counters().answered, 0);
}

TEST(MalformedMessages, AreManyAndDifferent) {
  const auto list = malformed_messages();
  EXPECT_GE(list.size(), 40U);
  std::set<std::string> names;
  std::set<std::string> contents;
  for (const MalformedMessage& message : list) {
    EXPECT_TRUE(names.insert(message.name).second) << message.name;
    EXPECT_TRUE(contents.emplace(message.bytes.begin(), message.bytes.end()).second) << message.name;
  }
}

std::int64_t counted(const Counters& counters, Rejection cause) {
  switch (cause) {
    case Rejection::kTruncated:
      return counters.rejected_truncated;
    case Rejection::kFingerprint:
      return counters.rejected_fingerprint;
    case Rejection::kCount:
      return counters.rejected_count;
    case Rejection::kLength:
      return counters.rejected_length;
  }
  return -1;
}

TEST(MalformedMessages, AreEachRejectedAndCountedByCauseWithQuestionsInBetweenAnswered) {
  Exchange exchange(scene());
  std::int64_t rejected = 0;
  for (const MalformedMessage& message : malformed_messages()) {
    SCOPED_TRACE(message.name);
    const std::int64_t before = counted(exchange.counters(), message.cause);
    EXPECT_TRUE(exchange.answer(message.bytes).empty());
    EXPECT_EQ(counted(exchange.counters(), message.cause), before + 1);
    EXPECT_EQ(exchange.counters().rejected(), ++rejected);

    const Answer answer = decoded(exchange.answer(question(1, rejected)));
    ASSERT_EQ(answer.bodies.size(), 1U);
    EXPECT_NEAR(answer.bodies[0].submerged_volume, 0.5, 1e-13);
    EXPECT_EQ(exchange.counters().answered, rejected);
    EXPECT_EQ(exchange.counters().questions, 2 * rejected);
  }
  EXPECT_EQ(exchange.counters().sessions, 1);
}

TEST(MalformedMessages, LeaveTheLastAnswerRepeatable) {
  Exchange exchange(scene());
  const ByteVector first = copied(exchange.answer(question(77, 5)));
  for (const MalformedMessage& message : malformed_messages()) {
    exchange.answer(message.bytes);
    ASSERT_EQ(copied(exchange.answer(question(77, 5))), first) << message.name;
  }
  EXPECT_EQ(exchange.counters().answered, 1);
}

TEST(MalformedMessages, TakeNothingFromTheHeap) {
  const auto list = malformed_messages();
  Exchange exchange(scene());
  const AllocationCount allocations;
  for (const MalformedMessage& message : list) exchange.answer(message.bytes);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(Exchange, TakesNothingFromTheHeapAfterWarmUp) {
  // Two sessions that take turns, with small and large messages and bodies of every method and status.
  std::vector<BodyState> many(300, upright(kBox, 0.1));
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].body_id =
        std::array{kBox, kOffsetBox, kFastBox, kHierarchicalBox, kHydrostaticBox, kNoBody}[i % 6];
    many[i].angular_velocity = {0.1, 0.2, 0.3};
  }
  const auto asked = [&](std::int64_t session_id, std::int64_t seq, bool large) {
    return question_bytes({.session_id = session_id, .seq = seq},
                          large ? many : std::vector<BodyState>{upright(kBox, 0.2)}, 1e-3);
  };
  std::vector<ByteVector> questions;
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    for (const std::int64_t session_id : {1, 2}) {
      questions.push_back(asked(session_id, seq, seq % 2 == 0));
      questions.push_back(questions.back());
    }
  }
  Exchange exchange(scene());
  for (const std::int64_t session_id : {1, 2}) exchange.answer(asked(session_id, -1, true));

  const AllocationCount allocations;
  for (const ByteVector& bytes : questions) {
    ASSERT_FALSE(exchange.answer(bytes).empty());
    ASSERT_EQ(exchange.hydrostatics().empty(), bytes.size() < 1000);
  }
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(exchange.counters().answered, 2 + 20);
  EXPECT_EQ(exchange.counters().repeated, 20);

  const Scene other = box_scene();
  exchange.use(other);
  const AllocationCount after_another_scene;
  for (const ByteVector& bytes : questions) exchange.answer(bytes);
  EXPECT_EQ(after_another_scene.count(), 0);
}

// What the header says of sessions, as plainly as possible: whole questions kept in a list, latest used
// first.
class SessionModel {
 public:
  explicit SessionModel(std::size_t bound) : bound_(bound) {}

  void ask(std::int64_t id, std::int64_t seq, const ByteVector& bytes) {
    const auto known =
        std::find_if(sessions_.begin(), sessions_.end(), [&](const Kept& s) { return s.id == id; });
    Kept next{.id = id, .newest = seq, .last = seq, .bytes = bytes};
    if (known != sessions_.end()) {
      if (known->bytes == bytes) {
        ++expected.repeated;
        sessions_.splice(sessions_.begin(), sessions_, known);
        return;
      }
      if (seq == known->last) ++expected.changed_repeats;
      if (seq < known->newest) ++expected.stale;
      next.newest = std::max(seq, known->newest);
      sessions_.erase(known);
    } else if (sessions_.size() == bound_) {
      sessions_.pop_back();
      ++expected.sessions_forgotten;
    }
    ++expected.answered;
    sessions_.push_front(next);
    expected.sessions = static_cast<std::int64_t>(sessions_.size());
  }

  Counters expected;

 private:
  struct Kept {
    std::int64_t id, newest, last;
    ByteVector bytes;
  };
  std::size_t bound_;
  std::list<Kept> sessions_;
};

RC_GTEST_PROP(Exchange, KeepsSessionsAsTheModelDoes, ()) {
  const std::size_t bound = *rc::gen::inRange<std::size_t>(1, 5);
  Exchange exchange(scene(), {.max_sessions = bound});
  SessionModel model(bound);
  const auto asks = *rc::gen::inRange(0, 200);
  for (int i = 0; i < asks; ++i) {
    const auto id = *rc::gen::inRange<std::int64_t>(0, 7);
    const auto seq = *rc::gen::inRange<std::int64_t>(0, 3);
    const double height = *rc::gen::element(0.0, 0.25);
    const ByteVector bytes = question(id, seq, height);
    model.ask(id, seq, bytes);
    const Answer answer = decoded(exchange.answer(bytes));
    RC_ASSERT(answer.key.session_id == id);
    RC_ASSERT(answer.key.seq == seq);
    RC_ASSERT(answer.bodies.size() == std::size_t{1});
    RC_ASSERT(std::abs(answer.bodies[0].submerged_volume - (0.5 - height)) < 1e-13);
  }
  const Counters& counters = exchange.counters();
  RC_ASSERT(counters.questions == asks);
  RC_ASSERT(counters.answered == model.expected.answered);
  RC_ASSERT(counters.repeated == model.expected.repeated);
  RC_ASSERT(counters.changed_repeats == model.expected.changed_repeats);
  RC_ASSERT(counters.stale == model.expected.stale);
  RC_ASSERT(counters.sessions == model.expected.sessions);
  RC_ASSERT(counters.sessions_forgotten == model.expected.sessions_forgotten);
}

}  // namespace
}  // namespace buoyancy
