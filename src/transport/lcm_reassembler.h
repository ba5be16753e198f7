// Reassembles messages from the packets of LCM's UDP multicast. A message is one packet or several fragments;
// the first fragment must arrive first, the others in any order. Invalid packets and those of other channels
// are dropped, and a message that lost a fragment is lost as a whole.
//
// Memory is bounded for any input, by kMaxPartialMessages messages of kMaxMessageBytes (liblcm stores every
// channel name that it has received). A message no larger than an earlier one needs no allocation.
#pragma once

#include <array>
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
  static constexpr std::size_t kMaxPartialMessages = 4;

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

  // Fragments of messages on the added channels that were too large, inconsistent or discarded for newer
  // ones.
  std::int64_t fragments_dropped() const { return fragments_dropped_; }
  // Messages on the added channels that were larger than kMaxMessageBytes.
  std::int64_t oversized_messages() const { return oversized_messages_; }

 private:
  struct Fragment {
    std::size_t begin = 0, end = 0;  // byte range of the payload
    bool received = false;
  };
  struct PartialMessage {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;  // the sender's sequence number
    std::size_t channel = 0;
    std::size_t size = 0;      // of the whole payload [bytes]
    std::size_t received = 0;  // fragments received; 0: the slot is free
    std::vector<Fragment> fragments;
    std::vector<std::uint8_t> payload;

    bool is_consistent() const;
  };
  struct NameHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>{}(name); }
  };

  std::optional<Message> push_fragment(Bytes packet, std::uint64_t sender);
  // Consumes the channel name and its NUL. nullopt: the channel was not added.
  std::optional<std::size_t> read_channel(Bytes& rest) const;
  PartialMessage& claim_slot(std::uint64_t sender);
  void discard(PartialMessage& message);

  std::unordered_map<std::string, std::size_t, NameHash, std::equal_to<>> channels_;
  std::array<PartialMessage, kMaxPartialMessages> partial_;
  std::size_t oldest_ = 0;  // slot of partial_ that is discarded next if none is free
  std::int64_t fragments_dropped_ = 0;
  std::int64_t oversized_messages_ = 0;
};

}  // namespace buoyancy
