#include "tests/service/raw_lcm.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace buoyancy {
namespace {

constexpr const char* kGroup = "239.255.76.67";
constexpr std::uint16_t kPort = 7667;
constexpr std::int32_t kShortMagic = 0x4c433032;  // "LC02"
constexpr std::int32_t kLongMagic = 0x4c433033;   // "LC03"
constexpr std::size_t kMaxShortMessage = 65'499;
constexpr std::size_t kFragmentSize = 60'000;  // any size that fits a datagram; liblcm uses another
// Large enough that a test that is not scheduled for a while loses nothing. Without root net.core.rmem_max
// limits it.
constexpr int kReceiveBuffer = 4'000'000;
constexpr std::size_t kMaxDatagram = 65'536;

sockaddr_in address(const char* host) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(kPort);
  inet_pton(AF_INET, host, &result.sin_addr);
  return result;
}

}  // namespace

RawLcmSocket::RawLcmSocket()
    : sender_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)),
      receiver_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  const int yes = 1;
  const unsigned char ttl = 0;
  const sockaddr_in any = address("0.0.0.0");
  ip_mreq membership{};
  membership.imr_multiaddr = address(kGroup).sin_addr;
  const bool ok =
      ::setsockopt(sender_.value(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl) == 0 &&
      ::setsockopt(receiver_.value(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      (::setsockopt(receiver_.value(), SOL_SOCKET, SO_RCVBUFFORCE, &kReceiveBuffer, sizeof kReceiveBuffer) ==
           0 ||
       ::setsockopt(receiver_.value(), SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer) == 0) &&
      ::bind(receiver_.value(), reinterpret_cast<const sockaddr*>(&any), sizeof any) == 0 &&
      ::setsockopt(receiver_.value(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
  if (!ok) throw std::runtime_error("cannot open a multicast socket");
}

void RawLcmSocket::send_packet(const RawBytes& packet) {
  const sockaddr_in group = address(kGroup);
  const ssize_t sent = ::sendto(sender_.value(), packet.data(), packet.size(), 0,
                                reinterpret_cast<const sockaddr*>(&group), sizeof group);
  if (sent != static_cast<ssize_t>(packet.size())) throw std::runtime_error("packet not sent");
}

void RawLcmSocket::send(const std::string& channel, const RawBytes& payload) {
  const auto sequence = static_cast<std::int32_t>(sequence_++);
  RawBytes rest(channel.begin(), channel.end());
  rest.push_back(0);
  rest.insert(rest.end(), payload.begin(), payload.end());
  if (rest.size() <= kMaxShortMessage) {
    RawWriter packet;
    packet.int32(kShortMagic).int32(sequence);
    packet.bytes.insert(packet.bytes.end(), rest.begin(), rest.end());
    send_packet(packet.bytes);
    return;
  }
  // Offsets count the payload only; the size of a fragment includes the channel.
  const std::size_t count = (rest.size() + kFragmentSize - 1) / kFragmentSize;
  const std::size_t head = channel.size() + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t start = i * kFragmentSize;
    const std::size_t end = std::min(start + kFragmentSize, rest.size());
    const std::size_t offset = i == 0 ? 0 : start - head;
    RawWriter packet;
    packet.int32(kLongMagic).int32(sequence).int32(static_cast<std::int32_t>(payload.size()));
    packet.int32(static_cast<std::int32_t>(offset));
    packet.int16(static_cast<std::int16_t>(i)).int16(static_cast<std::int16_t>(count));
    packet.bytes.insert(packet.bytes.end(), rest.begin() + static_cast<std::ptrdiff_t>(start),
                        rest.begin() + static_cast<std::ptrdiff_t>(end));
    send_packet(packet.bytes);
  }
}

std::optional<RawMessage> RawLcmSocket::receive_any(double seconds) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const std::chrono::duration<double, std::milli> left = limit - std::chrono::steady_clock::now();
    pollfd waiting{receiver_.value(), POLLIN, 0};
    if (::poll(&waiting, 1, std::max(0, static_cast<int>(left.count()))) != 1) return std::nullopt;
    RawBytes packet(kMaxDatagram);
    sockaddr_in from{};
    socklen_t from_size = sizeof from;
    const ssize_t size = ::recvfrom(receiver_.value(), packet.data(), packet.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0) continue;
    packet.resize(static_cast<std::size_t>(size));
    const std::uint64_t sender = std::uint64_t{from.sin_addr.s_addr} << 16U | from.sin_port;
    if (std::optional<RawMessage> message = push_packet(packet, sender)) return message;
  }
}

std::optional<RawBytes> RawLcmSocket::receive(const std::string& channel, double seconds) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    const std::chrono::duration<double> left = limit - std::chrono::steady_clock::now();
    std::optional<RawMessage> message = receive_any(std::max(0.0, left.count()));
    if (!message) return std::nullopt;
    if (message->channel == channel) return std::move(message->payload);
  }
}

std::optional<RawMessage> RawLcmSocket::push_packet(const RawBytes& packet, std::uint64_t sender) {
  constexpr std::size_t kShortHeader = 8;
  constexpr std::size_t kLongHeader = 20;
  constexpr std::size_t kMaxMessageBytes = std::size_t{1} << 28U;  // liblcm's limit
  if (packet.size() < kShortHeader) return std::nullopt;
  RawReader reader(packet);
  const std::int32_t magic = reader.int32();
  const auto sequence = static_cast<std::uint32_t>(reader.int32());
  const auto split = [&packet](std::size_t header) {
    const auto start = packet.begin() + static_cast<std::ptrdiff_t>(header);
    const auto end = std::find(start, packet.end(), 0);
    return RawMessage{std::string(start, end), RawBytes(std::min(end + 1, packet.end()), packet.end())};
  };
  if (magic == kShortMagic) return split(kShortHeader);
  if (magic != kLongMagic || packet.size() < kLongHeader) return std::nullopt;

  const std::size_t size = static_cast<std::uint32_t>(reader.int32());
  const std::size_t offset = static_cast<std::uint32_t>(reader.int32());
  if (size > kMaxMessageBytes) return std::nullopt;
  const std::int32_t fragment_and_count = reader.int32();
  Fragments& fragments = incomplete_[{sender, sequence}];
  fragments.payload.resize(size);
  RawBytes part(packet.begin() + static_cast<std::ptrdiff_t>(kLongHeader), packet.end());
  if (fragment_and_count >> 16 == 0) {
    RawMessage first = split(kLongHeader);
    fragments.channel = std::move(first.channel);
    part = std::move(first.payload);
  }
  if (offset > size || part.size() > size - offset) return std::nullopt;
  std::copy(part.begin(), part.end(), fragments.payload.begin() + static_cast<std::ptrdiff_t>(offset));
  fragments.received += part.size();
  if (fragments.received < size) return std::nullopt;
  RawMessage message{std::move(fragments.channel), std::move(fragments.payload)};
  incomplete_.erase({sender, sequence});
  return message;
}

RawWriter& RawWriter::unsigned_number(std::uint32_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
  }
  return *this;
}

std::int32_t RawReader::int32() {
  if (bytes_.size() - position_ < 4) throw std::runtime_error("message too short");
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8U | bytes_[position_++];
  return static_cast<std::int32_t>(value);
}

}  // namespace buoyancy
