#include "transport/lcm_reassembler.h"

#include <algorithm>
#include <new>
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
    return !partial.fragments.empty() && partial.sender == sender && partial.number == number;
  });
  PartialMessage* message = found == partial_.end() ? nullptr : &*found;
  std::optional<std::size_t> channel;
  if (fragment == 0) {
    channel = read_channel(rest);
    if (!channel) return std::nullopt;
    if (size > kMaxMessageBytes) {
      ++fragments_dropped_;
      ++oversized_messages_;
      return std::nullopt;
    }
  } else if (message == nullptr) {
    return std::nullopt;  // of another channel or of a discarded message
  }
  bool consistent = fragment < fragment_count && offset <= size && rest.size() <= size - offset;
  if (message != nullptr) {
    consistent = consistent && fragment_count == message->fragment_count && size == message->size;
  }
  if (!consistent) {
    ++fragments_dropped_;
    if (message != nullptr) discard(*message);
    return std::nullopt;
  }
  try {
    if (message == nullptr) {
      message = &claim_slot(sender);
      message->number = number;
      message->channel = *channel;
      message->size = size;
      message->fragment_count = fragment_count;
    }
    consistent = store(*message, {.begin = static_cast<std::uint32_t>(offset), .number = fragment}, rest);
    const bool complete = message->fragments.size() == fragment_count;
    if (!consistent || (complete && !assemble(*message))) {
      discard(*message);
      return std::nullopt;
    }
    if (!complete) return std::nullopt;
  } catch (const std::bad_alloc&) {
    ++fragments_dropped_;
    for (PartialMessage& partial : partial_) evict(partial);
    return std::nullopt;
  }
  message->fragments.clear();
  return Message{message->channel, message->payload};
}

bool LcmReassembler::store(PartialMessage& message, Fragment fragment, Bytes bytes) {
  const auto place = std::ranges::lower_bound(message.fragments, fragment.number, {}, &Fragment::number);
  const bool is_duplicate = place != message.fragments.end() && place->number == fragment.number;
  if (is_duplicate) return true;  // the network duplicated it
  message.last_progress = ++pushed_;
  const std::size_t needed = message.payload.size() + bytes.size();
  if (needed > message.size) return false;
  const std::size_t before = message.allocated();
  if (needed > message.payload.capacity()) {
    // The capacity at most doubles what has arrived, so that a sender pays for the memory that it takes.
    const std::size_t capacity = std::max(needed, std::min(2 * message.payload.capacity(), message.size));
    make_room(message, capacity - message.payload.capacity());
    message.payload.reserve(capacity);
  }
  fragment.size = static_cast<std::uint32_t>(bytes.size());
  fragment.stored_at = static_cast<std::uint32_t>(message.payload.size());
  message.fragments.insert(place, fragment);
  message.payload.insert(message.payload.end(), bytes.begin(), bytes.end());
  allocated_ += message.allocated() - before;
  make_room(message, 0);
  return true;
}

void LcmReassembler::make_room(const PartialMessage& message, std::size_t bytes) {
  while (allocated_ + bytes > kMaxPartialBytes) {
    // The memory that complete messages left is freed first, then that of messages without progress.
    PartialMessage* victim = nullptr;
    const auto rank = [](const PartialMessage& partial) {
      return std::pair(!partial.fragments.empty(), partial.last_progress);
    };
    for (PartialMessage& partial : partial_) {
      if (&partial == &message || partial.allocated() == 0) continue;
      if (victim == nullptr || rank(partial) < rank(*victim)) victim = &partial;
    }
    if (victim == nullptr) return;
    evict(*victim);
  }
}

// Each fragment must begin where the previous one ends.
bool LcmReassembler::assemble(PartialMessage& message) {
  std::size_t end = 0;
  bool in_order = true;
  for (const Fragment& part : message.fragments) {
    if (part.begin != end) return false;
    in_order = in_order && part.stored_at == part.begin;
    end += part.size;
  }
  if (end != message.size || in_order) return end == message.size;
  reordered_.clear();
  reordered_.reserve(end);
  for (const Fragment& part : message.fragments) {
    const Bytes bytes = Bytes(message.payload).subspan(part.stored_at, part.size);
    reordered_.insert(reordered_.end(), bytes.begin(), bytes.end());
  }
  std::ranges::copy(reordered_, message.payload.begin());
  return true;
}

LcmReassembler::PartialMessage& LcmReassembler::claim_slot(std::uint64_t sender) {
  // A new message from the same sender means that the rest of the previous one is lost.
  auto slot = std::ranges::find(partial_, sender, &PartialMessage::sender);
  if (slot == partial_.end()) {
    slot = std::ranges::find_if(partial_, [](const PartialMessage& each) { return each.fragments.empty(); });
  }
  if (slot == partial_.end() && partial_.size() < kMaxPartialMessages) {
    slot = partial_.insert(slot, PartialMessage{});
  }
  if (slot == partial_.end()) {
    slot = std::ranges::min_element(partial_, {}, &PartialMessage::last_progress);
    ++partial_messages_evicted_;
  }
  discard(*slot);
  slot->payload.clear();
  slot->sender = sender;
  return *slot;
}

void LcmReassembler::discard(PartialMessage& message) {
  fragments_dropped_ += static_cast<std::int64_t>(message.fragments.size());
  message.fragments.clear();
}

void LcmReassembler::evict(PartialMessage& message) {
  if (!message.fragments.empty()) ++partial_messages_evicted_;
  discard(message);
  allocated_ -= message.allocated();
  message.fragments = std::vector<Fragment>();  // {} would keep the memory
  message.payload = std::vector<std::uint8_t>();
}

}  // namespace buoyancy
