#include "messages/condition_change.h"

#include <buoyancy/body_condition_t.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/random_messages.h"
#include "tests/support/allocation_count.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

constexpr std::size_t kSize = 8 + 8 + 3 * 4 + 2 * 8;

ConditionChange random_change() {
  ConditionChange change;
  Randomiser randomiser;
  visit_fields(change, randomiser);
  return change;
}

ByteVector encoded(const ConditionChange& change) {
  ByteVector bytes(100, 7);  // whose previous content must not matter
  encode(change, bytes);
  return bytes;
}

RC_GTEST_PROP(ConditionChange, EncodesLikeLcm, ()) {
  const ConditionChange change = random_change();
  body_condition_t message{};
  message.utime = change.utime;
  message.body_id = change.body_id;
  message.kind = static_cast<std::int32_t>(change.kind);
  message.index = change.index;
  message.flooded = change.flooded;
  message.liquid_volume = change.liquid_volume;
  RC_ASSERT(encoded(change) == encoded_by_lcm(message));
}

RC_GTEST_PROP(ConditionChange, DecodesWhatItEncodes, ()) {
  const ByteVector bytes = encoded(random_change());
  ConditionChange change;
  RC_ASSERT(!decode(bytes, change));
  RC_ASSERT(encoded(change) == bytes);
}

TEST(ConditionChange, RejectsOtherLengthsAndFingerprints) {
  ConditionChange sent;
  sent.flooded = 0.5;
  ByteVector bytes = encoded(sent);
  ASSERT_EQ(bytes.size(), kSize);
  ConditionChange change;
  for (std::size_t size = 0; size < kSize; ++size) {
    ASSERT_EQ(decode(Bytes(bytes).first(size), change), DecodeError::kTruncated) << size << " bytes";
  }
  bytes.push_back(0);
  EXPECT_EQ(decode(bytes, change), DecodeError::kLength);
  bytes.pop_back();
  bytes[3] ^= 1U;
  EXPECT_EQ(decode(bytes, change), DecodeError::kFingerprint);
  EXPECT_EQ(change, ConditionChange{}) << "unchanged";
}

TEST(ConditionChange, DoesNotAllocateAfterWarmUp) {
  ByteVector bytes = encoded(ConditionChange{});
  ConditionChange change;
  const AllocationCount allocations;
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(decode(bytes, change));
    encode(change, bytes);
  }
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace buoyancy
