#include "transport/lcm_reassembler.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/service/raw_lcm.h"

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

RawBytes whole(const std::string& channel, const RawBytes& payload) {
  RawBytes packet;
  append(packet, kWhole, 4);
  append(packet, 1, 4);
  append(packet, channel);
  packet.insert(packet.end(), payload.begin(), payload.end());
  return packet;
}

std::vector<RawBytes> fragments(const std::string& channel, const RawBytes& payload, std::size_t part,
                                int number) {
  std::vector<RawBytes> packets;
  const std::size_t count = (payload.size() + part - 1) / part;
  for (std::size_t i = 0; i < count; ++i) {
    RawBytes packet;
    append(packet, kFragment, 4);
    append(packet, static_cast<std::uint64_t>(number), 4);
    append(packet, payload.size(), 4);
    append(packet, i * part, 4);
    append(packet, i, 2);
    append(packet, count, 2);
    if (i == 0) append(packet, channel);
    const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(i * part);
    packet.insert(packet.end(), begin,
                  begin + static_cast<std::ptrdiff_t>(std::min(part, payload.size() - i * part)));
    packets.push_back(packet);
  }
  return packets;
}

RawBytes counting(std::size_t size) {
  RawBytes payload(size);
  for (std::size_t i = 0; i < size; ++i) payload[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return payload;
}

LcmReassembler listening_to(const std::vector<std::string>& channels) {
  LcmReassembler packets;
  for (std::size_t i = 0; i < channels.size(); ++i) EXPECT_EQ(packets.add_channel(channels[i]), i);
  return packets;
}

bool holds(const std::optional<LcmReassembler::Message>& message, std::size_t channel,
           const RawBytes& payload) {
  return message && message->channel == channel &&
         RawBytes(message->payload.begin(), message->payload.end()) == payload;
}

TEST(LcmReassembler, GivesWhatIsOnTheChannelsThatAreNamedAndNothingElse) {
  LcmReassembler packets = listening_to({"A", "BB"});
  EXPECT_TRUE(holds(packets.push(whole("BB", {1, 2, 3}), 1), 1, {1, 2, 3}));
  EXPECT_TRUE(holds(packets.push(whole("A", {}), 1), 0, {}));
  for (const char* other : {"", "B", "BBB", "a"}) EXPECT_FALSE(packets.push(whole(other, {1}), 1)) << other;
}

TEST(LcmReassembler, PutsFragmentsTogetherOfSeveralSendersAtATime) {
  LcmReassembler packets = listening_to({"A"});
  const RawBytes one = counting(1'000);
  const RawBytes other = counting(900);
  const auto of_one = fragments("A", one, 300, 5);
  const auto of_other = fragments("A", other, 300, 5);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(packets.push(of_one[i], 1));
    const auto message = packets.push(of_other[i], 2);
    EXPECT_EQ(message.has_value(), i == 2);
    if (i == 2) {
      EXPECT_TRUE(holds(message, 0, other));
    }
  }
  EXPECT_TRUE(holds(packets.push(of_one[3], 1), 0, one));
  EXPECT_EQ(packets.fragments_dropped(), 0);
}

TEST(LcmReassembler, TakesAChannelOnce) {
  LcmReassembler packets = listening_to({"A"});
  EXPECT_FALSE(packets.add_channel("A"));
  EXPECT_EQ(packets.add_channel("B"), 1U);
}

TEST(LcmReassembler, LosesAMessageWholeThatLostAFragmentAndTakesTheNext) {
  LcmReassembler packets = listening_to({"A"});
  const auto lost = fragments("A", counting(1'000), 300, 5);
  for (const std::size_t i : {0U, 2U, 3U}) EXPECT_FALSE(packets.push(lost[i], 1));
  const RawBytes payload = counting(1'000);
  const auto next = fragments("A", payload, 300, 6);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(packets.push(next[i], 1));
  EXPECT_TRUE(holds(packets.push(next[3], 1), 0, payload));
  EXPECT_EQ(packets.fragments_dropped(), 3);
}

RC_GTEST_PROP(LcmReassembler, TakesFragmentsInAnyOrderBehindTheFirstAndAnyOfThemTwice, ()) {
  LcmReassembler packets = listening_to({"A"});
  for (int number = 0; number < 3; ++number) {  // what an earlier message left behind is in none
    const RawBytes payload = counting(static_cast<std::size_t>(*rc::gen::inRange(301, 3'000)));
    auto packets_of_it = fragments("A", payload, 300, number);
    for (std::size_t i = packets_of_it.size() - 1; i > 1; --i) {
      std::swap(packets_of_it[i], packets_of_it[*rc::gen::inRange<std::size_t>(1, i + 1)]);
    }
    const RawBytes last = packets_of_it.back();
    packets_of_it.pop_back();
    for (const RawBytes& packet : packets_of_it) {
      RC_ASSERT(!packets.push(packet, 1));
      if (*rc::gen::inRange(0, 4) == 0) RC_ASSERT(!packets.push(packet, 1));
    }
    RC_ASSERT(holds(packets.push(last, 1), 0, payload));
  }
  RC_ASSERT(packets.fragments_dropped() == 0);
}

TEST(LcmReassembler, DropsFragmentsThatLeaveAGapOrLieOnEachOther) {
  constexpr std::size_t kOffsetsLowByte = 15;
  LcmReassembler packets = listening_to({"A"});
  int number = 0;
  for (const int moved : {-1, 1}) {
    auto some = fragments("A", counting(1'000), 400, ++number);
    some[1][kOffsetsLowByte] = static_cast<std::uint8_t>(some[1][kOffsetsLowByte] + moved);
    for (const RawBytes& packet : some) EXPECT_FALSE(packets.push(packet, 1)) << moved;
    EXPECT_EQ(packets.fragments_dropped(), 3 * number);
  }
}

TEST(LcmReassembler, GivesUpTheOldestOfMoreThanItHasRoomFor) {
  LcmReassembler packets = listening_to({"A"});
  for (std::uint64_t sender = 0; sender < 100; ++sender) {
    EXPECT_FALSE(packets.push(fragments("A", counting(1'000), 600, 1)[0], sender));
  }
  EXPECT_EQ(packets.fragments_dropped(),
            100 - static_cast<std::int64_t>(LcmReassembler::kMaxPartialMessages));
  EXPECT_FALSE(packets.push(fragments("A", counting(1'000), 600, 1)[1], 0));
  EXPECT_TRUE(holds(packets.push(fragments("A", counting(1'000), 600, 1)[1], 99), 0, counting(1'000)));
}

TEST(LcmReassembler, BeginsNoMessageThatIsLargerThanItTakes) {
  LcmReassembler packets = listening_to({"A"});
  RawBytes first = fragments("A", counting(1'000), 600, 1)[0];
  for (std::size_t i = 8; i < 12; ++i) first[i] = 0xff;  // its size
  EXPECT_FALSE(packets.push(first, 1));
  EXPECT_EQ(packets.fragments_dropped(), 1);
}

RC_GTEST_PROP(LcmReassembler, TakesAnyBytesAndEveryWholeMessageAfterThem, ()) {
  LcmReassembler packets = listening_to({"A"});
  const RawBytes payload = counting(1'000);
  const int corrupt_sections = *rc::gen::inRange(0, 30);
  for (int i = 0; i < corrupt_sections; ++i) {
    auto some = fragments("A", payload, 400, *rc::gen::inRange(0, 3));
    some.push_back(whole("A", payload));
    RawBytes packet = *rc::gen::elementOf(some);
    const auto place = *rc::gen::inRange<std::size_t>(0, 30);
    packet[place] = *rc::gen::arbitrary<std::uint8_t>();
    if (*rc::gen::inRange(0, 4) == 0) packet.resize(place);
    const auto message = packets.push(packet, *rc::gen::inRange<std::uint64_t>(0, 3));
    RC_ASSERT(!message || message->payload.size() <= payload.size() + 30);
  }
  const auto next = fragments("A", payload, 400, 77);
  RC_ASSERT(!packets.push(next[0], 9));
  RC_ASSERT(!packets.push(next[1], 9));
  RC_ASSERT(holds(packets.push(next[2], 9), 0, payload));
}

}  // namespace
}  // namespace buoyancy
