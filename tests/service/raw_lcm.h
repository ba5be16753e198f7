// An LCM client that shares no code with the project or with liblcm: LCM's UDP packets, implemented from the
// definition of LCM's udpm provider. Messages are bytes here; tests/messages/wire_test.cpp compares their
// encoding with that of lcm-gen.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/unique_fd.h"

namespace buoyancy {

using RawBytes = std::vector<std::uint8_t>;

struct RawMessage {
  std::string channel;
  RawBytes payload;
};

// Sends to and receives from 239.255.76.67:7667 with ttl 0.
class RawLcmSocket {
 public:
  RawLcmSocket();

  // Sends one packet, or fragments if the payload is too long for one. payload: LCM-encoded bytes.
  void send(const std::string& channel, const RawBytes& payload);
  void send_packet(const RawBytes& packet);  // any bytes

  // The next message on the channel; messages on others are dropped. nullopt: none within `seconds`.
  std::optional<RawBytes> receive(const std::string& channel, double seconds);

  // The next message on any channel that has already arrived, or arrives within `seconds`.
  std::optional<RawMessage> receive_any(double seconds);

 private:
  struct Fragments {
    std::string channel;
    RawBytes payload;
    std::size_t received = 0;
  };
  std::optional<RawMessage> push_packet(const RawBytes& packet, std::uint64_t sender);

  UniqueFd sender_;
  UniqueFd receiver_;
  std::uint32_t sequence_ = 0;
  std::map<std::pair<std::uint64_t, std::uint32_t>, Fragments> incomplete_;
};

// Writes and reads numbers in big-endian order, as LCM does.
class RawWriter {
 public:
  RawWriter& int16(std::int16_t value) { return unsigned_number(static_cast<std::uint16_t>(value), 2); }
  RawWriter& int32(std::int32_t value) { return unsigned_number(static_cast<std::uint32_t>(value), 4); }
  RawBytes bytes;

 private:
  RawWriter& unsigned_number(std::uint32_t value, int size);
};

class RawReader {
 public:
  explicit RawReader(const RawBytes& bytes) : bytes_(bytes) {}
  std::int32_t int32();  // throws if bytes are missing

 private:
  const RawBytes& bytes_;
  std::size_t position_ = 0;
};

}  // namespace buoyancy
