// Messages out of the packets of LCM's UDP multicast: one packet each, or fragments, whose first comes first
// and the others in any order. What is no such packet, or of another channel, is dropped, and a message that
// lost a fragment is lost whole.
//
// Memory is bounded whatever arrives, by kMaxPartialMessages messages of kMaxMessageBytes; liblcm remembers
// every channel's name that it has seen. Once messages as large have come, nothing is allocated.
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

namespace buoyancy {

class LcmReassembler {
 public:
  static constexpr std::size_t kMaxMessageBytes = std::size_t{16} << 20U;  // bytes; 155,000 bodies
  static constexpr std::size_t kMaxPartialMessages = 4;

  struct Message {
    std::size_t channel;  // as add_channel() numbered it
    Bytes payload;        // valid until the next push(), and as long as the packet
  };

  // Messages of this channel are given from now on. Its number: 0, 1, ...; nullopt: it has one already.
  std::optional<std::size_t> add_channel(const std::string& name);

  // sender: tells those apart whose fragments come at the same time. The message that the packet completes.
  std::optional<Message> push(Bytes packet, std::uint64_t sender);

  // Of messages of our channels that are too large, contradict themselves, or were given up for newer ones.
  std::int64_t fragments_dropped() const { return fragments_dropped_; }

 private:
  struct Part {
    std::size_t begin = 0, end = 0;  // of the payload
    bool received = false;
  };
  struct Incomplete {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;  // the sender's, of this message
    std::size_t channel = 0;
    std::size_t size = 0;      // bytes that it will have
    std::size_t received = 0;  // fragments; 0: this place is free
    std::vector<Part> parts;   // one for each fragment
    std::vector<std::uint8_t> payload;

    bool is_consistent() const;
  };
  struct NameHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view name) const { return std::hash<std::string_view>{}(name); }
  };

  std::optional<Message> take_fragment(Bytes packet, std::uint64_t sender);
  // Takes the channel's name and its NUL off the front. nullopt: not one of ours.
  std::optional<std::size_t> take_channel(Bytes& rest) const;
  Incomplete& claim_slot(std::uint64_t sender);
  void discard(Incomplete& message);

  std::unordered_map<std::string, std::size_t, NameHash, std::equal_to<>> channels_;
  std::array<Incomplete, kMaxPartialMessages> incomplete_;
  std::size_t oldest_ = 0;  // of incomplete_, the next to be given up where none is free
  std::int64_t fragments_dropped_ = 0;
};

}  // namespace buoyancy
