#include "transport/lcm_reassembler.h"

#include <array>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include "tests/service/raw_lcm.h"
#include "tests/support/allocation_count.h"
#include "tests/support/process_memory.h"

namespace buoyancy {
namespace {

constexpr std::uint32_t kWhole = 0x4c433032;
constexpr std::uint32_t kFragment = 0x4c433033;

void append(RawBytes& bytes, std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append(RawBytes& bytes, const std::string& channel) {
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
}

RawBytes unfragmented(const std::string& channel, const RawBytes& payload) {
  RawBytes packet;
  append(packet, kWhole, 4);
  append(packet, 1, 4);
  append(packet, channel);
  packet.insert(packet.end(), payload.begin(), payload.end());
  return packet;
}

std::vector<RawBytes> fragments(const std::string& channel, const RawBytes& payload, std::size_t size,
                                int number) {
  std::vector<RawBytes> packets;
  const std::size_t count = (payload.size() + size - 1) / size;
  for (std::size_t i = 0; i < count; ++i) {
    RawBytes packet;
    append(packet, kFragment, 4);
    append(packet, static_cast<std::uint64_t>(number), 4);
    append(packet, payload.size(), 4);
    append(packet, i * size, 4);
    append(packet, i, 2);
    append(packet, count, 2);
    if (i == 0) append(packet, channel);
    const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(i * size);
    packet.insert(packet.end(), begin,
                  begin + static_cast<std::ptrdiff_t>(std::min(size, payload.size() - i * size)));
    packets.push_back(packet);
  }
  return packets;
}

RawBytes counting(std::size_t size) {
  RawBytes payload(size);
  for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return payload;
}

LcmReassembler subscribed_to(const std::vector<std::string>& channels) {
  LcmReassembler reassembler;
  for (std::size_t i = 0; i < channels.size(); ++i) EXPECT_EQ(reassembler.add_channel(channels[i]), i);
  return reassembler;
}

bool holds(const std::optional<LcmReassembler::Message>& message, std::size_t channel,
           const RawBytes& payload) {
  return message && message->channel == channel &&
         RawBytes(message->payload.begin(), message->payload.end()) == payload;
}

TEST(LcmReassembler, ReturnsMessagesOfAddedChannelsOnly) {
  LcmReassembler reassembler = subscribed_to({"A", "BB"});
  EXPECT_TRUE(holds(reassembler.push(unfragmented("BB", {1, 2, 3}), 1), 1, {1, 2, 3}));
  EXPECT_TRUE(holds(reassembler.push(unfragmented("A", {}), 1), 0, {}));
  for (const char* other : {"", "B", "BBB", "a"})
    EXPECT_FALSE(reassembler.push(unfragmented(other, {1}), 1)) << other;
}

TEST(LcmReassembler, ReassemblesInterleavedFragmentsOfSeveralSenders) {
  LcmReassembler reassembler = subscribed_to({"A"});
  const RawBytes one = counting(1'000);
  const RawBytes other = counting(900);
  const auto of_one = fragments("A", one, 300, 5);
  const auto of_other = fragments("A", other, 300, 5);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(reassembler.push(of_one[i], 1));
    const auto message = reassembler.push(of_other[i], 2);
    EXPECT_EQ(message.has_value(), i == 2);
    if (i == 2) {
      EXPECT_TRUE(holds(message, 0, other));
    }
  }
  EXPECT_TRUE(holds(reassembler.push(of_one[3], 1), 0, one));
  EXPECT_EQ(reassembler.fragments_dropped(), 0);
}

TEST(LcmReassembler, AddsEachChannelOnce) {
  LcmReassembler reassembler = subscribed_to({"A"});
  EXPECT_FALSE(reassembler.add_channel("A"));
  EXPECT_EQ(reassembler.add_channel("B"), 1U);
}

RC_GTEST_PROP(LcmReassembler, DeliversWholeMessagesAndCountsTheFragmentsOfOthers, ()) {
  LcmReassembler reassembler = subscribed_to({"A"});
  std::array<std::int64_t, 2> incomplete{};  // fragments of each sender's last message
  std::int64_t dropped = 0;
  for (int number = 0; number < 6; ++number) {  // bytes of an earlier message must not appear
    const auto sender = *rc::gen::inRange<std::size_t>(0, incomplete.size());
    const RawBytes payload = counting(static_cast<std::size_t>(*rc::gen::inRange(301, 3'000)));
    auto packets = fragments("A", payload, 300, number);
    for (std::size_t i = packets.size() - 1; i > 1; --i) {
      std::swap(packets[i], packets[*rc::gen::inRange<std::size_t>(1, i + 1)]);
    }
    const std::size_t count = packets.size();
    if (*rc::gen::arbitrary<bool>()) packets.pop_back();
    dropped += incomplete[sender];
    incomplete[sender] = packets.size() < count ? static_cast<std::int64_t>(packets.size()) : 0;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const auto message = reassembler.push(packets[i], sender);
      RC_ASSERT((i + 1 == count ? holds(message, 0, payload) : !message));
      // A duplicate of any of them, even if it comes after the whole message. (One of the first then begins
      // another.)
      const std::size_t duplicate = *rc::gen::inRange<std::size_t>(0, i + 1);
      if (duplicate > 0 || i + 1 < count) RC_ASSERT(!reassembler.push(packets[duplicate], sender));
    }
    RC_ASSERT(reassembler.fragments_dropped() == dropped);
  }
}

TEST(LcmReassembler, DropsFragmentsWithGapsOrOverlaps) {
  constexpr std::size_t kOffsetsLowByte = 15;
  LcmReassembler reassembler = subscribed_to({"A"});
  int number = 0;
  for (const int moved : {-1, 1}) {
    auto some = fragments("A", counting(1'000), 400, ++number);
    some[1][kOffsetsLowByte] = static_cast<std::uint8_t>(some[1][kOffsetsLowByte] + moved);
    for (const RawBytes& packet : some) EXPECT_FALSE(reassembler.push(packet, 1)) << moved;
    EXPECT_EQ(reassembler.fragments_dropped(), 3 * number);
  }
}

// A first fragment of a message that never arrives: 37 bytes that announce the largest message.
RawBytes forged_fragment(int number) {
  RawBytes packet;
  append(packet, kFragment, 4);
  append(packet, static_cast<std::uint64_t>(number), 4);
  append(packet, kMaxMessageBytes, 4);
  append(packet, 0, 4);
  append(packet, 0, 2);
  append(packet, 0xffff, 2);
  append(packet, "A");
  packet.resize(packet.size() + 15);
  return packet;
}

TEST(LcmReassembler, EvictsTheMessageWithoutProgressIfFull) {
  constexpr int kForged = 10 * static_cast<int>(LcmReassembler::kMaxPartialMessages);
  LcmReassembler reassembler = subscribed_to({"A"});
  const RawBytes payload = counting(100'000);
  const auto honest = fragments("A", payload, 1'000, 1);
  std::uint64_t forger = 1;
  for (std::size_t i = 0; i + 1 < honest.size(); ++i) {
    EXPECT_FALSE(reassembler.push(honest[i], 0));
    for (int n = 0; n < kForged / 100; ++n) EXPECT_FALSE(reassembler.push(forged_fragment(n), ++forger));
  }
  EXPECT_TRUE(holds(reassembler.push(honest.back(), 0), 0, payload));
  EXPECT_GT(reassembler.partial_messages_evicted(), 1'000);
  EXPECT_EQ(reassembler.fragments_dropped(), reassembler.partial_messages_evicted());
}

TEST(LcmReassembler, AllocatesNoMoreThanWhatHasArrived) {
  LcmReassembler reassembler = subscribed_to({"A"});
  const AllocationCount allocations;
  for (std::uint64_t sender = 0; sender < 1'000; ++sender) reassembler.push(forged_fragment(1), sender);
  EXPECT_LT(allocations.bytes(), 1'000'000);
}

TEST(LcmReassembler, KeepsPartialMessagesWithinTheirMemory) {
  // All but the last fragment of messages of 16 MB.
  constexpr std::size_t kFragmentBytes = 60'000;
  LcmReassembler reassembler = subscribed_to({"A"});
  const RawBytes payload = counting(kMaxMessageBytes);
  const auto packets = fragments("A", payload, kFragmentBytes, 1);
  [[maybe_unused]] const std::int64_t before = resident_kb(::getpid());
  for (std::uint64_t sender = 0; sender < 10; ++sender) {
    for (std::size_t i = 0; i + 1 < packets.size(); ++i) reassembler.push(packets[i], sender);
  }
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they use memory of their own
  EXPECT_LE(resident_kb(::getpid()) - before,
            2 * static_cast<std::int64_t>(LcmReassembler::kMaxPartialBytes) / 1'024);
#endif
  EXPECT_GE(reassembler.partial_messages_evicted(), 6);
  EXPECT_TRUE(holds(reassembler.push(packets.back(), 9), 0, payload));
}

TEST(LcmReassembler, LosesAMessageForWhichThereIsNoMemory) {
  const RawBytes payload = counting(100'000);
  const auto packets = fragments("A", payload, 10'000, 1);
  for (std::int64_t n = 1; n < 100; ++n) {
    LcmReassembler reassembler = subscribed_to({"A"});
    bool has_failed = false;
    bool complete = false;
    {
      const FailingAllocation failing(n);
      for (const RawBytes& packet : packets) complete = reassembler.push(packet, 1).has_value();
      has_failed = failing.has_failed();
    }
    EXPECT_NE(complete, has_failed) << n;
    if (!has_failed) return;
    EXPECT_GT(reassembler.fragments_dropped(), 0) << n;
    for (const RawBytes& packet : packets) complete = reassembler.push(packet, 1).has_value();
    EXPECT_TRUE(complete) << n;
  }
  FAIL() << "never without a failure";
}

TEST(LcmReassembler, DropsFragmentsThatExceedTheirMessage) {
  LcmReassembler reassembler = subscribed_to({"A"});
  auto some = fragments("A", counting(1'000), 400, 1);
  some[2] = some[1];
  some[2][17] = 2;  // the number of the fragment
  EXPECT_FALSE(reassembler.push(some[0], 1));
  EXPECT_FALSE(reassembler.push(some[1], 1));
  EXPECT_FALSE(reassembler.push(some[1], 1));  // a duplicate is none
  EXPECT_EQ(reassembler.fragments_dropped(), 0);
  EXPECT_FALSE(reassembler.push(some[2], 1));
  EXPECT_GT(reassembler.fragments_dropped(), 0);
}

TEST(LcmReassembler, RejectsOversizedMessages) {
  LcmReassembler reassembler = subscribed_to({"A"});
  for (const std::int64_t excess : {0, 1}) {
    const RawBytes first = fragments("A", counting(kMaxMessageBytes + excess), 60'000, 1)[0];
    EXPECT_FALSE(reassembler.push(first, 1));
    EXPECT_EQ(reassembler.fragments_dropped(), excess);
    EXPECT_EQ(reassembler.oversized_messages(), excess);
  }
}

TEST(LcmReassembler, LimitsPartialMessages) {
  constexpr std::uint64_t kLimit = LcmReassembler::kMaxPartialMessages;
  LcmReassembler reassembler = subscribed_to({"A"});
  const RawBytes payload = counting(500);
  const auto packets = fragments("A", payload, 300, 1);
  for (std::uint64_t sender = 0; sender < kLimit; ++sender) reassembler.push(packets[0], sender);
  EXPECT_EQ(reassembler.partial_messages_evicted(), 0);
  reassembler.push(packets[0], kLimit);
  EXPECT_EQ(reassembler.partial_messages_evicted(), 1);
  for (std::uint64_t sender = 0; sender <= kLimit; ++sender)
    EXPECT_EQ(holds(reassembler.push(packets[1], sender), 0, payload), sender > 0) << sender;
}

RC_GTEST_PROP(LcmReassembler, RecoversAfterCorruptPackets, ()) {
  LcmReassembler reassembler = subscribed_to({"A"});
  const RawBytes payload = counting(1'000);
  const int corrupt_packets = *rc::gen::inRange(0, 30);
  for (int i = 0; i < corrupt_packets; ++i) {
    auto some = fragments("A", payload, 400, *rc::gen::inRange(0, 3));
    some.push_back(unfragmented("A", payload));
    RawBytes packet = *rc::gen::elementOf(some);
    const auto place = *rc::gen::inRange<std::size_t>(0, 30);
    packet[place] = *rc::gen::arbitrary<std::uint8_t>();
    if (*rc::gen::inRange(0, 4) == 0) packet.resize(place);
    const auto message = reassembler.push(packet, *rc::gen::inRange<std::uint64_t>(0, 3));
    RC_ASSERT(!message || message->payload.size() <= payload.size() + 30);
  }
  const auto next = fragments("A", payload, 400, 77);
  RC_ASSERT(!reassembler.push(next[0], 9));
  RC_ASSERT(!reassembler.push(next[1], 9));
  RC_ASSERT(holds(reassembler.push(next[2], 9), 0, payload));
}

}  // namespace
}  // namespace buoyancy
