#include "view/lcm_packets.h"

#include <algorithm>

namespace buoyancy {
namespace {

constexpr std::uint32_t kWhole = 0x4c433032;     // "LC02", the sender's number, the channel, the payload
constexpr std::uint32_t kFragment = 0x4c433033;  // "LC03", the number, and what take_fragment() reads

// Takes a big-endian number off the front of bytes that are long enough.
template <typename Number>
Number take_number(Bytes& bytes) {
  Number value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) value = static_cast<Number>(value << 8U | bytes[i]);
  bytes = bytes.subspan(sizeof(Number));
  return value;
}

}  // namespace

std::optional<LcmPackets::Message> LcmPackets::take(Bytes packet, std::uint64_t sender) {
  constexpr std::size_t kHead = 8;
  if (packet.size() < kHead) return std::nullopt;
  Bytes rest = packet;
  const auto magic = take_number<std::uint32_t>(rest);
  if (magic == kFragment) return take_fragment(rest, sender);
  if (magic != kWhole) return std::nullopt;
  take_number<std::uint32_t>(rest);
  const std::optional<std::size_t> channel = take_channel(rest);
  if (!channel) return std::nullopt;
  return Message{*channel, rest};
}

std::optional<std::size_t> LcmPackets::take_channel(Bytes& rest) const {
  const auto end = std::ranges::find(rest, std::uint8_t{0});
  if (end == rest.end()) return std::nullopt;
  const std::string_view name(reinterpret_cast<const char*>(rest.data()),
                              static_cast<std::size_t>(end - rest.begin()));
  const auto found = std::ranges::find(channels_, name);
  if (found == channels_.end()) return std::nullopt;
  rest = rest.subspan(name.size() + 1);
  return static_cast<std::size_t>(found - channels_.begin());
}

std::optional<LcmPackets::Message> LcmPackets::take_fragment(Bytes rest, std::uint64_t sender) {
  constexpr std::size_t kHead = 16;
  if (rest.size() < kHead) return std::nullopt;
  const auto number = take_number<std::uint32_t>(rest);
  const auto size = take_number<std::uint32_t>(rest);
  const auto offset = take_number<std::uint32_t>(rest);
  const auto fragment = take_number<std::uint16_t>(rest);
  const auto fragments = take_number<std::uint16_t>(rest);

  Incomplete* message = nullptr;
  if (fragment == 0) {
    const std::optional<std::size_t> channel = take_channel(rest);
    if (!channel) return std::nullopt;
    if (size > kLargestMessage) {
      ++fragments_dropped_;
      return std::nullopt;
    }
    message = &incomplete_[std::exchange(oldest_, (oldest_ + 1) % kMostIncomplete)];
    fragments_dropped_ += message->next_fragment;  // of what will never be whole
    message->sender = sender;
    message->number = number;
    message->channel = *channel;
    message->size = size;
    message->fragments = fragments;
    message->next_fragment = 0;
    message->payload.clear();
  } else {
    const auto found = std::ranges::find_if(incomplete_, [&](const Incomplete& one) {
      return one.next_fragment > 0 && one.sender == sender && one.number == number;
    });
    if (found == incomplete_.end()) return std::nullopt;  // of another channel, or of what was given up
    message = &*found;
  }
  const bool in_turn = fragment == message->next_fragment && fragments == message->fragments &&
                       size == message->size && offset == message->payload.size() &&
                       rest.size() <= message->size - message->payload.size();
  if (!in_turn) {
    fragments_dropped_ += message->next_fragment + 1;
    message->next_fragment = 0;
    return std::nullopt;
  }
  message->payload.insert(message->payload.end(), rest.begin(), rest.end());
  if (++message->next_fragment < message->fragments) return std::nullopt;
  message->next_fragment = 0;
  if (message->payload.size() != message->size) {
    fragments_dropped_ += message->fragments;
    return std::nullopt;
  }
  return Message{message->channel, message->payload};
}

}  // namespace buoyancy
