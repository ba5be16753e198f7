#include "view/live/request_tracker.h"

#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy {
namespace {

constexpr std::int64_t kMillisecond = 1'000;  // us

QuestionKey key(std::int64_t session_id, std::int64_t seq) {
  return {0, session_id, seq};
}

TEST(QuestionLedger, TellsTheTimeBetweenAQuestionAndItsAnswer) {
  QuestionLedger ledger;
  EXPECT_TRUE(ledger.hear_question(key(1, 5), 100 * kMillisecond, 0.1));
  EXPECT_TRUE(ledger.hear_question(key(2, 5), 101 * kMillisecond, 0.101));
  EXPECT_DOUBLE_EQ(ledger.hear_answer(key(2, 5), 104 * kMillisecond).value(), 0.003);
  EXPECT_DOUBLE_EQ(ledger.hear_answer(key(1, 5), 107 * kMillisecond).value(), 0.007);
  EXPECT_EQ(ledger.counts().questions, 2);
  EXPECT_EQ(ledger.counts().answers, 2);
  EXPECT_EQ(ledger.counts().sessions, 2);
}

TEST(QuestionLedger, CountsARepeatOnceMoreAndMeasuresFromTheFirst) {
  QuestionLedger ledger;
  ledger.hear_question(key(1, 0), 0, 0.0);
  EXPECT_FALSE(ledger.hear_question(key(1, 0), 100 * kMillisecond, 0.1));
  EXPECT_DOUBLE_EQ(ledger.hear_answer(key(1, 0), 101 * kMillisecond).value(), 0.101);
  EXPECT_EQ(ledger.hear_answer(key(1, 0), 102 * kMillisecond), std::nullopt);
  EXPECT_EQ(ledger.counts().questions, 1);
  EXPECT_EQ(ledger.counts().questions_repeated, 1);
  EXPECT_EQ(ledger.counts().answers, 1);
  EXPECT_EQ(ledger.counts().answers_repeated, 1);
}

TEST(QuestionLedger, MissesNoNumbersWhereTheyCountNothing) {
  QuestionLedger ledger;
  for (const std::int64_t utime : {5, 1'005, 2'005}) {
    EXPECT_FALSE(ledger.remembers(key(1, utime)));
    EXPECT_TRUE(ledger.hear_question(key(1, utime), utime, 0.0, QuestionLedger::Seq::kAnyNumber));
    EXPECT_TRUE(ledger.remembers(key(1, utime)));
  }
  EXPECT_EQ(ledger.counts().questions_missed, 0);
  EXPECT_EQ(ledger.counts().questions, 3);
}

TEST(QuestionLedger, GivesUpAQuestionThatNobodyAnswersAndCountsALateAnswerAsOneWithoutAQuestion) {
  QuestionLedger ledger;
  ledger.hear_question(key(1, 0), 0, 0.0);
  ledger.hear_question(key(1, 1), 0, 0.1);
  ASSERT_TRUE(ledger.hear_answer(key(1, 1), 0));
  ledger.give_up_old(QuestionLedger::kPatience);
  EXPECT_EQ(ledger.counts().unanswered, 0) << "its time is not over";
  ledger.give_up_old(QuestionLedger::kPatience + 0.2);
  EXPECT_EQ(ledger.counts().unanswered, 1);
  EXPECT_EQ(ledger.remembered(), 0U);
  EXPECT_EQ(ledger.hear_answer(key(1, 0), 1), std::nullopt);
  EXPECT_EQ(ledger.counts().answers_without_question, 1);
}

TEST(QuestionLedger, TakesAQuestionThatIsRepeatedAfterItWasGivenUpForARepeatAndPairsItsAnswer) {
  QuestionLedger ledger;
  ledger.hear_question(key(1, 7), 0, 0.0);
  ledger.give_up_old(10.0);
  EXPECT_FALSE(ledger.hear_question(key(1, 7), 10'000 * kMillisecond, 10.0));
  EXPECT_DOUBLE_EQ(ledger.hear_answer(key(1, 7), 10'001 * kMillisecond).value(), 0.001);
  EXPECT_EQ(ledger.counts().questions, 1);
  EXPECT_EQ(ledger.counts().questions_repeated, 1);
}

TEST(QuestionLedger, CountsNumbersLeftOutOfASessionAndNoNewBeginning) {
  QuestionLedger ledger;
  ledger.hear_question(key(1, 10), 0, 0.0);
  ledger.hear_question(key(1, 14), 0, 0.0);
  EXPECT_EQ(ledger.counts().questions_missed, 3);
  ledger.hear_question(key(1, 3), 0, 0.0);
  ledger.hear_question(key(1, 4), 0, 0.0);
  ledger.hear_question(key(2, 1000), 0, 0.0);
  ledger.hear_question(key(1, 4'000'000), 0, 0.0);
  EXPECT_EQ(ledger.counts().questions_missed, 3);
}

TEST(QuestionLedger, HoldsThatAClockWhichGoesBackMakesNoNegativeTime) {
  QuestionLedger ledger;
  ledger.hear_question(key(1, 0), 5 * kMillisecond, 0.0);
  EXPECT_EQ(ledger.hear_answer(key(1, 0), kMillisecond), 0.0);
}

TEST(QuestionLedger, RemembersNoMoreThanItMayAndCountsWhatItForgetsAsUnanswered) {
  QuestionLedger ledger;
  constexpr std::int64_t kMore = 1'000;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(QuestionLedger::kMostRemembered) + kMore; ++i) {
    ledger.hear_question(key(i, i), 0, 0.0);
  }
  EXPECT_EQ(ledger.remembered(), QuestionLedger::kMostRemembered);
  EXPECT_EQ(ledger.counts().unanswered, kMore);
}

RC_GTEST_PROP(QuestionLedger, KeepsItsBooksWhateverIsHeard, ()) {
  using Limits = std::numeric_limits<std::int64_t>;
  QuestionLedger ledger;
  std::int64_t heard_questions = 0;
  std::int64_t heard_answers = 0;
  double now = 0.0;
  const auto steps = *rc::gen::inRange(0, 300);
  for (int i = 0; i < steps; ++i) {
    const QuestionKey any =
        key(*rc::gen::element<std::int64_t>(0, 1, -1, Limits::max(), Limits::min()),
            *rc::gen::element<std::int64_t>(0, 1, 2, 3, 1'000, Limits::max(), Limits::min()));
    switch (*rc::gen::inRange(0, 3)) {
      case 0:
        ledger.hear_question(any, *rc::gen::inRange<std::int64_t>(0, 1'000), now);
        ++heard_questions;
        break;
      case 1:
        if (const auto latency = ledger.hear_answer(any, *rc::gen::inRange<std::int64_t>(0, 1'000))) {
          RC_ASSERT(*latency >= 0.0);
        }
        ++heard_answers;
        break;
      default:
        now += 0.5 * *rc::gen::inRange(0, 4);
        ledger.give_up_old(now);
    }
  }
  ledger.give_up_old(now + 2.0 * QuestionLedger::kPatience);
  const QuestionLedger::Counts& counts = ledger.counts();
  RC_ASSERT(ledger.remembered() == 0U);
  RC_ASSERT(counts.questions + counts.questions_repeated == heard_questions);
  RC_ASSERT(counts.answers + counts.answers_repeated + counts.answers_without_question == heard_answers);
  RC_ASSERT(counts.unanswered >= counts.questions - counts.answers);
  RC_ASSERT(counts.questions_missed >= 0);
}

}  // namespace
}  // namespace buoyancy
