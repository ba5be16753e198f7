// Fuzz target: bytes as a sequence of packets of LCM's UDP multicast, from several senders. A reassembled
// message must consist of bytes that its sender sent for this place of this message, each message whose
// fragments all arrive must come out afterwards, and what is dropped must be counted.
//
//   each packet   1 byte: bits 0-1 the sender, bits 2-3 the message's number, bit 4 the channel is another
//   one,
//                 bit 5 the packet is no fragment, bit 6 64 senders forge a fragment each before it
//                 1 byte each: size, offset, fragment, number of fragments, number of bytes that follow; then
//                 these bytes
#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "transport/lcm_reassembler.h"

namespace buoyancy {
namespace {

using Packet = std::vector<std::uint8_t>;

void append(Packet& packet, std::uint32_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
    packet.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_channel(Packet& packet, std::string_view name) {
  packet.insert(packet.end(), name.begin(), name.end());
  packet.push_back(0);
}

Packet fragment(std::uint32_t number, std::uint32_t size, std::uint32_t offset, std::uint32_t index,
                std::uint32_t count, std::string_view channel, Bytes bytes) {
  Packet packet;
  append(packet, 0x4c433033, 4);
  append(packet, number, 4);
  append(packet, size, 4);
  append(packet, offset, 4);
  append(packet, index, 2);
  append(packet, count, 2);
  if (index == 0) append_channel(packet, channel);
  packet.insert(packet.end(), bytes.begin(), bytes.end());
  return packet;
}

// What a sender has sent: the bytes for each place of a message.
using Sent = std::map<std::pair<std::uint32_t, std::size_t>, std::set<std::uint8_t>>;

void check_arrives(LcmReassembler& reassembler, std::uint64_t sender) {
  const Packet payload{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  const Bytes bytes(payload);
  require(!reassembler.push(fragment(7, 10, 0, 0, 3, "A", bytes.first(4)), sender), "a part is no message");
  require(!reassembler.push(fragment(7, 10, 8, 2, 3, "", bytes.last(2)), sender), "two parts are no message");
  const auto message = reassembler.push(fragment(7, 10, 4, 1, 3, "", bytes.subspan(4, 4)), sender);
  require(message && std::ranges::equal(message->payload, payload),
          "a message whose fragments all arrive comes out");
}

void check(FuzzBytes bytes) {
  constexpr std::uint64_t kHonest = 100;
  constexpr std::uint64_t kForger = 1'000;
  LcmReassembler reassembler;
  reassembler.add_channel("A");
  std::map<std::uint64_t, Sent> sent;
  std::uint64_t forgers = 0;
  std::int64_t dropped = 0;
  while (!bytes.empty()) {
    const std::uint8_t kind = bytes.byte();
    const std::uint64_t sender = kind & 3U;
    const std::uint32_t number = kind >> 2U & 3U;
    const std::uint32_t size = bytes.byte();
    const std::uint32_t offset = bytes.byte();
    const std::uint32_t index = bytes.byte();
    const std::uint32_t count = bytes.byte();
    const Bytes data = bytes.take(bytes.byte());
    const std::string_view channel = (kind & 16U) != 0 ? "B" : "A";
    for (int n = 0; (kind & 64U) != 0 && n < 64; ++n) {
      reassembler.push(fragment(0, 1U << 24U, 0, 0, 0xffff, "A", data), kForger + forgers++ % 1'000);
    }
    Packet packet = fragment(number, size, offset, index, count, channel, data);
    const bool is_whole = (kind & 32U) != 0;
    if (is_whole) {
      packet.clear();
      append(packet, 0x4c433032, 4);
      append(packet, number, 4);
      append_channel(packet, channel);
      packet.insert(packet.end(), data.begin(), data.end());
    } else {
      for (std::size_t i = 0; i < data.size(); ++i) sent[sender][{number, offset + i}].insert(data[i]);
    }
    const auto message = reassembler.push(packet, sender);
    require(reassembler.fragments_dropped() >= dropped, "what was dropped stays counted");
    dropped = reassembler.fragments_dropped();
    if (!message) continue;
    require(message->channel == 0, "the channel is subscribed to");
    if (is_whole) {
      require(std::ranges::equal(message->payload, data), "a packet that is no fragment is a message");
      continue;
    }
    require(message->payload.size() == size, "a message has the size that its fragments state");
    for (std::size_t i = 0; i < size; ++i) {
      const auto places = sent[sender].find({number, i});
      require(places != sent[sender].end() && places->second.contains(message->payload[i]),
              "each byte of a message was sent for its place");
    }
  }
  check_arrives(reassembler, kHonest);
  require(reassembler.partial_messages_evicted() <= reassembler.fragments_dropped(),
          "an evicted message had a fragment");
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::FuzzBytes({data, size}));
  return 0;
}
