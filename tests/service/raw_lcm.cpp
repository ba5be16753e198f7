#include "tests/service/raw_lcm.h"

#include <algorithm>
#include <chrono>
#include <cstring>
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

// LCM's type fingerprint: a hash of the names, primitive types and dimensions of the fields.
class Fingerprint {
 public:
  Fingerprint& field(const std::string& name, const std::string& primitive_type) {
    return text(name).text(primitive_type).byte(0);
  }
  Fingerprint& fixed_array(const std::string& name, const std::string& primitive_type,
                           const std::string& size) {
    return text(name).text(primitive_type).byte(1).byte(0).text(size);
  }
  Fingerprint& matrix(const std::string& name, const std::string& primitive_type, const std::string& rows,
                      const std::string& columns) {
    return text(name).text(primitive_type).byte(2).byte(0).text(rows).byte(0).text(columns);
  }
  // value() adds the fingerprint of the elements; the name of their type is not hashed.
  Fingerprint& counted_array_of_structs(const std::string& name, const std::string& count,
                                        std::int64_t element) {
    nested_ += static_cast<std::uint64_t>(element);
    return text(name).byte(1).byte(1).text(count);
  }
  std::int64_t value() const {
    const std::uint64_t sum = hash_ + nested_;
    return static_cast<std::int64_t>(sum << 1U | sum >> 63U);
  }

 private:
  Fingerprint& byte(std::int64_t value) {
    const auto sign_carrying = static_cast<std::uint64_t>(static_cast<std::int64_t>(hash_) >> 55);
    hash_ = ((hash_ << 8U) ^ sign_carrying) + static_cast<std::uint64_t>(value);
    return *this;
  }
  Fingerprint& text(const std::string& value) {
    byte(static_cast<std::int64_t>(value.size()));
    for (const char c : value) byte(c);
    return *this;
  }

  std::uint64_t hash_ = 0x12345678;
  std::uint64_t nested_ = 0;
};

std::int64_t state_fingerprint() {
  return Fingerprint()
      .field("body_id", "int32_t")
      .fixed_array("position", "double", "3")
      .fixed_array("quaternion_wxyz", "double", "4")
      .fixed_array("linear_velocity", "double", "3")
      .fixed_array("angular_velocity", "double", "3")
      .value();
}

std::int64_t response_fingerprint(std::int64_t body) {
  return Fingerprint()
      .field("utime", "int64_t")
      .field("session_id", "int64_t")
      .field("seq", "int64_t")
      .field("num_bodies", "int32_t")
      .counted_array_of_structs("bodies", "num_bodies", body)
      .value();
}

std::int64_t wrenches_fingerprint() {
  const std::int64_t wrench = Fingerprint()
                                  .field("body_id", "int32_t")
                                  .field("status", "int32_t")
                                  .fixed_array("force", "double", "3")
                                  .fixed_array("torque", "double", "3")
                                  .field("submerged_volume", "double")
                                  .fixed_array("center_of_buoyancy", "double", "3")
                                  .field("force_error_bound", "double")
                                  .field("torque_error_bound", "double")
                                  .value();
  return response_fingerprint(wrench);
}

std::int64_t hydrostatics_fingerprint() {
  const std::int64_t body = Fingerprint()
                                .field("body_id", "int32_t")
                                .field("status", "int32_t")
                                .field("submerged_volume", "double")
                                .fixed_array("center_of_buoyancy", "double", "3")
                                .field("wetted_area", "double")
                                .field("waterplane_area", "double")
                                .fixed_array("waterplane_centroid", "double", "3")
                                .fixed_array("waterplane_second_moments", "double", "2")
                                .matrix("waterplane_axes", "double", "2", "3")
                                .fixed_array("metacentric_radii", "double", "2")
                                .matrix("metacenters", "double", "2", "3")
                                .fixed_array("metacentric_heights", "double", "2")
                                .matrix("stiffness", "double", "6", "6")
                                .value();
  return response_fingerprint(body);
}

std::int64_t loads_fingerprint() {
  const std::int64_t body = Fingerprint()
                                .field("body_id", "int32_t")
                                .field("status", "int32_t")
                                .field("immersion", "double")
                                .fixed_array("buoyancy_force", "double", "3")
                                .fixed_array("buoyancy_torque", "double", "3")
                                .fixed_array("drag_force", "double", "3")
                                .fixed_array("drag_torque", "double", "3")
                                .fixed_array("added_mass_force", "double", "3")
                                .fixed_array("added_mass_torque", "double", "3")
                                .matrix("added_mass", "double", "6", "6")
                                .matrix("damping", "double", "6", "6")
                                .fixed_array("water_velocity", "double", "3")
                                .value();
  return response_fingerprint(body);
}

// Reads the header that all responses share and allocates the bodies.
template <typename Response>
Response read_header(RawReader& reader, std::int64_t fingerprint) {
  if (reader.int64() != fingerprint) throw std::runtime_error("wrong message type");
  Response response;
  response.utime = reader.int64();
  response.session_id = reader.int64();
  response.seq = reader.int64();
  response.bodies.resize(static_cast<std::size_t>(reader.int32()));
  return response;
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

RawWriter& RawWriter::real(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return unsigned_number(bits, 8);
}

RawWriter& RawWriter::unsigned_number(std::uint64_t value, int size) {
  for (int shift = 8 * (size - 1); shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
  }
  return *this;
}

double RawReader::real() {
  const std::uint64_t bits = unsigned_number(8);
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::uint64_t RawReader::unsigned_number(std::size_t size) {
  if (left() < size) throw std::runtime_error("message too short");
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes_[position_++];
  return value;
}

std::int64_t raw_states_fingerprint() {
  return Fingerprint()
      .field("utime", "int64_t")
      .field("session_id", "int64_t")
      .field("seq", "int64_t")
      .field("lead_time", "double")
      .field("num_bodies", "int32_t")
      .counted_array_of_structs("bodies", "num_bodies", state_fingerprint())
      .value();
}

RawBytes encode_states(const RawStates& states) {
  RawWriter writer;
  writer.int64(raw_states_fingerprint()).int64(states.utime).int64(states.session_id).int64(states.seq);
  writer.real(states.lead_time).int32(static_cast<std::int32_t>(states.bodies.size()));
  for (const RawState& state : states.bodies) {
    writer.int32(state.body_id).reals(state.position).reals(state.quaternion_wxyz);
    writer.reals(state.linear_velocity).reals(state.angular_velocity);
  }
  return writer.bytes;
}

RawWrenches decode_wrenches(const RawBytes& bytes) {
  RawReader reader(bytes);
  auto wrenches = read_header<RawWrenches>(reader, wrenches_fingerprint());
  for (RawWrench& wrench : wrenches.bodies) {
    wrench.body_id = reader.int32();
    wrench.status = reader.int32();
    wrench.force = reader.real3();
    wrench.torque = reader.real3();
    wrench.submerged_volume = reader.real();
    wrench.center_of_buoyancy = reader.real3();
    wrench.force_error_bound = reader.real();
    wrench.torque_error_bound = reader.real();
  }
  if (reader.left() != 0) throw std::runtime_error("trailing bytes after the message");
  return wrenches;
}

RawHydrostatics decode_hydrostatics(const RawBytes& bytes) {
  RawReader reader(bytes);
  auto hydrostatics = read_header<RawHydrostatics>(reader, hydrostatics_fingerprint());
  for (RawBodyHydrostatics& body : hydrostatics.bodies) {
    body.body_id = reader.int32();
    body.status = reader.int32();
    body.submerged_volume = reader.real();
    reader.reals(body.center_of_buoyancy);
    body.wetted_area = reader.real();
    body.waterplane_area = reader.real();
    reader.reals(body.waterplane_centroid);
    reader.reals(body.waterplane_second_moments);
    reader.reals(body.waterplane_axes);
    reader.reals(body.metacentric_radii);
    reader.reals(body.metacenters);
    reader.reals(body.metacentric_heights);
    reader.reals(body.stiffness);
  }
  if (reader.left() != 0) throw std::runtime_error("trailing bytes after the message");
  return hydrostatics;
}

RawLoads decode_loads(const RawBytes& bytes) {
  RawReader reader(bytes);
  auto loads = read_header<RawLoads>(reader, loads_fingerprint());
  for (RawBodyLoads& body : loads.bodies) {
    body.body_id = reader.int32();
    body.status = reader.int32();
    body.immersion = reader.real();
    for (auto* vector : {&body.buoyancy_force, &body.buoyancy_torque, &body.drag_force, &body.drag_torque,
                         &body.added_mass_force, &body.added_mass_torque}) {
      reader.reals(*vector);
    }
    reader.reals(body.added_mass);
    reader.reals(body.damping);
    reader.reals(body.water_velocity);
  }
  if (reader.left() != 0) throw std::runtime_error("trailing bytes after the message");
  return loads;
}

}  // namespace buoyancy
