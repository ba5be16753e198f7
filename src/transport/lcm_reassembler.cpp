#include "transport/lcm_reassembler.h"

#include <algorithm>
#include <utility>

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

std::optional<std::size_t> LcmReassembler::add_channel(const std::string& name) {
  const auto [place, is_new] = channels_.emplace(name, channels_.size());
  return is_new ? std::optional(place->second) : std::nullopt;
}

std::optional<LcmReassembler::Message> LcmReassembler::push(Bytes packet, std::uint64_t sender) {
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

std::optional<std::size_t> LcmReassembler::take_channel(Bytes& rest) const {
  const auto end = std::ranges::find(rest, std::uint8_t{0});
  if (end == rest.end()) return std::nullopt;
  const std::string_view name(reinterpret_cast<const char*>(rest.data()),
                              static_cast<std::size_t>(end - rest.begin()));
  const auto found = channels_.find(name);
  if (found == channels_.end()) return std::nullopt;
  rest = rest.subspan(name.size() + 1);
  return found->second;
}

std::optional<LcmReassembler::Message> LcmReassembler::take_fragment(Bytes rest, std::uint64_t sender) {
  constexpr std::size_t kHead = 16;
  if (rest.size() < kHead) return std::nullopt;
  const auto number = take_number<std::uint32_t>(rest);
  const std::size_t size = take_number<std::uint32_t>(rest);
  const std::size_t offset = take_number<std::uint32_t>(rest);
  const auto fragment = take_number<std::uint16_t>(rest);
  const auto fragments = take_number<std::uint16_t>(rest);

  const auto found = std::ranges::find_if(incomplete_, [&](const Incomplete& one) {
    return one.received > 0 && one.sender == sender && one.number == number;
  });
  Incomplete* message = found == incomplete_.end() ? nullptr : &*found;
  if (fragment == 0) {
    const std::optional<std::size_t> channel = take_channel(rest);
    if (!channel) return std::nullopt;
    if (size > kMaxMessageBytes) {
      ++fragments_dropped_;
      return std::nullopt;
    }
    if (message == nullptr) {
      message = &claim_slot(sender);
      message->sender = sender;
      message->number = number;
      message->channel = *channel;
      message->size = size;
      message->parts.assign(fragments, Part{});
      message->payload.resize(size);
    }
  }
  if (message == nullptr) return std::nullopt;  // of another channel, or of what was given up

  const bool contradicts = fragments != message->parts.size() || fragment >= fragments ||
                           size != message->size || offset > size || rest.size() > size - offset;
  if (contradicts) {
    ++fragments_dropped_;
    discard(*message);
    return std::nullopt;
  }
  Part& part = message->parts[fragment];
  if (part.received) return std::nullopt;  // the network doubled it
  part = {offset, offset + rest.size(), true};
  std::ranges::copy(rest, message->payload.begin() + static_cast<std::ptrdiff_t>(offset));
  if (++message->received < message->parts.size()) return std::nullopt;
  if (!message->is_consistent()) {
    discard(*message);
    return std::nullopt;
  }
  message->received = 0;
  return Message{message->channel, message->payload};
}

// One fragment begins where the one before it ends: no byte is left over from an older message.
bool LcmReassembler::Incomplete::is_consistent() const {
  std::size_t end = 0;
  for (const Part& part : parts) {
    if (part.begin != end) return false;
    end = part.end;
  }
  return end == size;
}

LcmReassembler::Incomplete& LcmReassembler::claim_slot(std::uint64_t sender) {
  // Who sends another message has sent the last one: what is missing of it, is lost.
  auto place = std::ranges::find_if(incomplete_, [&](const Incomplete& one) { return one.sender == sender; });
  if (place == incomplete_.end()) {
    place = std::ranges::find_if(incomplete_, [](const Incomplete& one) { return one.received == 0; });
  }
  if (place == incomplete_.end()) {
    place = incomplete_.begin() +
            static_cast<std::ptrdiff_t>(std::exchange(oldest_, (oldest_ + 1) % kMaxPartialMessages));
  }
  discard(*place);
  return *place;
}

void LcmReassembler::discard(Incomplete& message) {
  fragments_dropped_ += static_cast<std::int64_t>(std::exchange(message.received, 0));
}

}  // namespace buoyancy
