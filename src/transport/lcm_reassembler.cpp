#include "transport/lcm_reassembler.h"

#include <algorithm>
#include <utility>

namespace buoyancy {
namespace {

constexpr std::uint32_t kWhole = 0x4c433032;     // "LC02", the sender's number, the channel, the payload
constexpr std::uint32_t kFragment = 0x4c433033;  // "LC03", the number, and what push_fragment() reads

// Consumes a big-endian number. Requires that bytes are long enough.
template <typename Number>
Number read_number(Bytes& bytes) {
  Number value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) value = static_cast<Number>(value << 8U | bytes[i]);
  bytes = bytes.subspan(sizeof(Number));
  return value;
}

}  // namespace

std::optional<std::size_t> LcmReassembler::add_channel(const std::string& name) {
  const auto [entry, is_new] = channels_.emplace(name, channels_.size());
  return is_new ? std::optional(entry->second) : std::nullopt;
}

std::optional<LcmReassembler::Message> LcmReassembler::push(Bytes packet, std::uint64_t sender) {
  constexpr std::size_t kHeaderSize = 8;
  if (packet.size() < kHeaderSize) return std::nullopt;
  Bytes rest = packet;
  const auto magic = read_number<std::uint32_t>(rest);
  if (magic == kFragment) return push_fragment(rest, sender);
  if (magic != kWhole) return std::nullopt;
  read_number<std::uint32_t>(rest);
  const std::optional<std::size_t> channel = read_channel(rest);
  if (!channel) return std::nullopt;
  return Message{*channel, rest};
}

std::optional<std::size_t> LcmReassembler::read_channel(Bytes& rest) const {
  const auto end = std::ranges::find(rest, std::uint8_t{0});
  if (end == rest.end()) return std::nullopt;
  const std::string_view name(reinterpret_cast<const char*>(rest.data()),
                              static_cast<std::size_t>(end - rest.begin()));
  const auto found = channels_.find(name);
  if (found == channels_.end()) return std::nullopt;
  rest = rest.subspan(name.size() + 1);
  return found->second;
}

std::optional<LcmReassembler::Message> LcmReassembler::push_fragment(Bytes rest, std::uint64_t sender) {
  constexpr std::size_t kHeaderSize = 16;
  if (rest.size() < kHeaderSize) return std::nullopt;
  const auto number = read_number<std::uint32_t>(rest);
  const std::size_t size = read_number<std::uint32_t>(rest);
  const std::size_t offset = read_number<std::uint32_t>(rest);
  const auto fragment = read_number<std::uint16_t>(rest);
  const auto fragment_count = read_number<std::uint16_t>(rest);

  const auto found = std::ranges::find_if(partial_, [&](const PartialMessage& partial) {
    return partial.received > 0 && partial.sender == sender && partial.number == number;
  });
  PartialMessage* message = found == partial_.end() ? nullptr : &*found;
  if (fragment == 0) {
    const std::optional<std::size_t> channel = read_channel(rest);
    if (!channel) return std::nullopt;
    if (size > kMaxMessageBytes) {
      ++fragments_dropped_;
      ++oversized_messages_;
      return std::nullopt;
    }
    if (message == nullptr) {
      message = &claim_slot(sender);
      message->sender = sender;
      message->number = number;
      message->channel = *channel;
      message->size = size;
      message->fragments.assign(fragment_count, Fragment{});
      message->payload.resize(size);
    }
  }
  if (message == nullptr) return std::nullopt;  // of another channel or of a discarded message

  const bool inconsistent = fragment_count != message->fragments.size() || fragment >= fragment_count ||
                            size != message->size || offset > size || rest.size() > size - offset;
  if (inconsistent) {
    ++fragments_dropped_;
    discard(*message);
    return std::nullopt;
  }
  Fragment& part = message->fragments[fragment];
  if (part.received) return std::nullopt;  // duplicated by the network
  part = {offset, offset + rest.size(), true};
  std::ranges::copy(rest, message->payload.begin() + static_cast<std::ptrdiff_t>(offset));
  if (++message->received < message->fragments.size()) return std::nullopt;
  if (!message->is_consistent()) {
    discard(*message);
    return std::nullopt;
  }
  message->received = 0;
  return Message{message->channel, message->payload};
}

// Each fragment must begin where the previous one ends, so that no byte is left over from an older message.
bool LcmReassembler::PartialMessage::is_consistent() const {
  std::size_t end = 0;
  for (const Fragment& part : fragments) {
    if (part.begin != end) return false;
    end = part.end;
  }
  return end == size;
}

LcmReassembler::PartialMessage& LcmReassembler::claim_slot(std::uint64_t sender) {
  // A new message from the same sender means that the rest of the previous one is lost.
  auto slot =
      std::ranges::find_if(partial_, [&](const PartialMessage& partial) { return partial.sender == sender; });
  if (slot == partial_.end()) {
    slot =
        std::ranges::find_if(partial_, [](const PartialMessage& partial) { return partial.received == 0; });
  }
  if (slot == partial_.end()) {
    slot = partial_.begin() +
           static_cast<std::ptrdiff_t>(std::exchange(oldest_, (oldest_ + 1) % kMaxPartialMessages));
  }
  discard(*slot);
  return *slot;
}

void LcmReassembler::discard(PartialMessage& message) {
  fragments_dropped_ += static_cast<std::int64_t>(std::exchange(message.received, 0));
}

}  // namespace buoyancy
