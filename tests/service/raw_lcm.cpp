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

// The fields of the messages in their order, as lcmtypes/*.lcm define them.
template <typename Visit>
void visit_fields(RawState& state, Visit& visit) {
  visit("body_id", state.body_id);
  visit("position", state.position);
  visit("quaternion_wxyz", state.quaternion_wxyz);
  visit("linear_velocity", state.linear_velocity);
  visit("angular_velocity", state.angular_velocity);
}

template <typename Visit>
void visit_fields(RawWrench& wrench, Visit& visit) {
  visit("body_id", wrench.body_id);
  visit("status", wrench.status);
  visit("force", wrench.force);
  visit("torque", wrench.torque);
  visit("submerged_volume", wrench.submerged_volume);
  visit("center_of_buoyancy", wrench.center_of_buoyancy);
  visit("force_error_bound", wrench.force_error_bound);
  visit("torque_error_bound", wrench.torque_error_bound);
}

template <typename Visit>
void visit_fields(RawBodyHydrostatics& body, Visit& visit) {
  visit("body_id", body.body_id);
  visit("status", body.status);
  visit("submerged_volume", body.submerged_volume);
  visit("center_of_buoyancy", body.center_of_buoyancy);
  visit("wetted_area", body.wetted_area);
  visit("waterplane_area", body.waterplane_area);
  visit("waterplane_centroid", body.waterplane_centroid);
  visit("waterplane_second_moments", body.waterplane_second_moments);
  visit("waterplane_axes", body.waterplane_axes);
  visit("metacentric_radii", body.metacentric_radii);
  visit("metacenters", body.metacenters);
  visit("metacentric_heights", body.metacentric_heights);
  visit("stiffness", body.stiffness);
}

template <typename Visit>
void visit_fields(RawBodyLoads& body, Visit& visit) {
  visit("body_id", body.body_id);
  visit("status", body.status);
  visit("immersion", body.immersion);
  visit("buoyancy_force", body.buoyancy_force);
  visit("buoyancy_torque", body.buoyancy_torque);
  visit("drag_force", body.drag_force);
  visit("drag_torque", body.drag_torque);
  visit("added_mass_force", body.added_mass_force);
  visit("added_mass_torque", body.added_mass_torque);
  visit("added_mass", body.added_mass);
  visit("damping", body.damping);
  visit("water_velocity", body.water_velocity);
}

template <typename Body, typename Visit>
void visit_fields(RawResponse<Body>& response, Visit& visit) {
  visit("utime", response.utime);
  visit("session_id", response.session_id);
  visit("seq", response.seq);
  visit("num_bodies", response.num_bodies);
  visit("bodies", response.bodies);
}

template <typename Visit>
void visit_fields(RawStates& states, Visit& visit) {
  visit("utime", states.utime);
  visit("session_id", states.session_id);
  visit("seq", states.seq);
  visit("lead_time", states.lead_time);
  std::int32_t num_bodies = 0;
  visit("num_bodies", num_bodies);
  visit("bodies", states.bodies);
}

// LCM's type fingerprint: a hash of the names, primitive types and dimensions of the fields.
class Fingerprint {
 public:
  void operator()(const std::string& name, std::int32_t& /*field*/) { text(name).text("int32_t").byte(0); }
  void operator()(const std::string& name, std::int64_t& /*field*/) { text(name).text("int64_t").byte(0); }
  void operator()(const std::string& name, double& /*field*/) { text(name).text("double").byte(0); }
  template <std::size_t kSize>
  void operator()(const std::string& name, std::array<double, kSize>& /*field*/) {
    text(name).text("double").byte(1).byte(0).text(std::to_string(kSize));
  }
  template <std::size_t kRows, std::size_t kColumns>
  void operator()(const std::string& name, std::array<std::array<double, kColumns>, kRows>& /*field*/) {
    text(name).text("double").byte(2);
    byte(0).text(std::to_string(kRows)).byte(0).text(std::to_string(kColumns));
  }
  // value() adds the fingerprint of the elements; the name of their type is not hashed.
  template <typename Body>
  void operator()(const std::string& name, std::vector<Body>& /*field*/) {
    Fingerprint of_element;
    Body element;
    visit_fields(element, of_element);
    nested_ += static_cast<std::uint64_t>(of_element.value());
    text(name).byte(1).byte(1).text("num_bodies");
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

template <typename Message>
std::int64_t fingerprint_of() {
  Message message;
  Fingerprint fingerprint;
  visit_fields(message, fingerprint);
  return fingerprint.value();
}

// Reads the fields of a message, or of one of its bodies.
struct FieldReader {
  void operator()(const char* /*name*/, std::int32_t& field) { field = reader.int32(); }
  void operator()(const char* /*name*/, std::int64_t& field) { field = reader.int64(); }
  void operator()(const char* /*name*/, double& field) { field = reader.real(); }
  template <typename Value, std::size_t kSize>
  void operator()(const char* name, std::array<Value, kSize>& field) {
    for (Value& one : field) (*this)(name, one);
  }
  template <typename Body>
  void operator()(const char* /*name*/, std::vector<Body>& bodies) {
    bodies.resize(static_cast<std::size_t>(num_bodies));
    for (Body& body : bodies) visit_fields(body, *this);
  }
  RawReader& reader;
  std::int32_t& num_bodies;
};

// Throws if bytes are not such a message.
template <typename Response>
Response decode_response(const RawBytes& bytes) {
  RawReader reader(bytes);
  if (reader.int64() != fingerprint_of<Response>()) throw std::runtime_error("wrong message type");
  Response response;
  FieldReader fields{reader, response.num_bodies};
  visit_fields(response, fields);
  if (reader.left() != 0) throw std::runtime_error("trailing bytes after the message");
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
  return fingerprint_of<RawStates>();
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
  return decode_response<RawWrenches>(bytes);
}

RawHydrostatics decode_hydrostatics(const RawBytes& bytes) {
  return decode_response<RawHydrostatics>(bytes);
}

RawLoads decode_loads(const RawBytes& bytes) {
  return decode_response<RawLoads>(bytes);
}

}  // namespace buoyancy
