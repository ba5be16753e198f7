#include "messages/wire.h"

#include <algorithm>
#include <climits>
#include <string>

#include <buoyancy/bodies_hydrostatics_t.hpp>
#include <buoyancy/body_states_t.hpp>
#include <buoyancy/body_wrenches_t.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_count.h"

namespace buoyancy {
namespace {

using ByteVector = std::vector<std::uint8_t>;

constexpr std::size_t kQuestionFixed = 44;
constexpr std::size_t kBodyState = 108;
constexpr std::size_t kAnswerFixed = 36;
constexpr std::size_t kBodyWrench = 104;
constexpr std::size_t kBodyHydrostatics = 512;  // behind a head like an answer's

template <typename Message>
ByteVector encoded(const Message& message) {
  ByteVector bytes;
  encode(message, bytes);
  return bytes;
}

template <std::size_t kSize>
void copy(const std::array<double, kSize>& from, double (&to)[kSize]) {
  std::copy(from.begin(), from.end(), to);
}

body_states_t as_generated(const Question& question) {
  body_states_t message{};
  message.utime = question.key.utime;
  message.session_id = question.key.session_id;
  message.seq = question.key.seq;
  message.lead_time = question.lead_time;
  message.num_bodies = static_cast<std::int32_t>(question.bodies.size());
  for (const BodyState& body : question.bodies) {
    body_state_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    copy(body.position, to.position);
    copy(body.quaternion_wxyz, to.quaternion_wxyz);
    copy(body.linear_velocity, to.linear_velocity);
    copy(body.angular_velocity, to.angular_velocity);
  }
  return message;
}

body_wrenches_t as_generated(const Answer& answer) {
  body_wrenches_t message{};
  message.utime = answer.key.utime;
  message.session_id = answer.key.session_id;
  message.seq = answer.key.seq;
  message.num_bodies = static_cast<std::int32_t>(answer.bodies.size());
  for (const BodyWrench& body : answer.bodies) {
    body_wrench_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    to.status = static_cast<std::int32_t>(body.status);
    copy(body.force, to.force);
    copy(body.torque, to.torque);
    to.submerged_volume = body.submerged_volume;
    copy(body.center_of_buoyancy, to.center_of_buoyancy);
    to.force_error_bound = body.force_error_bound;
    to.torque_error_bound = body.torque_error_bound;
  }
  return message;
}

template <std::size_t kRows, std::size_t kColumns>
void copy(const std::array<std::array<double, kColumns>, kRows>& from, double (&to)[kRows][kColumns]) {
  for (std::size_t row = 0; row < kRows; ++row) copy(from[row], to[row]);
}

bodies_hydrostatics_t as_generated(const BodiesHydrostatics& hydrostatics) {
  bodies_hydrostatics_t message{};
  message.utime = hydrostatics.key.utime;
  message.session_id = hydrostatics.key.session_id;
  message.seq = hydrostatics.key.seq;
  message.num_bodies = static_cast<std::int32_t>(hydrostatics.bodies.size());
  for (const BodyHydrostatics& body : hydrostatics.bodies) {
    body_hydrostatics_t& to = message.bodies.emplace_back();
    to.body_id = body.body_id;
    to.status = static_cast<std::int32_t>(body.status);
    to.submerged_volume = body.submerged_volume;
    copy(body.center_of_buoyancy, to.center_of_buoyancy);
    to.wetted_area = body.wetted_area;
    to.waterplane_area = body.waterplane_area;
    copy(body.waterplane_centroid, to.waterplane_centroid);
    copy(body.waterplane_second_moments, to.waterplane_second_moments);
    copy(body.waterplane_axes, to.waterplane_axes);
    copy(body.metacentric_radii, to.metacentric_radii);
    copy(body.metacenters, to.metacenters);
    copy(body.metacentric_heights, to.metacentric_heights);
    copy(body.stiffness, to.stiffness);
  }
  return message;
}

ByteVector question_of(std::size_t bodies) {
  Question question{.key = {.utime = 1, .session_id = 2, .seq = 3}, .lead_time = 0.25, .bodies = {}};
  question.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) question.bodies[i].body_id = static_cast<std::int32_t>(i);
  return encoded(question);
}

void set_count(ByteVector& bytes, std::size_t fixed_size, std::int32_t count) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[fixed_size - 1 - i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(count) >> (8 * i));
  }
}

RC_GTEST_PROP(Wire, EncodesQuestionsAsTheGeneratedCodeDoes, ()) {
  const Question question = random_question();
  RC_ASSERT(encoded(question) == encoded_by_lcm(as_generated(question)));
}

RC_GTEST_PROP(Wire, EncodesAnswersAsTheGeneratedCodeDoes, ()) {
  const Answer answer = random_answer();
  RC_ASSERT(encoded(answer) == encoded_by_lcm(as_generated(answer)));
}

RC_GTEST_PROP(Wire, DecodesQuestionsOfTheGeneratedCode, ()) {
  const body_states_t message = as_generated(random_question());
  const ByteVector bytes = encoded_by_lcm(message);
  Question question = random_question();  // what was there before must not matter
  RC_ASSERT(!decode(bytes, question).has_value());
  RC_ASSERT(question.key.utime == message.utime);
  RC_ASSERT(question.key.session_id == message.session_id);
  RC_ASSERT(question.key.seq == message.seq);
  RC_ASSERT(question.bodies.size() == message.bodies.size());
  RC_ASSERT(encoded_by_lcm(as_generated(question)) == bytes);
}

RC_GTEST_PROP(Wire, DecodesAnswersOfTheGeneratedCode, ()) {
  const ByteVector bytes = encoded_by_lcm(as_generated(random_answer()));
  Answer answer = random_answer();
  RC_ASSERT(!decode(bytes, answer).has_value());
  RC_ASSERT(encoded_by_lcm(as_generated(answer)) == bytes);
}

RC_GTEST_PROP(Wire, EncodesHydrostaticsAsTheGeneratedCodeDoes, ()) {
  const BodiesHydrostatics hydrostatics = random_hydrostatics();
  RC_ASSERT(encoded(hydrostatics) == encoded_by_lcm(as_generated(hydrostatics)));
}

RC_GTEST_PROP(Wire, DecodesHydrostaticsOfTheGeneratedCode, ()) {
  const ByteVector bytes = encoded_by_lcm(as_generated(random_hydrostatics()));
  BodiesHydrostatics hydrostatics = random_hydrostatics();
  RC_ASSERT(!decode(bytes, hydrostatics).has_value());
  RC_ASSERT(encoded_by_lcm(as_generated(hydrostatics)) == bytes);
}

RC_GTEST_PROP(Wire, PeeksTheKeyThatDecodingFinds, ()) {
  const Question question = random_question();
  const auto key = peek_key(encoded(question));
  RC_ASSERT(key.has_value());
  RC_ASSERT(key->utime == question.key.utime);
  RC_ASSERT(key->session_id == question.key.session_id);
  RC_ASSERT(key->seq == question.key.seq);
}

RC_GTEST_PROP(Wire, RandomBytesBehindTheRightFingerprintAreDecodedOrRejectedButNeverCrash, ()) {
  ByteVector bytes = question_of(0);
  bytes.resize(8);
  const auto garbage = *rc::gen::arbitrary<ByteVector>();
  bytes.insert(bytes.end(), garbage.begin(), garbage.end());
  Question question;
  RC_ASSERT(decode(bytes, question).has_value() == !peek_key(bytes).has_value());
}

TEST(Wire, SizesAreThoseOfTheMessageDefinitions) {
  EXPECT_EQ(question_of(0).size(), kQuestionFixed);
  EXPECT_EQ(question_of(3).size(), kQuestionFixed + 3 * kBodyState);
  EXPECT_EQ(encoded(Answer{}).size(), kAnswerFixed);
  EXPECT_EQ(encoded(Answer{.key = {}, .bodies = {{}, {}}}).size(), kAnswerFixed + 2 * kBodyWrench);
  EXPECT_EQ(encoded(BodiesHydrostatics{}).size(), kAnswerFixed);
  EXPECT_EQ(encoded(BodiesHydrostatics{.key = {}, .bodies = {{}, {}}}).size(),
            kAnswerFixed + 2 * kBodyHydrostatics);
}

TEST(Wire, RejectsEveryTruncationOfAQuestion) {
  const ByteVector whole = question_of(3);
  Question question;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part = Bytes(whole).first(size);
    const Rejection expected = size < kQuestionFixed ? Rejection::kTruncated : Rejection::kLength;
    EXPECT_EQ(decode(part, question), expected) << size << " bytes";
    ASSERT_FALSE(peek_key(part).has_value()) << size << " bytes";
    EXPECT_EQ(peek_key(part).error(), expected) << size << " bytes";
  }
}

TEST(Wire, RejectsEveryTruncationOfAnAnswer) {
  const ByteVector whole = encoded(Answer{.key = {}, .bodies = {{}, {}}});
  Answer answer;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), answer),
              size < kAnswerFixed ? Rejection::kTruncated : Rejection::kLength)
        << size << " bytes";
  }
}

TEST(Wire, RejectsEveryTruncationOfHydrostatics) {
  const ByteVector whole = encoded(BodiesHydrostatics{.key = {}, .bodies = {{}, {}}});
  BodiesHydrostatics hydrostatics;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(decode(Bytes(whole).first(size), hydrostatics),
              size < kAnswerFixed ? Rejection::kTruncated : Rejection::kLength)
        << size << " bytes";
  }
}

TEST(Wire, RejectsEveryFlippedBitOfTheFingerprint) {
  const ByteVector whole = question_of(1);
  Question question;
  for (std::size_t bit = 0; bit < 64; ++bit) {
    ByteVector bytes = whole;
    bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_EQ(decode(bytes, question), Rejection::kFingerprint) << "bit " << bit;
  }
}

TEST(Wire, RejectsOtherTypesOfOurOwn) {
  Question question;
  Answer answer;
  EXPECT_EQ(decode(encoded(Answer{.key = {}, .bodies = {{}, {}}}), question), Rejection::kFingerprint);
  EXPECT_EQ(decode(question_of(2), answer), Rejection::kFingerprint);
  EXPECT_EQ(decode(encoded(BodiesHydrostatics{}), answer), Rejection::kFingerprint);
}

TEST(Wire, RejectsCountsThatDoNotFitTheLength) {
  struct Case {
    std::int32_t count;
    Rejection expected;
  };
  for (const Case& c :
       {Case{-1, Rejection::kCount}, Case{INT_MIN, Rejection::kCount}, Case{-2, Rejection::kCount},
        Case{INT_MAX, Rejection::kLength}, Case{0, Rejection::kLength}, Case{1, Rejection::kLength},
        Case{3, Rejection::kLength}, Case{1 << 30, Rejection::kLength}}) {
    ByteVector bytes = question_of(2);
    set_count(bytes, kQuestionFixed, c.count);
    Question question;
    EXPECT_EQ(decode(bytes, question), c.expected) << c.count;
    ByteVector answer_bytes = encoded(Answer{.key = {}, .bodies = {{}, {}}});
    set_count(answer_bytes, kAnswerFixed, c.count);
    Answer answer;
    EXPECT_EQ(decode(answer_bytes, answer), c.expected) << c.count;
  }
}

TEST(Wire, RejectsTrailingBytes) {
  for (const std::size_t extra :
       {std::size_t{1}, std::size_t{8}, kBodyState - 1, kBodyState, 2 * kBodyState}) {
    ByteVector bytes = question_of(1);
    bytes.resize(bytes.size() + extra);
    Question question;
    EXPECT_EQ(decode(bytes, question), Rejection::kLength) << extra;
  }
}

TEST(Wire, RejectionLeavesTheQuestionUnchanged) {
  Question question;
  ASSERT_FALSE(decode(question_of(3), question).has_value());
  ByteVector bad = question_of(2);
  bad.push_back(0);
  ASSERT_TRUE(decode(bad, question).has_value());
  EXPECT_EQ(encoded(question), question_of(3));
}

TEST(Wire, ACountInTheBillionsTakesNoMemory) {
  ByteVector bytes = question_of(0);
  set_count(bytes, kQuestionFixed, INT_MAX);
  Question question;
  const AllocationCount allocations;
  EXPECT_EQ(decode(bytes, question), Rejection::kLength);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(Wire, DecodesFromAnyAddress) {
  const ByteVector whole = question_of(2);
  for (std::size_t shift = 0; shift < 8; ++shift) {
    ByteVector shifted(shift);
    shifted.insert(shifted.end(), whole.begin(), whole.end());
    Question question;
    ASSERT_FALSE(decode(Bytes(shifted).subspan(shift), question).has_value());
    EXPECT_EQ(encoded(question), whole) << "shifted by " << shift;
  }
}

TEST(Wire, TakesNothingFromTheHeapAfterWarmUp) {
  const ByteVector largest = question_of(1000);
  const ByteVector small = question_of(7);
  Question question;
  ASSERT_FALSE(decode(largest, question).has_value());
  ByteVector bytes;
  encode(question, bytes);
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    for (const ByteVector* message : {&small, &largest}) {
      ASSERT_FALSE(decode(*message, question).has_value());
      encode(question, bytes);
      ASSERT_EQ(bytes, *message);
    }
  }
  EXPECT_EQ(allocations.count(), 0);
}

TEST(BodyStatusNames, AreThoseOfTheMessageDefinition) {
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::OK}), "OK");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::UNKNOWN_BODY}), "UNKNOWN_BODY");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::NON_FINITE_POSE}), "NON_FINITE_POSE");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::BAD_QUATERNION}), "BAD_QUATERNION");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::NON_FINITE_TWIST}), "NON_FINITE_TWIST");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::BAD_LEAD_TIME}), "BAD_LEAD_TIME");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::OPEN_EDGE_WET}), "OPEN_EDGE_WET");
  EXPECT_STREQ(name(BodyStatus{body_wrench_t::OUT_OF_RANGE}), "OUT_OF_RANGE");
  EXPECT_STREQ(name(BodyStatus{kBodyStatusCount}), "UNKNOWN_STATUS");
}

TEST(Rejections, AreEachDescribedInOtherWords) {
  const std::vector<std::string> descriptions{describe(Rejection::kTruncated),
                                              describe(Rejection::kFingerprint), describe(Rejection::kCount),
                                              describe(Rejection::kLength)};
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    EXPECT_FALSE(descriptions[i].empty());
    EXPECT_EQ(std::count(descriptions.begin(), descriptions.end(), descriptions[i]), 1) << descriptions[i];
  }
}

}  // namespace
}  // namespace buoyancy
