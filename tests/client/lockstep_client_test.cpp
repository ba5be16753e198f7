// What the askers take for an answer and what not, against a peer that the test plays itself, over UDP
// multicast in a network namespace of each test's own.
#include "client/lockstep_client.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/client/fake_service.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

Question question_number(std::int64_t seq) {
  Question question;
  question.key = {1000 * seq, 77, seq};
  question.bodies.resize(2);
  question.bodies[0].body_id = 5;
  question.bodies[1].body_id = 6;
  return question;
}

AnswerLink open_link() {
  return value_or_die(AnswerLink::open({}));
}

const Patience kPatient{0.5, std::llround(2.0 * kWaitTimeout)};

TEST(LockstepAsker, TakesOnlyTheAnswerToItsOwnQuestion) {
  const Peer peer([](const Question& question) {
    Answer other_session = answer_to(question, 1.0);
    other_session.key.session_id += 1;
    Answer earlier = answer_to(question, 2.0);
    earlier.key.seq -= 1;
    Answer later = answer_to(question, 3.0);
    later.key.seq += 1;
    std::vector<std::uint8_t> cut = bytes_of(answer_to(question, 4.0));
    cut.pop_back();
    return Replies{bytes_of(other_session), bytes_of(earlier), bytes_of(later), cut,
                   bytes_of(answer_to(question, 9.0))};
  });
  LockstepAsker asker(open_link(), kPatient);
  for (std::int64_t seq = 0; seq < 20; ++seq) {
    const Expected<const Answer*> answer = asker.ask(question_number(seq));
    ASSERT_TRUE(answer) << answer.error().message();
    EXPECT_EQ((*answer)->key.seq, seq);
    EXPECT_EQ((*answer)->bodies[1].force[2], 9.0);
  }
  EXPECT_EQ(asker.statistics().questions, 20);
  EXPECT_EQ(asker.statistics().round_trip.count(), 20);
}

TEST(LockstepAsker, AsksAgainWithTheSameBytesUntilAnswered) {
  std::vector<std::int64_t> asked;
  const Peer peer([&](const Question& question) {
    asked.push_back(question.key.seq);
    if (asked.size() < 4) return Replies{};
    return Replies{bytes_of(answer_to(question, 9.0))};
  });
  LockstepAsker asker(open_link(), {0.1, 1000});
  ASSERT_TRUE(asker.ask(question_number(3)));
  EXPECT_GE(asker.statistics().retries, 3);
  EXPECT_GE(peer.questions(), 4);
  EXPECT_EQ(asker.statistics().lost, 0);
}

TEST(LockstepAsker, SendsOnceAndRetriesTimesThenGivesUp) {
  const Peer peer([](const Question&) { return Replies{}; });
  LockstepAsker asker(open_link(), {0.05, 3});
  const Expected<const Answer*> answer = asker.ask(question_number(0));
  ASSERT_FALSE(answer);
  EXPECT_NE(answer.error().message().find(std::string(kStatesChannel)), std::string::npos);
  EXPECT_EQ(asker.statistics().retries, 3);
  EXPECT_EQ(asker.statistics().lost, 1);
}

TEST(LockstepAsker, RefusesAnAnswerAboutOtherBodies) {
  for (const bool fewer : {true, false}) {
    const Peer peer([fewer](const Question& question) {
      Answer answer = answer_to(question, 9.0);
      if (fewer) {
        answer.bodies.pop_back();
      } else {
        answer.bodies[1].body_id = 7;
      }
      return Replies{bytes_of(answer)};
    });
    LockstepAsker asker(open_link(), kPatient);
    const Expected<const Answer*> answer = asker.ask(question_number(0));
    ASSERT_FALSE(answer);
    EXPECT_NE(answer.error().message().find("other bodies"), std::string::npos) << answer.error().message();
  }
}

TEST(FreeRunningAsker, TakesTheNewestAnswerAndSaysByHowMuchItWasLate) {
  // Answers question 0 and then, to every question, the one three before: too late by three.
  const Peer peer([](const Question& question) {
    Question earlier = question;
    if (question.key.seq != 0) earlier.key.seq -= 3;
    return Replies{bytes_of(answer_to(earlier, static_cast<double>(earlier.key.seq)))};
  });
  FreeRunningAsker asker(open_link(), kPatient, 0.05);
  for (std::int64_t seq = 0; seq <= 10; ++seq) {
    const Expected<const Answer*> answer = asker.ask(question_number(seq));
    ASSERT_TRUE(answer) << answer.error().message();
    EXPECT_LE((*answer)->key.seq, std::max<std::int64_t>(0, seq - 3));
  }
  const AskerStatistics statistics = asker.statistics();
  EXPECT_EQ(statistics.questions, 11);
  EXPECT_EQ(statistics.late, 10);
  EXPECT_GE(statistics.latest, 3);
  EXPECT_GE(statistics.lost, 3);
}

}  // namespace
}  // namespace buoyancy
