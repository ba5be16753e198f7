// Reassembles messages from the packets of LCM's UDP multicast. A message is one packet or several fragments;
// the first fragment must arrive first, the others in any order. Invalid packets and those of other channels
// are dropped, and a message that lost a fragment is lost as a whole.
//
// Memory is bounded for any input (liblcm stores every channel name that it has received): at most
// kMaxPartialMessages are incomplete at a time, and they take kMaxPartialBytes. Memory is allocated as
// fragments arrive, whatever size the first one states. Beyond these limits, the message that has received
// no fragment for the longest time is discarded, so that forged fragments replace each other and not a
// message that arrives. A message no larger than an earlier one of its sender needs no allocation; one for
// which there is no memory is lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "messages/wire.h"
#include "transport/message_limits.h"

namespace buoyancy {

class LcmReassembler {
 public:
  static constexpr std::size_t kMaxPartialMessages = 256;
  static constexpr std::size_t kMaxPartialBytes = 4 * kMaxMessageBytes;  // with what complete ones leave

  struct Message {
    std::size_t channel;  // the number from add_channel()
    Bytes payload;        // valid until the next push() and while the packet lives
  };

  // Accepts messages of this channel from now on. Returns its number (0, 1, ...), or nullopt if it was added
  // before.
  std::optional<std::size_t> add_channel(const std::string& name);

  // Adds a packet and returns the message that it completes, if any. sender: distinguishes senders whose
  // fragments interleave.
  std::optional<Message> push(Bytes packet, std::uint64_t sender);

  // Fragments of messages on the added channels that were too large, inconsistent or discarded.
  std::int64_t fragments_dropped() const { return fragments_dropped_; }
  // Incomplete messages that were discarded to keep within the two limits, or for lack of memory.
  std::int64_t partial_messages_evicted() const { return partial_messages_evicted_; }
  // Messages on the added channels that were larger than kMaxMessageBytes.
  std::int64_t oversized_messages() const { return oversized_messages_; }

 private:
  struct Fragment {
    std::uint32_t begin = 0;      // where it belongs in the message [bytes]
    std::uint32_t size = 0;       // [bytes]
    std::uint32_t stored_at = 0;  // where payload has it
    std::uint16_t number = 0;     // in the message
  };
  struct PartialMessage {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;  // the sender's sequence number
    std::size_t channel = 0;
    std::size_t size = 0;               // of the whole payload [bytes]
    std::size_t fragment_count = 0;     // of the whole message
    std::uint64_t last_progress = 0;    // value of pushed_ at its last fragment
    std::vector<Fragment> fragments;    // received, by number; none: the slot is free
    std::vector<std::uint8_t> payload;  // their bytes, as they arrived

    std::size_t allocated() const { return payload.capacity() + fragments.capacity() * sizeof(Fragment); }
  };
  struct NameHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>{}(name); }
  };

  std::optional<Message> push_fragment(Bytes packet, std::uint64_t sender);
  // Consumes the channel name and its NUL. nullopt: the channel was not added.
  std::optional<std::size_t> read_channel(Bytes& rest) const;
  PartialMessage& claim_slot(std::uint64_t sender);
  // Returns false if its bytes are more than the message has left.
  bool store(PartialMessage& message, Fragment fragment, Bytes bytes);
  // Frees memory of others until this one may take so many bytes more.
  void make_room(const PartialMessage& message, std::size_t bytes);
  // Puts the bytes into their order. Returns false if the fragments have gaps or overlap.
  bool assemble(PartialMessage& message);
  void discard(PartialMessage& message);
  void evict(PartialMessage& message);

  std::unordered_map<std::string, std::size_t, NameHash, std::equal_to<>> channels_;
  std::vector<PartialMessage> partial_;  // one slot each, at most kMaxPartialMessages
  std::size_t allocated_ = 0;            // by all of them [bytes]
  std::vector<std::uint8_t> reordered_;  // reused
  std::uint64_t pushed_ = 0;             // fragments
  std::int64_t fragments_dropped_ = 0;
  std::int64_t partial_messages_evicted_ = 0;
  std::int64_t oversized_messages_ = 0;
};

}  // namespace buoyancy
