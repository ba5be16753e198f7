// Messages out of the packets of LCM's UDP multicast: one packet each, or fragments in order. What is no such
// packet, of another channel, or a fragment out of its turn is dropped: a message that lost one is lost
// whole.
//
// Memory is bounded whatever arrives: kMostIncomplete messages of kLargestMessage.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

class LcmPackets {
 public:
  static constexpr std::size_t kLargestMessage = std::size_t{4} << 20U;  // bytes; 38,000 bodies
  static constexpr std::size_t kMostIncomplete = 4;

  struct Message {
    std::size_t channel;  // of those named
    Bytes payload;        // valid until the next take()
  };

  explicit LcmPackets(std::vector<std::string> channels) : channels_(std::move(channels)) {}

  // sender: tells those apart whose fragments come at the same time. The message that the packet completes.
  std::optional<Message> take(Bytes packet, std::uint64_t sender);

  std::int64_t fragments_dropped() const {
    return fragments_dropped_;
  }  // out of turn, or of what is too large

 private:
  struct Incomplete {
    std::uint64_t sender = 0;
    std::uint32_t number = 0;  // the sender's, of this message
    std::size_t channel = 0;
    std::size_t size = 0;  // bytes that it will have
    std::uint32_t fragments = 0, next_fragment = 0;
    std::vector<std::uint8_t> payload;
  };

  std::optional<Message> take_fragment(Bytes packet, std::uint64_t sender);
  // Takes the channel's name and its NUL off the front. nullopt: not one of ours.
  std::optional<std::size_t> take_channel(Bytes& rest) const;

  std::vector<std::string> channels_;
  std::array<Incomplete, kMostIncomplete> incomplete_;
  std::size_t oldest_ = 0;  // of incomplete_, the next to be given up
  std::int64_t fragments_dropped_ = 0;
};

}  // namespace buoyancy
